//! Recognition of binary files by their first bytes.

use super::FileKind;

/// The first bytes of files of one kind.
const MAGICS: &[(&[u8], FileKind)] = &[
    (b"#ROSBAG V", FileKind::Ros1Bag),
    (b"SQLite format 3\0", FileKind::Ros2Sqlite),
    (b"\x1f\x8b", FileKind::Gzip),
    (b"\x28\xb5\x2f\xfd", FileKind::Zstd),
    (b"PK\x03\x04", FileKind::Zip),
    (b"7z\xbc\xaf\x27\x1c", FileKind::SevenZip),
    (b"BZh", FileKind::Bzip2),
    (b"\xfd7zXZ\0", FileKind::Xz),
    (b"\x04\x22\x4d\x18", FileKind::Lz4),
    (b"\x89PNG\r\n\x1a\n", FileKind::Png),
    (b"\xff\xd8\xff", FileKind::Jpeg),
    (b"II*\0", FileKind::Tiff),
    (b"MM\0*", FileKind::Tiff),
    (b"II+\0", FileKind::Tiff),
    (b"MM\0+", FileKind::Tiff),
    (b"\x76\x2f\x31\x01", FileKind::Exr),
    (b"GIF8", FileKind::Gif),
    (b"glTF", FileKind::Glb),
    (b"ply\n", FileKind::Ply),
    (b"ply\r\n", FileKind::Ply),
    (b"Kaydara FBX", FileKind::OtherMesh),
    (b"PXR-USDC", FileKind::OtherMesh),
    (b"#usda", FileKind::OtherMesh),
    (b"BLENDER", FileKind::OtherMesh),
    (b"# .PCD", FileKind::PointCloud),
    (b"VERSION .7\nFIELDS", FileKind::PointCloud),
    (b"trundlF", FileKind::FilterMap),
    (b"trundlM", FileKind::VisualMap),
    (b"trundlV", FileKind::Vocabulary),
    (b"TRUNDLEM", FileKind::Checkpoint),
    (b"\x7fELF", FileKind::Executable),
    (b"\xcf\xfa\xed\xfe", FileKind::Executable),
    (b"%PDF", FileKind::Document),
    (b"\x89HDF\r\n\x1a\n", FileKind::Hdf5),
    (b"\x1aE\xdf\xa3", FileKind::Video),
    (b"\xff\xfe", FileKind::Utf16Text),
    (b"\xfe\xff", FileKind::Utf16Text),
];

/// Place of the mark in the header of a tar archive \[bytes\]. Source: POSIX.1-1988.
const TAR_MARK_OFFSET: usize = 257;
/// First bytes of an MCAP file. Source: MCAP specification, "Magic".
pub(super) const MCAP_MAGIC: &[u8] = b"\x89MCAP0\r\n";

/// The kind of a binary file, or of a text file with a signature in its first bytes.
pub(super) fn kind_of(head: &[u8], len: u64) -> Option<FileKind> {
    if head.starts_with(MCAP_MAGIC) {
        return Some(of_mcap(head));
    }
    let known = MAGICS.iter().find(|(magic, _)| head.starts_with(magic)).map(|(_, kind)| *kind);
    known.or_else(|| netpbm(head)).or_else(|| container(head)).or_else(|| stl(head, len))
}

/// The first record of an MCAP file has the profile of its messages and the library of its writer.
fn of_mcap(head: &[u8]) -> FileKind {
    let mut rest = head.get(MCAP_MAGIC.len() + 9..).unwrap_or_default(); // opcode and length of the record
    let profile = text_of(&mut rest);
    let library = text_of(&mut rest);
    match (profile, library) {
        (_, library) if library == crate::recording::LIBRARY.as_bytes() => FileKind::TrundleRecording,
        (b"ros2", _) => FileKind::Ros2Mcap,
        _ => FileKind::OtherMcap,
    }
}

/// A text of MCAP: its length in four bytes, then itself.
fn text_of<'a>(rest: &mut &'a [u8]) -> &'a [u8] {
    let Some((length, after)) = rest.split_first_chunk::<4>() else { return &[] };
    let length = usize::try_from(u32::from_le_bytes(*length)).unwrap_or(usize::MAX);
    let Some((text, after)) = after.split_at_checked(length) else { return &[] };
    *rest = after;
    text
}

/// `P1` to `P7` and a blank.
fn netpbm(head: &[u8]) -> Option<FileKind> {
    let [b'P', digit @ b'1'..=b'7', blank, ..] = head else { return None };
    let is_grey = matches!(digit, b'2' | b'5');
    blank.is_ascii_whitespace().then_some(if is_grey { FileKind::Pgm } else { FileKind::Netpbm })
}

/// Kinds whose mark comes after a length.
fn container(head: &[u8]) -> Option<FileKind> {
    let at = |offset: usize, mark: &[u8]| head.get(offset..).is_some_and(|rest| rest.starts_with(mark));
    if at(0, b"BM") && head.get(6..10) == Some(&[0; 4]) {
        return Some(FileKind::Bmp);
    }
    if at(TAR_MARK_OFFSET, b"ustar") {
        return Some(FileKind::Tar);
    }
    if at(0, b"MZ") && head.contains(&0) {
        return Some(FileKind::Executable);
    }
    match head.get(..4) {
        Some(b"RIFF") if at(8, b"WEBP") => Some(FileKind::WebP),
        Some(b"RIFF") => Some(FileKind::Video),
        _ => at(4, b"ftyp").then_some(FileKind::Video),
    }
}

/// A binary STL has 80 free bytes, the number of its triangles, and 50 bytes a triangle.
fn stl(head: &[u8], len: u64) -> Option<FileKind> {
    let triangles = head.get(80..)?.first_chunk::<4>()?;
    let expected = 84 + 50 * u64::from(u32::from_le_bytes(*triangles));
    (expected == len && len > 84).then_some(FileKind::Stl)
}
