//! Content of a file that is packed with gzip or zstd.

use super::head::HEAD_BYTES;
use super::{FileKind, words};
use crate::IoError;
use flate2::bufread::MultiGzDecoder;
use ruzstd::decoding::{FrameDecoder, StreamingDecoder};
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

/// Refuses a packed file whose content a command only reads unpacked. A file that cannot be unpacked is accepted: its reader gives a better
/// error.
pub(super) fn check(path: &Path, found: FileKind, expected: &str) -> Result<(), IoError> {
    let (packing, unpack, read) = match found {
        FileKind::Gzip => ("gzip", "gunzip", &[FileKind::CarmenLog, FileKind::Text, FileKind::Empty][..]),
        FileKind::Zstd => ("zstd", "unzstd", &[FileKind::Ros2Mcap, FileKind::OtherMcap, FileKind::Empty][..]),
        _ => return Ok(()),
    };
    let inside = FileKind::of_bytes(&unpacked_head(path, found), u64::MAX);
    if read.contains(&inside) {
        return Ok(());
    }
    let unpack = if inside == FileKind::Tar {
        words::TAR_REMEDY.to_owned()
    } else {
        format!("unpack it with `{unpack}`")
    };
    let problem =
        format!("this is {} packed with {packing}, expected {expected}; {unpack}", words::name(inside));
    Err(IoError::malformed(path, problem))
}

/// The first bytes inside a packed file, up to the first error.
fn unpacked_head(path: &Path, found: FileKind) -> Vec<u8> {
    let mut head = Vec::new();
    let Ok(file) = File::open(path).map(BufReader::new) else { return head };
    // The bytes unpacked before an error remain in `head`.
    let _ = match found {
        FileKind::Gzip => MultiGzDecoder::new(file).take(HEAD_BYTES).read_to_end(&mut head),
        _ => match StreamingDecoder::<_, FrameDecoder>::new(file) {
            Ok(decoder) => decoder.take(HEAD_BYTES).read_to_end(&mut head),
            Err(_) => Ok(0),
        },
    };
    head
}

#[cfg(test)]
mod tests {
    use crate::{Expected, FileKind};
    use flate2::{Compression, write::GzEncoder};
    use std::io::Write;

    fn gzip(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    fn zstd(bytes: &[u8]) -> Vec<u8> {
        ruzstd::encoding::compress_to_vec(bytes, ruzstd::encoding::CompressionLevel::Fastest)
    }

    fn checked(bytes: &[u8]) -> Result<FileKind, String> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), bytes).unwrap();
        Expected::LaserLog.check(file.path()).map_err(|error| error.problem())
    }

    #[test]
    fn kinds_that_are_read_packed_pass() {
        assert_eq!(checked(&gzip(b"FLASER 1 2 0 0 0 0 0 0 1 h 1\n")), Ok(FileKind::Gzip));
        assert_eq!(checked(&zstd(b"\x89MCAP0\r\n\x01")), Ok(FileKind::Zstd));
        assert_eq!(checked(b"\x1f\x8b\x08\0broken"), Ok(FileKind::Gzip));
        assert_eq!(checked(b"\x28\xb5\x2f\xfdbroken"), Ok(FileKind::Zstd));
    }

    #[test]
    fn archives_are_named_with_the_program_that_unpacks_them() {
        let tar = [&[b'a'; 257][..], b"ustar\x0000"].concat();
        for (bytes, name, program) in [
            (&b"BZh91AY&SY"[..], "a file packed with bzip2", "bunzip2"),
            (b"\xfd7zXZ\0\0\x04", "a file packed with xz", "unxz"),
            (b"\x04\x22\x4d\x18d", "a file packed with lz4", "unlz4"),
            (b"PK\x03\x04\x14\0", "a zip archive", "unzip"),
            (b"7z\xbc\xaf\x27\x1c", "a 7z archive", "7z x"),
            (&tar, "a tar archive", "tar xf"),
            (&gzip(&tar), "a tar archive packed with gzip", "tar xf"),
            (&zstd(&tar), "a tar archive packed with zstd", "tar xf"),
        ] {
            let message = checked(bytes).unwrap_err();
            assert!(message.starts_with(&format!("this is {name}, expected")), "{message}");
            assert!(message.ends_with(&format!("; unpack it with `{program}`")), "{message}");
        }
    }

    #[test]
    fn kinds_that_are_read_only_unpacked_are_named() {
        let mcap = checked(&gzip(b"\x89MCAP0\r\n\x01")).unwrap_err();
        assert!(mcap.contains("packed with gzip") && mcap.ends_with("; unpack it with `gunzip`"), "{mcap}");
        let database = checked(&zstd(b"SQLite format 3\0....")).unwrap_err();
        assert!(
            database.starts_with("this is a ROS 2 bag (SQLite) packed with zstd, expected"),
            "{database}"
        );
        assert!(database.ends_with("; unpack it with `unzstd`"), "{database}");
    }
}
