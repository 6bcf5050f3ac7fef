//! `trundle map` on other inputs than CARMEN logs, and `trundle eval` on what it made.

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
