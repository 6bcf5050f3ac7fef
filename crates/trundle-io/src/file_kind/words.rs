//! Names of the kinds, and the remedy for a file of the wrong kind.

use super::FileKind;
use FileKind as K;

/// Name of a kind and the remedy for a file of this kind; empty without general advice.
const WORDS: &[(FileKind, &str, &str)] = &[
    (
        K::Ros1Bag,
        "a ROS 1 bag",
        "`trundle map` reads its laser scans; `rosbags-convert --src FILE --dst FOLDER` makes a ROS 2 bag of it",
    ),
    (
        K::Ros2Mcap,
        "a ROS 2 bag (MCAP)",
        "`trundle map` reads its laser scans, `slam`, `map` and `replay` its RGB-D images",
    ),
    (
        K::Ros2Sqlite,
        "a ROS 2 bag (SQLite)",
        "`trundle map` reads its laser scans, `slam`, `map` and `replay` its RGB-D images",
    ),
    (
        K::Ros2BagFolder,
        "the folder of a ROS 2 bag",
        "`trundle map` reads its laser scans, `slam`, `map` and `replay` its RGB-D images",
    ),
    (K::RosBagMetadata, "the metadata of a ROS 2 bag", "give the bag's folder to `trundle map` or `slam`"),
    (
        K::TrundleRecording,
        "a trundle recording",
        "use `trundle replay`, or `slam` or `map` if it holds images",
    ),
    (K::OtherMcap, "an MCAP file", "`trundle map` and `slam` read it if its messages are those of ROS 2"),
    (K::Gzip, "a file packed with gzip", "unpack it with `gunzip`"),
    (K::Zstd, "a file packed with zstd", "unpack it with `unzstd`"),
    (K::Bzip2, "a file packed with bzip2", "unpack it with `bunzip2`"),
    (K::Xz, "a file packed with xz", "unpack it with `unxz`"),
    (K::Lz4, "a file packed with lz4", "unpack it with `unlz4`"),
    (K::Zip, "a zip archive", "unpack it with `unzip`"),
    (K::SevenZip, "a 7z archive", "unpack it with `7z x`"),
    (K::Tar, "a tar archive", TAR_REMEDY),
    (K::Pgm, "a PGM picture", ""),
    (K::Netpbm, "a PBM or PPM picture", ""),
    (K::Png, "a PNG picture", ""),
    (K::Bmp, "a BMP picture", ""),
    (K::Jpeg, "a JPEG picture", ""),
    (K::Tiff, "a TIFF picture", ""),
    (K::Exr, "an OpenEXR picture", ""),
    (K::WebP, "a WebP picture", ""),
    (K::Gif, "a GIF picture", ""),
    (K::MapYaml, "a map's YAML file", "`trundle plan`, `dock`, `sim` and `eval map` read it"),
    (K::CameraToml, "a camera file of trundle", "it goes with --camera"),
    (K::OrbSlamYaml, "a settings file of ORB-SLAM", "it goes with --camera"),
    (K::StellaVslamYaml, "a settings file of stella_vslam", "it goes with --camera"),
    (K::RosCameraYaml, "a camera_info file of ROS", "it goes with --camera"),
    (K::KalibrCameraYaml, "a calibration of Kalibr or EuRoC", "it goes with --camera"),
    (K::Open3dCamera, "a camera file of Open3D", "it goes with --camera"),
    (K::CarmenLog, "a CARMEN log", "`trundle map` reads it"),
    (K::TumTrajectory, "a TUM trajectory", "`trundle eval` compares it with another"),
    (K::PlanarTrajectory, "a planar trajectory", "`trundle eval` compares it with another"),
    (K::KittiTrajectory, "a KITTI trajectory", "`trundle eval` compares it with another"),
    (K::EurocTrajectory, "an EuRoC trajectory", "`trundle eval` compares it with another"),
    (K::ImageList, "a list of images", "give its folder to `trundle slam`"),
    (K::CorridorProblems, "a file of docking problems", "`trundle dock` reads it"),
    (K::Glb, "a glTF scene (.glb)", "`trundle sim` and `trundle demo --scene` read it"),
    (K::Gltf, "a glTF scene (.gltf)", "`trundle sim` and `trundle demo --scene` read it"),
    (K::Obj, "an OBJ mesh", MESH_REMEDY),
    (K::Ply, "a PLY mesh", MESH_REMEDY),
    (K::Stl, "an STL mesh", MESH_REMEDY),
    (K::Dae, "a COLLADA scene", MESH_REMEDY),
    (K::OtherMesh, "a scene or robot description of another program", MESH_REMEDY),
    (K::PointCloud, "a point cloud", ""),
    (K::Toml, "a TOML file", ""),
    (
        K::GeoJson,
        "a GeoJSON file",
        "a graph goes with `trundle plan --graph`, zones and places with --zones of `trundle run`",
    ),
    (K::Json, "a JSON file", ""),
    (K::Xml, "an XML file", ""),
    (K::Yaml, "a YAML file", ""),
    (K::FilterMap, "a saved filter of `trundle map`", "it goes with `trundle map --map`"),
    (K::VisualMap, "a visual map of `trundle slam`", "it goes with `trundle slam --map`"),
    (K::Vocabulary, "a visual vocabulary", "it goes with --vocabulary"),
    (K::Dbow2Vocabulary, "a vocabulary in the text form of DBoW2", "`trundle vocabulary import` reads it"),
    (K::Checkpoint, "a checkpoint of a run", "it goes with --resume of `trundle run` and `trundle demo`"),
    (K::Executable, "a program", ""),
    (K::Document, "a PDF document", ""),
    (K::Hdf5, "an HDF5 file", ""),
    (K::Video, "a video", "`ffmpeg -i FILE rgb/%06d.png` makes images of it"),
    (K::Text, "a text file of no known kind", ""),
    (K::Utf16Text, "text in UTF-16", "save it as UTF-8"),
    (K::Binary, "a binary file of no known kind", ""),
    (K::Empty, "an empty file", ""),
    (K::Stream, "a pipe or device", "write its content into a file, which is read twice"),
    (K::SequenceFolder, "a TUM RGB-D folder", "`trundle slam` and `trundle map` read it"),
    (K::EurocFolder, "an EuRoC folder", ""),
    (K::RunFolder, "the folder of a trundle run", "`trundle replay FOLDER/recording.mcap` runs it again"),
    (K::EmptyFolder, "an empty folder", ""),
    (K::Folder, "a folder", ""),
];

/// Remedy for a tar archive; GNU tar and bsdtar recognise a packed one.
pub(super) const TAR_REMEDY: &str = "unpack it with `tar xf`";
const MESH_REMEDY: &str = "trundle reads meshes as .glb or .gltf: Blender (File > Export > glTF 2.0) or `assimp export FILE FILE.glb` \
                           makes one of it";

/// The name of a kind with its article.
pub(super) fn name(kind: FileKind) -> &'static str {
    words(kind).0
}

/// Remedy for a file of this kind if another was expected; `wants_map`: whether a map was expected.
pub(super) fn remedy(kind: FileKind, wants_map: bool) -> &'static str {
    match words(kind).1 {
        "" if wants_map && is_picture(kind) => "give the map's YAML file, which names the picture",
        general => general,
    }
}

fn is_picture(kind: FileKind) -> bool {
    matches!(kind, K::Pgm | K::Netpbm | K::Png | K::Bmp | K::Jpeg | K::Tiff | K::Exr | K::WebP | K::Gif)
}

fn words(kind: FileKind) -> (&'static str, &'static str) {
    let row = WORDS.iter().find(|(known, ..)| *known == kind);
    row.map_or(("a file of no known kind", ""), |(_, name, remedy)| (name, remedy))
}
