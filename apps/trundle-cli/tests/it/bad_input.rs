//! Wrong input of every command: message, exit code, and no output.

use crate::{
    plan::write_room,
    program::{refusal, summary, text, trundle},
};
use std::fs;

#[test]
fn numbers_on_the_command_line() {
    let map = "map.yaml";
    assert!(refusal(&["plan", map, "--from=NaN,0,0", "--to=1,1,0"]).contains("X is NaN m"));
    assert!(refusal(&["plan", map, "--from=0,0", "--to=1,1,0"]).contains("2 numbers, expected 3"));
    assert!(refusal(&["plan", map, "--from=0,0,0", "--to=1,inf,0"]).contains("Y is inf m"));
    assert!(refusal(&["demo", "--goal=1,2,x"]).contains("DEG is 'x'"));
    assert!(refusal(&["demo", "--goal=1000,0,0"]).contains("outside the room"));
    assert!(refusal(&["slam", ".", "--frames=0"]).contains("0"));
    assert!(refusal(&["demo", "--threads=0"]).contains("0"));
    assert!(refusal(&["demo", "--scene=moon"]).contains("scene is moon, expected one of demo"));
}

#[test]
fn ends_of_a_plan_in_a_wall_and_off_the_map() {
    let scratch = tempfile::tempdir().unwrap();
    let map = write_room(scratch.path());
    let out = scratch.path().join("out");
    let plan = |from: &str, to: &str| {
        let (from, to) = (format!("--from={from}"), format!("--to={to}"));
        let output = trundle(&["plan", text(&map), &from, &to, "--out", text(&out)]);
        assert_eq!(output.status.code(), Some(1), "no plan");
        assert_eq!(summary(&out)["success"], false);
        String::from_utf8(output.stderr).unwrap()
    };
    for (from, to, words) in [
        ("0.02,1,0", "5,1,0", "start"),
        ("1,1,0", "3.02,1,0", "goal"),
        ("1,1,0", "50,1,0", "goal"),
        ("-9,1,0", "5,1,0", "start"),
    ] {
        let sentence = plan(from, to);
        assert!(sentence.contains(words) && sentence.contains("room.yaml"), "{sentence}");
    }
    assert!(!out.join("trajectory.csv").exists());
}

#[test]
fn maps_that_are_none() {
    let scratch = tempfile::tempdir().unwrap();
    let map = write_room(scratch.path());
    let yaml = fs::read_to_string(&map).unwrap();
    let plan = || refusal(&["plan", text(&map), "--from=1,1,0", "--to=5,1,0"]);
    fs::write(&map, yaml.replace("resolution: 0.05\n", "")).unwrap();
    assert!(plan().contains("resolution"));
    fs::write(&map, yaml.replace("room.pgm", "gone.pgm")).unwrap();
    assert!(plan().contains("gone.pgm"));
    fs::write(&map, yaml).unwrap();
    let picture = fs::read(scratch.path().join("room.pgm")).unwrap();
    fs::write(scratch.path().join("room.pgm"), &picture[..picture.len() / 2]).unwrap();
    assert!(plan().contains("room.pgm"));
    assert!(refusal(&["plan", "nowhere.yaml", "--from=1,1,0", "--to=5,1,0"]).contains("nowhere.yaml"));
}

#[test]
fn robot_files_with_wrong_keys_and_values() {
    let scratch = tempfile::tempdir().unwrap();
    let file = scratch.path().join("robot.toml");
    let config = |content: &str| {
        fs::write(&file, content).unwrap();
        refusal(&["config", text(&file)])
    };
    let sentence = config("\nfootprnt = 0.2\n");
    assert!(sentence.contains("robot.toml, line 2") && sentence.contains("footprnt"), "{sentence}");
    assert_eq!(sentence.lines().count(), 1, "{sentence}");
    assert!(config("footprint_radius = -1.0\n").contains("is -1 m"));
    assert!(config("[schedule]\nmap_hz = 0.0\n").contains("schedule.map_hz is 0 1/s"));
    assert!(config("[mount]\nz_m = nan\n").contains("mount.z_m is NaN m"));
    assert!(config("footprint_radius = \"wide\"\n").contains("robot.toml"));
}

#[test]
fn folders_and_recordings_that_are_none() {
    let scratch = tempfile::tempdir().unwrap();
    let empty = scratch.path().join("empty");
    fs::create_dir(&empty).unwrap();
    assert!(refusal(&["slam", text(&empty)]).contains("rgb.txt"));
    assert!(refusal(&["slam", text(&empty), "--camera", "freiburg9"]).contains("freiburg9"));
    let file = scratch.path().join("garbage.mcap");
    fs::write(&file, b"this is not a recording").unwrap();
    assert!(refusal(&["replay", text(&file)]).contains("garbage.mcap"));
    assert!(refusal(&["replay", text(&scratch.path().join("gone.mcap"))]).contains("gone.mcap"));
    assert!(refusal(&["demo", "--out", text(&file)]).contains("garbage.mcap"));
}

#[test]
fn a_file_of_another_kind_is_named_whatever_its_name_by_every_command() {
    let scratch = tempfile::tempdir().unwrap();
    let file = |name: &str, bytes: &[u8]| {
        let path = scratch.path().join(name);
        fs::write(&path, bytes).unwrap();
        path
    };
    let ros1 = file("run.log", b"#ROSBAG V2.0\n\x45\0\0\0");
    assert!(refusal(&["map", text(&ros1)]).contains("run.log: "), "a ROS 1 bag without a scan");
    assert!(
        refusal(&["slam", text(&ros1)]).contains("run.log: the bag is truncated"),
        "a ROS 1 bag without images"
    );
    assert!(refusal(&["replay", text(&ros1)]).contains("run.log: the bag is truncated"), "sensors of a bag");
    let picture = file("map.yaml", b"P5\n2 2\n255\n\0\0\0\0");
    let mesh = file("room.glb", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let empty = file("run.mcap", b"");
    let poses = ["--from=1,1,0", "--to=2,1,0"];
    for (file, words) in [
        (&ros1, ["this is a ROS 1 bag", "`rosbags-convert"]),
        (&picture, ["this is a PGM picture", ""]),
        (&mesh, ["this is an OBJ mesh", ".glb or .gltf"]),
        (&empty, ["this is an empty file", ""]),
    ] {
        let file = text(file);
        for arguments in [
            &["plan", file, poses[0], poses[1]][..],
            &["dock", file, poses[0], poses[1]],
            &["sim", file],
            &["demo", "--scene", file],
            &["eval", "map", file, file],
        ] {
            let sentence = refusal(arguments);
            assert!(words.iter().all(|word| sentence.contains(word)), "{arguments:?}: {sentence}");
        }
        if file != text(&ros1) {
            let sentence = refusal(&["replay", file]);
            assert!(words.iter().all(|word| sentence.contains(word)), "replay: {sentence}");
        }
    }
    assert!(
        refusal(&["slam", text(&picture)]).contains("this is a PGM picture, expected a TUM RGB-D folder")
    );
    assert!(refusal(&["plan", text(&picture), poses[0], poses[1]]).contains("give the map's YAML file"));
}

#[test]
fn a_folder_of_maps_that_is_none_is_refused() {
    let scratch = tempfile::tempdir().unwrap();
    let (file, out) = (scratch.path().join("map.yaml"), scratch.path().join("out"));
    fs::write(&file, "").unwrap();
    for (maps, problem) in [("/nowhere", "there is no such folder"), (text(&file), "this is no folder")] {
        let sentence = refusal(&["demo", "--live", "127.0.0.1:0", "--maps", maps, "--out", text(&out)]);
        let expected = "expected a folder of maps, each NAME.yaml with its picture";
        for part in ["--maps", maps, problem, expected] {
            assert!(sentence.contains(part), "'{part}': {sentence}");
        }
    }
    assert!(!out.exists());
}
