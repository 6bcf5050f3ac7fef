//! Tests of the recognition of files and folders.

use super::{Expected, FileKind as K};
use proptest::prelude::*;
use std::fs;

fn of(bytes: &[u8]) -> K {
    K::of_bytes(bytes, bytes.len() as u64)
}

#[test]
fn binary_files_by_their_first_bytes() {
    let mcap = |profile: &str, library: &str| {
        let text = |text: &str| [&u32::try_from(text.len()).unwrap().to_le_bytes(), text.as_bytes()].concat();
        let header = [text(profile), text(library)].concat();
        [&b"\x89MCAP0\r\n\x01"[..], &(header.len() as u64).to_le_bytes(), &header].concat()
    };
    for (bytes, kind) in [
        (&b"#ROSBAG V2.0\nE\0\0\0"[..], K::Ros1Bag),
        (b"SQLite format 3\0....", K::Ros2Sqlite),
        (&mcap("ros2", "rosbag2"), K::Ros2Mcap),
        (&mcap("", "trundle"), K::TrundleRecording),
        (&mcap("ros2", "trundle"), K::TrundleRecording),
        (&mcap("x", "foxglove"), K::OtherMcap),
        (&mcap("ros2", "rosbag2")[..20], K::OtherMcap),
        (b"\x1f\x8b\x08\0", K::Gzip),
        (b"\x28\xb5\x2f\xfd\x04", K::Zstd),
        (b"P5\n2 2\n255\n\0\0\0\0", K::Pgm),
        (b"P6 1 1 255\n", K::Netpbm),
        (b"\x89PNG\r\n\x1a\n\0\0", K::Png),
        (b"BM\x3a\0\0\0\0\0\0\0\x36", K::Bmp),
        (b"\xff\xd8\xff\xe0", K::Jpeg),
        (b"II*\0\x08", K::Tiff),
        (b"MM\0+\0\x08", K::Tiff),
        (b"[1,2]", K::Json),
        (b"[\n  {\"a\": 1}]", K::Json),
        (b"# robot\n[[faults]] # one\nx = 1", K::Toml),
        (b"[tool.\"a\"]\n", K::Toml),
        (b"[2026-01-01 12:00:00] started", K::Text),
        (b"RIFF\x10\0\0\0WEBPVP8 ", K::WebP),
        (b"glTF\x02\0\0\0", K::Glb),
        (b"\x7fELF\x02\x01", K::Executable),
        (b"\0\x01\x02", K::Binary),
        (b"caf\xe9 au lait", K::Text),
        (b"\xe9\xa0\xff\xfe\x80 caf\xe9", K::Binary),
        (b"", K::Empty),
    ] {
        assert_eq!(of(bytes), kind, "{bytes:?}");
    }
    let mut stl = vec![0; 84 + 50];
    stl[80] = 1;
    assert_eq!(of(&stl), K::Stl);
}

#[test]
fn vocabularies_of_either_form_are_recognised_and_pointed_to_the_other_command() {
    let text = format!("10 6 0 0\n0 0{} 0.5\n", " 7".repeat(32));
    assert_eq!(of(text.as_bytes()), K::Dbow2Vocabulary);
    assert_eq!(of(b"trundlV1..."), K::Vocabulary);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("v");
    let refused = |bytes: &[u8], expected: Expected| {
        fs::write(&path, bytes).unwrap();
        expected.check(&path).unwrap_err().to_string()
    };
    let dbow2 = refused(text.as_bytes(), Expected::Vocabulary);
    assert!(dbow2.contains("DBoW2, expected a visual vocabulary"), "{dbow2}");
    assert!(dbow2.contains("trundle vocabulary import"), "{dbow2}");
    let own = refused(b"trundlV1...", Expected::Dbow2Vocabulary);
    assert!(own.contains("--vocabulary"), "{own}");
    assert!(refused(b"\x89PNG\r\n\x1a\n\0", Expected::Vocabulary).contains("a PNG picture"));
}

#[test]
fn text_files_by_their_first_lines() {
    for (text, kind) in [
        ("image: m.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n", K::MapYaml),
        ("\u{feff}resolution: 0.05\nimage: m.pgm\n", K::MapYaml),
        ("%YAML:1.0\n---\nCamera.type: \"PinHole\"\nCamera.fx: 500.0\n", K::OrbSlamYaml),
        ("File.version: \"1.0\"\nCamera1.fx: 500.0\n", K::OrbSlamYaml),
        ("%YAML:1.0\nCamera.fy: 500.0\n", K::OrbSlamYaml),
        ("Camera:\n  fy: 500\n", K::StellaVslamYaml),
        ("Camera:\n  name: a\n  fx: 500\n  fy: 500\n", K::StellaVslamYaml),
        ("image_width: 640\ncamera_matrix:\n  data: [1, 0, 0]\n", K::RosCameraYaml),
        ("height: 4\nwidth: 4\ndistortion_model: plumb_bob\nk: [1]\n", K::RosCameraYaml),
        ("cam0:\n  camera_model: pinhole\n  intrinsics: [1, 2, 3, 4]\n", K::KalibrCameraYaml),
        ("{\"width\": 640, \"intrinsic_matrix\": [1]}", K::Open3dCamera),
        ("width = 640\nfx = 500\nfy = 500.0\n", K::CameraToml),
        ("# a robot\n[schedule]\nmap_hz = 2\n", K::Toml),
        ("rosbag2_bagfile_information:\n  version: 5\n", K::RosBagMetadata),
        ("# log\nPARAM robot_frontlaser_offset 0.1\nODOM 1 2 3\n", K::CarmenLog),
        ("FLASER 3 1.0 2.0 81.0 0 0 0 0 0 0 1.5 host 1.5\n", K::CarmenLog),
        ("# timestamp tx ty tz qx qy qz qw\n1.5 0 0 0 0 0 0 1\n", K::TumTrajectory),
        ("timestamp tx ty tz qx qy qz qw\n1.5 0 0 0 0 0 0 1\n", K::TumTrajectory),
        ("1.5 0 0 0\n", K::PlanarTrajectory),
        ("1 0 0 0 0 1 0 0 0 0 1 0\n", K::KittiTrajectory),
        (
            "#timestamp, p_RS_R_x [m], y, z, w, x, y, z\n1403636580838555648,4,1,0,1,0,0,0,1,1,1\n",
            K::EurocTrajectory,
        ),
        ("1.5 rgb/1.png\n", K::ImageList),
        ("{\"asset\": {\"version\": \"2.0\"}, \"scenes\": []}", K::Gltf),
        ("# Blender\nmtllib a.mtl\nv 0 0 0\nf 1 2 3\n", K::Obj),
        ("solid a\nfacet normal 0 0 1\n", K::Stl),
        ("<?xml version=\"1.0\"?>\n<COLLADA>", K::Dae),
        ("{\"type\": \"FeatureCollection\", \"features\": []}", K::GeoJson),
        ("trundle-corridors 1\n\nproblem a\n", K::CorridorProblems),
        ("once upon a time\n", K::Text),
        (" \n\n", K::Empty),
    ] {
        assert_eq!(of(text.as_bytes()), kind, "{text}");
    }
}

#[test]
fn folders_by_their_members() {
    let dir = tempfile::tempdir().unwrap();
    let with = |name: &str, content: &[u8]| {
        let folder = dir.path().join(name.replace('/', "_"));
        fs::create_dir(&folder).unwrap();
        if !name.is_empty() {
            fs::write(folder.join(name), content).unwrap();
        }
        K::of(&folder).unwrap()
    };
    assert_eq!(with("associations.txt", b"1 a.png 1 b.png"), K::SequenceFolder);
    assert_eq!(with("metadata.yaml", b"x"), K::Ros2BagFolder);
    assert_eq!(with("odd.name", b"SQLite format 3\0"), K::Ros2BagFolder);
    assert_eq!(with("readme.txt", b"hello"), K::Folder);
    assert_eq!(
        K::of(&dir.path().join("gone")).unwrap_err().to_string().matches("it does not exist").count(),
        1
    );
}

#[test]
fn a_refusal_says_what_it_is_and_what_to_do() {
    let dir = tempfile::tempdir().unwrap();
    let refusal = |expected: Expected, bytes: &[u8]| {
        let path = dir.path().join("map.yaml");
        fs::write(&path, bytes).unwrap();
        let error = expected.check(&path).unwrap_err().to_string();
        error.split_once("map.yaml: ").unwrap().1.to_owned()
    };
    assert_eq!(
        refusal(Expected::Map, b"P5\n1 1\n255\n\0"),
        "this is a PGM picture, expected a map's YAML file; give the map's YAML file, which names the picture"
    );
    assert!(
        refusal(Expected::Map, b"#ROSBAG V2.0\n").contains("this is a ROS 1 bag, expected a map's YAML file")
    );
    assert!(refusal(Expected::Map, b"#ROSBAG V2.0\n").contains("`rosbags-convert"));
    assert!(refusal(Expected::Scene, b"v 0 0 0\nv 1 0 0\nf 1 2 3\n").contains("an OBJ mesh"));
    assert!(
        refusal(Expected::Recording, b"").starts_with("this is an empty file, expected a trundle recording")
    );
    assert!(Expected::Map.check(&dir.path().join("gone")).is_err());
}

#[cfg(unix)]
#[test]
fn a_pipe_is_refused_where_a_file_is_read_twice() {
    let device = std::path::Path::new("/dev/null");
    for expected in [Expected::LaserLog, Expected::Sequence, Expected::Recording] {
        let problem = expected.check(device).unwrap_err().to_string();
        assert!(problem.contains("a pipe or device") && problem.contains("read twice"), "{problem}");
    }
    assert_eq!(Expected::Toml.check(device).unwrap(), K::Stream);
}

proptest! {
    #[test]
    fn any_bytes_have_a_kind(bytes in prop::collection::vec(any::<u8>(), 0..300), text in ".{0,200}", len in any::<u64>()) {
        let _ = K::of_bytes(&bytes, len).to_string();
        let _ = K::of_bytes(text.as_bytes(), len).to_string();
        for start in [&b"\x89MCAP0\r\n\x01\0\0\0\0\0\0\0\0"[..], b"BM", b"MZ", b"RIFF", b"P5"] {
            let _ = K::of_bytes(&[start, &bytes].concat(), len);
        }
    }
}
