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
