//! A sequence and a map in the forms that other programs write.

use crate::plan::write_room;
use crate::program::{refusal, summary, text, trundle};
use std::fs;
use std::path::{Path, PathBuf};
use trundle::io::read_odometry;

/// A second of a simulated drive as a TUM folder.
fn sequence(folder: &Path) -> PathBuf {
    let (drive, data) = (folder.join("drive.txt"), folder.join("data"));
    fs::write(&drive, "0 0.2 0\n0.8 0 0\n").unwrap();
    let arguments = ["sim", "room", "--quiet", "--rate=10", "--drive", text(&drive), "--record", text(&data)];
    let output = trundle(&arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    data
}

/// The trajectory of `trundle slam`, its summary, and its output.
fn track(data: &Path, out: &Path) -> (String, serde_json::Value, String) {
    let output = trundle(&["slam", text(data), "--quiet", "--height=0.45", "--tilt=8", "--out", text(out)]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{message}");
    (fs::read_to_string(out.join("trajectory.txt")).unwrap(), summary(out), message)
}

#[test]
fn a_sequence_in_other_forms_is_the_same_sequence() {
    let scratch = tempfile::tempdir().unwrap();
    let (data, out) = (sequence(scratch.path()), scratch.path().join("out"));
    let file = |name: &str| data.join(name);
    let read = |name: &str| fs::read_to_string(file(name)).unwrap();
    let (expected, numbers, message) = track(&data, &out);
    assert!(message.is_empty() && numbers["camera_assumed"] == false, "{message}");

    // The camera comes from orb_slam.yaml, the images from associations.txt, and the odometry has TUM's format.
    let poses = read_odometry(&file("odometry.txt")).unwrap();
    let line = |(stamp, pose): &(trundle::core::Stamp, trundle::core::Pose2)| {
        let half = pose.theta / 2.0;
        format!("{stamp} {} {} 0 0 0 {} {}\n", pose.x, pose.y, half.sin(), half.cos())
    };
    fs::write(file("odometry.txt"), poses.iter().map(line).collect::<String>()).unwrap();
    let lists = [read("rgb.txt"), read("depth.txt")];
    ["camera.toml", "rgb.txt", "depth.txt"].iter().for_each(|name| fs::remove_file(file(name)).unwrap());
    let (found, numbers, message) = track(&data, &out);
    assert_eq!(found.lines().count(), expected.lines().count());
    assert!(numbers["camera"].as_str().unwrap().ends_with("orb_slam.yaml"), "{numbers}");
    assert!(message.is_empty() && numbers["ate_rmse_m"].as_f64().unwrap() < 0.02, "{message} {numbers}");
    let mapped =
        trundle(&["map", text(&data), "--quiet", "--particles=2", "--map-image=png", "--out", text(&out)]);
    assert!(mapped.status.code() != Some(2), "{}", String::from_utf8_lossy(&mapped.stderr));
    assert!(out.join("map.png").exists());

    // Lists from last to first, with a byte order mark, in nanoseconds; ground truth of EuRoC with a broken row.
    let nanoseconds = |line: &str| {
        let (stamp, name) = line.split_once(' ').unwrap();
        format!("1700000{:0>12} {name}\n", stamp.replace('.', ""))
    };
    for (name, list) in ["rgb.txt", "depth.txt"].iter().zip(&lists) {
        let rows = list.lines().filter(|line| !line.starts_with('#')).rev().map(nanoseconds);
        fs::write(file(name), format!("\u{feff}timestamp filename\n{}", rows.collect::<String>())).unwrap();
    }
    fs::write(file("groundtruth.txt"), "#timestamp, p_x, p_y, p_z, q_w, q_x, q_y, q_z\n5,0,0\n").unwrap();
    fs::remove_file(file("odometry.txt")).unwrap();
    let (found, _, message) = track(&data, &out);
    assert_eq!(found.lines().count(), expected.lines().count());
    for words in ["taken as nanoseconds", "the rows are sorted", "row left out"] {
        assert_eq!(message.matches(words).count(), 1, "{words}: {message}");
    }
}

#[test]
fn unreadable_depth_images_and_an_assumed_camera_give_one_warning_each() {
    let scratch = tempfile::tempdir().unwrap();
    let (data, out) = (sequence(scratch.path()), scratch.path().join("out"));
    for entry in fs::read_dir(data.join("depth")).unwrap() {
        image::GrayImage::new(512, 424).save(entry.unwrap().path()).unwrap();
    }
    let message = refusal(&["slam", text(&data), "--quiet", "--out", text(&out)]);
    assert_eq!(message.matches("8-bit grey pixels").count(), 2, "one warning and the error: {message}");
    assert!(message.contains("times: ") && message.lines().count() == 2, "{message}");
    for name in ["camera.toml", "orb_slam.yaml"] {
        fs::remove_file(data.join(name)).unwrap();
    }
    let message = refusal(&["slam", text(&data), "--quiet", "--out", text(&out)]);
    assert!(message.contains("freiburg1 is assumed"), "{message}");
    fs::write(
        data.join("camera.toml"),
        "width = 512\nheight = 424\nfx = 365\nfy = 365\ncx = 256\ncy = 212\ndepth_scale = 0.001\n",
    )
    .unwrap();
    let message = refusal(&["slam", text(&data), "--quiet", "--out", text(&out)]);
    assert!(
        message.contains("camera.toml, line 7: depth_scale is 0.001, expected units per metre"),
        "{message}"
    );
}

#[test]
fn a_map_is_planned_on_in_any_picture_format() {
    let scratch = tempfile::tempdir().unwrap();
    let map = write_room(scratch.path());
    let plan = || {
        let out = scratch.path().join("out");
        let output =
            trundle(&["plan", text(&map), "--from=1,1,0", "--to=5,1,0", "--quiet", "--out", text(&out)]);
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{message}");
        (fs::read(out.join("trajectory.csv")).unwrap(), message)
    };
    let (expected, message) = plan();
    assert!(message.is_empty(), "{message}");
    let yaml = fs::read_to_string(&map).unwrap();
    let pgm = fs::read(scratch.path().join("room.pgm")).unwrap();
    let greys = pgm[pgm.len() - 120 * 80..].to_vec();
    let grey = image::DynamicImage::ImageLuma8(image::GrayImage::from_raw(120, 80, greys).unwrap());
    for (name, image) in [("grey.png", grey.clone()), ("rgba.png", grey.to_rgba8().into())] {
        image.save(scratch.path().join(name)).unwrap();
        fs::write(&map, yaml.replace("room.pgm", name)).unwrap();
        assert!(plan() == (expected.clone(), String::new()), "{name}");
    }
    let refused = || refusal(&["plan", text(&map), "--from=1,1,0", "--to=5,1,0"]);
    fs::write(&map, yaml.replace("resolution: 0.05", "resolution: 0,05")).unwrap();
    assert!(refused().contains("resolution is '0,05', expected a decimal point: 0.05"));
    fs::write(&map, format!("{yaml}resolution: 0.1\n")).unwrap();
    assert!(refused().contains("resolution is there a second time"));
}

#[test]
fn trajectories_that_cannot_be_compared_are_refused_with_the_reason() {
    let scratch = tempfile::tempdir().unwrap();
    let file = |name: &str, lines: String| {
        let path = scratch.path().join(name);
        fs::write(&path, lines).unwrap();
        path
    };
    let rounded = file(
        "rounded.txt",
        (0..100).map(|i| format!("{} {} 0 0 0 0 0 1\n", i / 20, f64::from(i) * 0.1)).collect(),
    );
    let message = refusal(&["eval", "relations", text(&rounded), text(&rounded)]);
    assert!(message.contains("95 of 100 poses have the timestamp of the pose before"), "{message}");
    let short =
        file("short.txt", (0..9).map(|i| format!("{i} {} 0 0 0 0 0 1\n", f64::from(i) * 0.1)).collect());
    let message = refusal(&["eval", "relations", text(&short), text(&short)]);
    assert!(message.contains("its path is 0.80 m long, expected at least 1 m"), "{message}");
}
