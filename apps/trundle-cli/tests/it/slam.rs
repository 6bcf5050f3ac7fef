//! `trundle slam` on image folders and recordings, and saved maps.

use crate::program::{refusal, shared, summary, text, trundle};
use std::{fs, path::Path};

/// A folder with the first `count` frames of the real sequence.
pub fn short_sequence(from: &Path, to: &Path, count: usize) {
    for list in ["rgb.txt", "depth.txt"] {
        let lines = fs::read_to_string(from.join(list)).unwrap();
        let lines: Vec<&str> = lines.lines().filter(|line| !line.starts_with('#')).take(count).collect();
        fs::write(to.join(list), lines.join("\n")).unwrap();
        for line in lines {
            let file = line.split(' ').nth(1).unwrap();
            fs::create_dir_all(to.join(file).parent().unwrap()).unwrap();
            fs::copy(from.join(file), to.join(file)).unwrap();
        }
    }
}

#[test]
fn a_real_sequence_is_tracked_and_a_broken_frame_is_named_and_skipped() {
    let Some(data) = shared("tum_fr1_rpy_400") else { return };
    let scratch = tempfile::tempdir().unwrap();
    let (sequence, out) = (scratch.path().join("short"), scratch.path().join("out"));
    fs::create_dir(&sequence).unwrap();
    short_sequence(&data, &sequence, 12);
    let list = fs::read_to_string(sequence.join("rgb.txt")).unwrap();
    let broken = list.lines().nth(5).unwrap().split(' ').nth(1).unwrap();
    fs::write(sequence.join(broken), b"no image").unwrap();
    let output = trundle(&["slam", text(&sequence), "--out", text(&out)]);
    let complaint = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{complaint}");
    let name = Path::new(broken).file_name().unwrap().to_str().unwrap();
    assert!(complaint.contains(name), "{complaint}");
    let numbers = summary(&out);
    assert_eq!(numbers["frames"], 11);
    assert_eq!(numbers["frames_ok"], 11);
    assert_eq!(numbers["frames_unreadable"].as_array().unwrap().len(), 1);
    for name in ["map.pgm", "map.yaml", "trajectory.txt", "recording.mcap", "report.html"] {
        assert!(fs::metadata(out.join(name)).unwrap().len() > 20, "{name}");
    }
}

#[test]
fn a_sequence_that_cannot_be_read_is_refused_and_a_black_one_fails() {
    let Some(data) = shared("tum_fr1_rpy_400") else { return };
    let scratch = tempfile::tempdir().unwrap();
    let (sequence, out) = (scratch.path().join("short"), scratch.path().join("out"));
    fs::create_dir(&sequence).unwrap();
    short_sequence(&data, &sequence, 3);
    let list = fs::read_to_string(sequence.join("rgb.txt")).unwrap();
    let black = image::RgbImage::new(640, 480);
    for line in list.lines() {
        black.save(sequence.join(line.split(' ').nth(1).unwrap())).unwrap();
    }
    let output = trundle(&["slam", text(&sequence), "--quiet", "--out", text(&out)]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(summary(&out)["success"], false);
    for line in list.lines() {
        fs::write(sequence.join(line.split(' ').nth(1).unwrap()), b"no image").unwrap();
    }
    let output = trundle(&["slam", text(&sequence), "--quiet", "--out", text(&out)]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8(output.stderr).unwrap().contains("no frame can be read"));
}

/// Output of tracking a sequence, with more arguments.
fn track(sequence: &Path, out: &Path, extra: &[&str]) -> serde_json::Value {
    let mut args = vec!["slam", text(sequence), "--quiet", "--out", text(out)];
    args.extend(extra);
    let output = trundle(&args);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    summary(out)
}

#[test]
fn a_saved_map_is_the_same_on_any_threads_and_is_begun_with() {
    let Some(data) = shared("tum_fr1_rpy_400") else { return };
    let scratch = tempfile::tempdir().unwrap();
    let [sequence, one, two, again] = ["short", "one", "two", "again"].map(|name| scratch.path().join(name));
    fs::create_dir(&sequence).unwrap();
    short_sequence(&data, &sequence, 40);
    track(&sequence, &one, &["--threads", "1"]);
    track(&sequence, &two, &["--threads", "2"]);
    for name in ["visual.map", "trajectory.txt", "recording.mcap"] {
        assert!(fs::read(one.join(name)).unwrap() == fs::read(two.join(name)).unwrap(), "{name}");
    }
    let map = one.join("visual.map");
    let numbers = track(&sequence, &again, &["--map", text(&map), "--localise"]);
    let located = numbers["frames_ok"].as_u64().unwrap() + numbers["frames_weak"].as_u64().unwrap();
    assert!(located >= 38, "{numbers}");
    assert!(fs::read(again.join("visual.map")).unwrap() == fs::read(&map).unwrap(), "it was only to locate");
    let located =
        ["slam", text(&sequence), "--map", text(&map), "--localise", "--depth-scale", "2500", "--quiet"];
    let output = trundle(&[&located[..], &["--out", text(&again)]].concat());
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(1) && complaint.contains("depth_scale"), "{complaint}");
    let mut damaged = fs::read(&map).unwrap();
    let middle = damaged.len() / 2;
    damaged[middle] ^= 4;
    let broken = scratch.path().join("broken.map");
    fs::write(&broken, damaged).unwrap();
    let complaint = refusal(&["slam", text(&sequence), "--map", text(&broken), "--out", text(&again)]);
    assert!(complaint.contains("broken.map") && complaint.contains("checksum"), "{complaint}");
}

/// A camera file of ROS holds no depth scale; the images of this folder have TUM's 5000 units per metre.
#[test]
fn a_depth_scale_that_no_file_holds_is_found_by_the_images() {
    let scratch = tempfile::tempdir().unwrap();
    let (data, out) = (scratch.path().join("data"), scratch.path().join("out"));
    let camera = scratch.path().join("camera.yaml");
    std::fs::write(
        &camera,
        "image_width: 512\nimage_height: 424\ndistortion_model: plumb_bob\n\
         camera_matrix: {rows: 3, cols: 3, data: [361.5617, 0, 255.5, 0, 367.19477, 211.5, 0, 0, 1]}\n",
    )
    .unwrap();
    assert!(trundle(&["sim", "room", "--quiet", "--duration=0.5", "--record", text(&data)]).status.success());
    let slam = |more: &[&str]| {
        let common = ["slam", text(&data), "--camera", text(&camera), "--height=0.45", "--tilt=8", "--quiet"];
        let output = trundle(&[&common, more, &["--out", text(&out)]].concat());
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{message}");
        message
    };
    let message = slam(&[]);
    assert!(message.contains("5000 units per metre are assumed by the images"), "{message}");
    assert_eq!(summary(&out)["frames_lost"], 0);
    let message = slam(&["--depth-scale=5000"]);
    assert!(!message.contains("depth scale"), "{message}");
}

#[test]
fn a_wrong_depth_scale_is_found_by_ground_truth_and_by_odometry() {
    let scratch = tempfile::tempdir().unwrap();
    let (data, out, drive) =
        (scratch.path().join("in"), scratch.path().join("out"), scratch.path().join("drive.txt"));
    std::fs::write(&drive, "0 0.4 0.5\n2 0.4 -0.5\n4 0 0\n").unwrap();
    let sim = ["sim", "office", "--quiet", "--drive", text(&drive), "--record", text(&data)];
    assert!(trundle(&sim).status.success());
    let slam = |scale: &str| {
        let common = ["slam", text(&data), "--quiet", "--record=none", "--depth-scale", scale, "--out"];
        let output = trundle(&[&common[..], &[text(&out)]].concat());
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let fit = "about 5000 fits (units per metre)";
    assert_eq!(slam("5000").0, Some(0));
    assert_eq!(summary(&out)["depth_scale_assumed"], false);
    let (code, message) = slam("2500");
    assert_eq!(code, Some(1), "{message}");
    let problem = "2.00 times as large as by groundtruth.txt with depth_scale = 2500";
    assert!(message.contains(problem) && message.contains(fit), "{message}");
    assert!(summary(&out)["failure"].as_str().unwrap().contains(fit));
    std::fs::remove_file(data.join("groundtruth.txt")).unwrap();
    let (code, message) = slam("10000");
    assert_eq!(code, Some(1), "{message}");
    assert!(message.contains("by odometry.txt") && message.contains(fit), "{message}");
}

#[test]
fn a_map_by_odometry_of_another_clock_names_both_ranges_of_time() {
    let scratch = tempfile::tempdir().unwrap();
    let data = scratch.path().join("in");
    assert!(trundle(&["sim", "room", "--quiet", "--duration=0.5", "--record", text(&data)]).status.success());
    std::fs::write(data.join("odometry.txt"), "1000 0 0 0\n1001 0.1 0 0\n").unwrap();
    let map = trundle(&["map", text(&data), "--quiet", "--out", text(&scratch.path().join("out"))]);
    let message = String::from_utf8(map.stderr).unwrap();
    assert_eq!(map.status.code(), Some(2), "{message}");
    let both = message.contains("the images are of 0") && message.contains("the poses of 1000");
    assert!(both && message.contains("odometry.txt") && message.contains("one clock"), "{message}");
}
