//! `trundle map` on inputs other than CARMEN logs, and `trundle eval` on its results.

use crate::program::{refusal, summary, text, trundle};
use std::fs;
use std::path::{Path, PathBuf};
use trundle::core::{Cell, OccupancyGrid};
use trundle::io::{OutputFolder, write_map};

fn bag(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/ros2").join(name)
}

#[test]
fn ros_bags_become_maps_and_their_trajectories_are_judged() {
    let scratch = tempfile::tempdir().unwrap();
    for name in ["zstd.mcap", "lz4.mcap", "sqlite"] {
        let out = scratch.path().join(name);
        let output = trundle(&["map", text(&bag(name)), "--particles=3", "--quiet", "--out", text(&out)]);
        assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(
            (summary(&out)["scans"].as_u64(), summary(&out)["bad_ranges"].as_u64()),
            (Some(10), Some(20))
        );
        let map = trundle::io::read_map(&out.join("map.yaml")).unwrap();
        assert!(map.cells().iter().filter(|cell| **cell == Cell::Occupied).count() > 100, "{name}");
    }
    // The robot drove along x at 0.5 m/s.
    let found = scratch.path().join("zstd.mcap/trajectory.txt");
    let truth = scratch.path().join("truth.txt");
    let lines = fs::read_to_string(&found).unwrap();
    let first: f64 = lines.split_whitespace().next().unwrap().parse().unwrap();
    let line = |line: &str| {
        let stamp = line.split_whitespace().next().unwrap();
        format!("{stamp} {} 0 0\n", 0.5 * (stamp.parse::<f64>().unwrap() - first))
    };
    fs::write(&truth, lines.lines().map(line).collect::<String>()).unwrap();
    let judged = scratch.path().join("judged");
    let output = trundle(&["eval", "relations", text(&truth), text(&found), "--out", text(&judged)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(summary(&judged)["all_translation_m"]["mean"].as_f64().unwrap() < 0.05);
}

#[test]
fn a_map_of_the_images_of_a_bag_names_their_topics() {
    let scratch = tempfile::tempdir().unwrap();
    let [data, bag, out] = ["data", "bag", "out"].map(|name| scratch.path().join(name));
    let sim = ["sim", "room", "--quiet", "--duration", "2", "--rate", "5", "--record", text(&data)];
    assert!(trundle(&sim).status.success());
    assert!(trundle(&["convert", text(&data), text(&bag), "--to", "bag", "--quiet"]).status.success());
    let output = trundle(&["map", text(&bag.join("bag.mcap")), "--particles=3", "--out", text(&out)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let numbers = summary(&out);
    let topic = |name: &str| numbers[name].as_str().unwrap_or_default().to_owned();
    assert!(topic("scan_topic").contains("depth") && topic("odometry_topic") == "/odom", "{numbers}");
    assert!(String::from_utf8_lossy(&output.stdout).contains("odometry is from"), "in the table too");
    let output = trundle(&["map", text(&data), "--particles=3", "--quiet", "--out", text(&out)]);
    assert!(output.status.success());
    assert_eq!(summary(&out)["scan_topic"], serde_json::Value::Null, "a folder has no topics");
}

#[test]
fn a_map_is_judged_where_it_lies_and_where_it_fits() {
    let scratch = tempfile::tempdir().unwrap();
    let room = "########\n#......#\n#..##..#\n#......#\n#......#\n########";
    let out = OutputFolder::create(&scratch.path().join("maps")).unwrap();
    write_map(&out, "truth", &OccupancyGrid::from_ascii(0.1, room).unwrap()).unwrap();
    let folder = out.commit().unwrap();
    let (map, judged) = (folder.join("truth.yaml"), scratch.path().join("judged"));
    let precision = |more: &[&str]| {
        let all =
            [&["eval", "map", text(&map), text(&map), "--quiet", "--out", text(&judged)], more].concat();
        assert!(trundle(&all).status.success());
        summary(&judged)["precision"].as_f64().unwrap()
    };
    assert_eq!(precision(&[]), 1.0);
    assert_eq!(precision(&["--at=0.04,-0.03,1"]), 1.0);
    assert!(precision(&["--at=0.06,0.06,0", "--exact"]) < 0.5);
    let sentence = refusal(&["eval", "map", text(&map), text(&map), "--within=-1"]);
    assert!(sentence.contains("within is -1 m"), "{sentence}");
}

#[test]
fn the_lines_of_a_log_are_chosen_by_name_and_named_in_the_summary() {
    let scratch = tempfile::tempdir().unwrap();
    let log = scratch.path().join("two.log");
    let walls = |i: usize| format!("{:.3}", (2.0 / (0.1 * i as f64 - 1.5).cos().abs()).min(6.0));
    let ranges: Vec<String> = (0..31).map(walls).collect();
    let sweep =
        |name: &str, t: usize| format!("{name} 0 -1.5 3 0.1 8 0.01 0 31 {} 0 {t}.0 h 0\n", ranges.join(" "));
    let odometry = |t: usize| format!("ODOM 0.{t} 0 0 0 0 0 {t}.0 h 0\n");
    let lines = (1..6).map(|t| [odometry(t), sweep("RAWLASER1", t), sweep("RAWLASER3", t)].concat());
    fs::write(&log, format!("\u{feff}{}{}", lines.collect::<String>(), sweep("RAWLASER3", 6))).unwrap();
    let out = scratch.path().join("out");
    let run = |more: &[&str]| {
        let output = trundle(&[&["map", text(&log), "--particles=2", "--out", text(&out)], more].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        (summary(&out), String::from_utf8(output.stdout).unwrap())
    };
    let (numbers, table) = run(&[]);
    assert_eq!((&numbers["scan_topic"], &numbers["odometry_topic"]), (&"RAWLASER3".into(), &"ODOM".into()));
    assert_eq!(numbers["topics_left"], serde_json::json!({ "RAWLASER1": 5 }));
    assert!(table.contains("unused topics") && table.contains("RAWLASER1 (5)"), "{table}");
    assert_eq!(run(&["--scan-topic=RAWLASER1"]).0["scan_topic"], "RAWLASER1");
    let sentence = refusal(&["map", text(&log), "--scan-topic=/scan"]);
    assert!(
        sentence.contains("no scan on /scan, expected one of: RAWLASER1 (5), RAWLASER3 (6)"),
        "{sentence}"
    );
}

#[test]
fn inputs_without_poses_are_refused_by_name() {
    let scratch = tempfile::tempdir().unwrap();
    let dir = scratch.path().join("rgbd");
    fs::create_dir_all(&dir).unwrap();
    fs::write(dir.join("rgb.txt"), "1 a.png\n").unwrap();
    fs::write(dir.join("depth.txt"), "1 b.png\n").unwrap();
    let sentence = refusal(&["map", text(&dir)]);
    assert!(sentence.contains("neither odometry.txt nor groundtruth.txt"), "{sentence}");
    let relations = scratch.path().join("a.relations");
    fs::write(&relations, "1 2 3\n").unwrap();
    let sentence = refusal(&["eval", "relations", "--file", text(&relations), text(&relations)]);
    assert!(sentence.contains("a.relations, line 1: "), "{sentence}");
}

/// The range to the walls of a room of 6 x 4 m with a box at one wall, m.
fn room_range(x: f64, y: f64, heading: f64) -> f64 {
    let is_free = |x: f64, y: f64| {
        let is_in_box = (4.0..5.0).contains(&x) && y > 3.0;
        (0.0..6.0).contains(&x) && (0.0..4.0).contains(&y) && !is_in_box
    };
    let along = |r: &f64| is_free(x + r * heading.cos(), y + r * heading.sin());
    (1..800).map(|k| 0.01 * f64::from(k)).find(|r| !along(r)).unwrap_or(8.0)
}

#[test]
fn a_laser_that_hangs_upside_down_is_named() {
    let scratch = tempfile::tempdir().unwrap();
    let log = scratch.path().join("mirrored.log");
    let scan = |i: i32| {
        let at = f64::from(i) * 0.15;
        let (x, y) = (2.0 + at.sin(), 1.5 + 0.6 * (1.0 - at.cos()));
        let ranges: Vec<String> = (0..72)
            .map(|k| format!("{:.3}", room_range(x, y, at + 3.1 - f64::from(k) * 5_f64.to_radians())))
            .collect();
        let pose = format!("{x} {y} {at}");
        let (ranges, step) = (ranges.join(" "), 5_f64.to_radians());
        format!("ROBOTLASER1 0 -3.1 6.2 {step} 12 0.01 0 72 {ranges} 0 {pose} {pose} 0 0 0 0 0 {i}.0 h 0\n")
    };
    fs::write(&log, (0..80).map(scan).collect::<String>()).unwrap();
    let out = scratch.path().join("out");
    let run = |more: &[&str]| {
        let output = trundle(&[&["map", text(&log), "--particles=5", "--out", text(&out)], more].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stderr).unwrap()
    };
    let warned = run(&[]);
    assert!(warned.contains("the laser seems to be mounted upside down: try --upside-down"), "{warned}");
    assert!(summary(&out)["mount_hint"].as_str().is_some_and(|hint| hint.contains("--upside-down")));
    let right = run(&["--upside-down"]);
    assert!(!right.contains("contradict") && summary(&out)["mount_hint"].is_null(), "{right}");
}
