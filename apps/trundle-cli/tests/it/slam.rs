use crate::program::{shared, summary, text, trundle};
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
fn a_sequence_that_cannot_be_read_is_refused_and_a_black_one_is_no_success() {
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
