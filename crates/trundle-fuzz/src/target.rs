//! The list of targets.

use crate::{seeds, targets};

/// A reader of bytes that a stranger can send.
#[derive(Debug, Clone, Copy)]
pub struct FuzzTarget {
    /// Name of the target, for `cargo xtask fuzz --target`.
    pub name: &'static str,
    /// Reads the bytes. A panic is a finding.
    pub run: fn(&[u8]),
    /// Good inputs to begin with.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Words of the format, which a mutation inserts.
    pub words: &'static [&'static str],
    /// File extensions of this target's inputs.
    pub endings: &'static [&'static str],
    /// Whether the format is compressed: a small file may then expand to much data.
    pub compressed: bool,
}

/// Memory that any input may use \[bytes\]: 64 MB. With a smaller limit, tables independent of the input would be reported. Source: ours.
const FREE_BYTES: usize = 64 << 20;
/// Memory for each byte of an uncompressed input \[bytes\]. A value of three characters becomes a node of a document of some 100 bytes.
/// Source: ours.
const BYTES_PER_BYTE: usize = 256;
/// Memory per byte of a compressed input \[bytes\]. Deflate packs 1,032 bytes into one. An image of one bit per pixel has eight pixels of
/// three bytes in each of them; a zstd block of four bytes expands to 128 KB. Source: RFC 1951, RFC 8878.
const BYTES_PER_COMPRESSED_BYTE: usize = 32_768;

impl FuzzTarget {
    /// The target of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Self> {
        TARGETS.iter().find(|target| target.name == name)
    }

    /// The memory that may be in use for an input of `length` bytes \[bytes\].
    #[must_use]
    pub fn memory_limit(&self, length: usize) -> usize {
        let factor = if self.compressed { BYTES_PER_COMPRESSED_BYTE } else { BYTES_PER_BYTE };
        FREE_BYTES + factor * length
    }
}

const fn text(
    name: &'static str,
    run: fn(&[u8]),
    seeds: fn() -> Vec<Vec<u8>>,
    words: &'static [&'static str],
    endings: &'static [&'static str],
) -> FuzzTarget {
    FuzzTarget { name, run, seeds, words, endings, compressed: false }
}

const fn compressed(
    name: &'static str,
    run: fn(&[u8]),
    seeds: fn() -> Vec<Vec<u8>>,
    endings: &'static [&'static str],
) -> FuzzTarget {
    FuzzTarget { name, run, seeds, words: &[], endings, compressed: true }
}

const NO_WORDS: &[&str] = &[];
const NUMBERS: &[&str] =
    &["nan", "inf", "-1", "1e308", "1e-320", "18446744073709551616", "-0", "#", "\u{feff}", "\r\n"];
const SETTINGS: &[&str] = &[
    "[[",
    "]]",
    "{",
    "}",
    "'''",
    "\"\"\"",
    "nan",
    "-inf",
    "1e400",
    "9223372036854775808",
    "true",
    "[]",
    ".",
];
const MAP_YAML: &[&str] = &[
    "mode: raw",
    "mode: scale",
    "negate: 1",
    "origin: [",
    "image:",
    ".nan",
    ".inf",
    "&a",
    "*a",
    "- ",
    "!!int",
    "1e-30",
    "1e300",
];
const CARMEN: &[&str] = &[
    "FLASER",
    "RLASER",
    "ROBOTLASER1",
    "RAWLASER1",
    "ODOM",
    "PARAM",
    "robot_frontlaser_offset",
    "laser_front_laser_fov",
    "180",
    "nan",
    "1e308",
];
const JSON: &[&str] =
    &["{", "}", "[", "]", "null", "-1", "1e400", "\"\\ud800\"", "18446744073709551615", "\"\"", "4294967295"];

/// Every target.
pub const TARGETS: [FuzzTarget; 36] = [
    text("map_yaml", targets::map_yaml, seeds::map_yaml, MAP_YAML, &["map.yaml", "mask.yaml"]),
    compressed("map_picture", targets::map_picture, seeds::map_picture, &[".pgm", "map.png", ".bmp"]),
    text("graph", targets::graph, seeds::graph, JSON, &[".geojson"]),
    text(
        "file_kind",
        targets::file_kind,
        seeds::file_kind,
        CARMEN,
        &[".log", ".yaml", ".txt", ".csv", ".bag", ".json"],
    ),
    text("places", targets::places, seeds::places, SETTINGS, &["places.toml"]),
    compressed("laser_log", targets::laser_log, seeds::laser_log, &[".log", ".clf", ".log.gz"]),
    text("carmen", targets::laser_log, seeds::laser_log, CARMEN, &[".log", ".clf"]),
    compressed("bag", targets::bag, seeds::bag, &[".mcap", ".db3", ".bag"]),
    text("cdr", targets::cdr, seeds::cdr, NO_WORDS, NO_WORDS),
    text("sqlite", targets::bag, seeds::sqlite, NO_WORDS, &[".db3"]),
    compressed("recording", targets::recording, seeds::recording, &["recording.mcap"]),
    text("image_list", targets::image_list, seeds::image_list, NUMBERS, &["rgb.txt", "depth.txt"]),
    compressed(
        "depth_file",
        targets::depth_file,
        seeds::depth_file,
        &[".png", ".tiff", ".tif", ".exr", ".pgm"],
    ),
    text(
        "trajectory",
        targets::trajectory,
        seeds::trajectory,
        NUMBERS,
        &["groundtruth.txt", ".traj", "a.txt", "b.txt", ".csv"],
    ),
    text("odometry", targets::odometry, seeds::odometry, NUMBERS, &["odometry.txt"]),
    compressed("color_image", targets::color_image, seeds::color_image, &[".jpg", ".png"]),
    compressed("depth_image", targets::depth_image, seeds::depth_image, &[".png", ".tiff", ".exr"]),
    text(
        "camera",
        targets::camera,
        seeds::camera,
        SETTINGS,
        &["camera.toml", "camera.yaml", "orb_slam.yaml", "camera_info.yaml"],
    ),
    compressed("gltf", targets::gltf, seeds::gltf, &[".glb", ".gltf"]),
    text("robot_toml", targets::robot_toml, seeds::robot_toml, SETTINGS, &["robot.toml"]),
    text("scene_toml", targets::scene_toml, seeds::scene_toml, SETTINGS, &["scene.toml"]),
    text("faults_toml", targets::faults_toml, seeds::faults_toml, SETTINGS, &["faults.toml"]),
    text(
        "drive_script",
        targets::drive_script,
        seeds::drive_script,
        NUMBERS,
        &["twists.txt", "waypoints.txt"],
    ),
    text("corridor_problem", targets::corridor_problem, seeds::corridor_problem, NUMBERS, &["problem.txt"]),
    text("relations", targets::relations, seeds::relations, NUMBERS, &[".relations"]),
    text("visual_map", targets::visual_map, seeds::visual_map, NO_WORDS, &["visual.map"]),
    text("checkpoint", targets::checkpoint, seeds::checkpoint, JSON, &[".checkpoint"]),
    text("vocabulary", targets::vocabulary, seeds::vocabulary, NO_WORDS, &[".voc"]),
    text("kobuki", targets::kobuki, seeds::kobuki, NO_WORDS, NO_WORDS),
    text("camera_stream", targets::camera_stream, seeds::camera_stream, JSON, NO_WORDS),
    text("kinect2_dump", targets::kinect2_dump, seeds::kinect2_dump, JSON, NO_WORDS),
    text("kinect2_usb", targets::kinect2_usb, seeds::kinect2_usb, NO_WORDS, NO_WORDS),
    text("mission", targets::mission, seeds::mission, SETTINGS, &["mission.toml"]),
    text("vda5050", targets::vda5050, seeds::vda5050, JSON, NO_WORDS),
    text("home_command", targets::home_command, seeds::home_command, JSON, NO_WORDS),
    text("dbow2", targets::dbow2, seeds::dbow2, NUMBERS, &["dbow2.txt"]),
];
