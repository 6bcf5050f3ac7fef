//! Runs that miss their aim: exit code 1, and the likely cause.

use crate::program::trundle;
use std::fmt::Write as _;
use std::path::Path;

/// A CARMEN log of ten scans of 181 beams, all of about one range.
fn log_of(dir: &Path, range: f64) -> String {
    log_of_scans(dir, range, 10)
}

fn log_of_scans(dir: &Path, range: f64, scans: u32) -> String {
    let file = dir.join("robot.log");
    let mut text = String::new();
    for i in 0..scans {
        let (x, stamp) = (f64::from(i) * 0.5, f64::from(i));
        write!(text, "FLASER 181").unwrap();
        (0..181).for_each(|beam| write!(text, " {:.2}", range * (1.0 + f64::from(beam) * 1e-3)).unwrap());
        writeln!(text, " {x} 0 0 {x} 0 0 {stamp} robot {stamp}").unwrap();
    }
    std::fs::write(&file, text).unwrap();
    file.to_str().unwrap().to_owned()
}

#[test]
fn a_map_of_ranges_that_are_zero_or_in_millimetres_fails() {
    for (range, cause) in [(0.0, "no beam of any scan hit an obstacle"), (4000.0, "are they in millimetres?")]
    {
        let scratch = tempfile::tempdir().unwrap();
        let log = log_of(scratch.path(), range);
        let out = scratch.path().join("out");
        let run = trundle(&["map", &log, "--quiet", "--out", out.to_str().unwrap()]);
        assert_eq!(run.status.code(), Some(1), "{range}");
        let message = String::from_utf8(run.stderr).unwrap();
        assert!(message.contains(cause), "{range}: {message}");
        let summary = std::fs::read_to_string(out.join("summary.json")).unwrap();
        assert!(summary.contains("\"success\": false"), "{summary}");
    }
}

#[test]
fn a_long_log_in_millimetres_fails_after_a_few_scans() {
    let scratch = tempfile::tempdir().unwrap();
    let log = log_of_scans(scratch.path(), 4000.0, 200);
    let out = scratch.path().join("out");
    let run = trundle(&["map", &log, "--quiet", "--out", out.to_str().unwrap()]);
    let message = String::from_utf8(run.stderr).unwrap();
    assert_eq!(run.status.code(), Some(1), "{message}");
    assert!(
        message.contains("10 of 11 scans do not overlap") && message.contains("millimetres?"),
        "{message}"
    );
    let summary = std::fs::read_to_string(out.join("summary.json")).unwrap();
    assert!(
        summary.contains("\"success\": false") && !summary.contains("\"interrupted\": true"),
        "{summary}"
    );
}

#[test]
fn docking_in_a_scan_without_returns_fails() {
    let scratch = tempfile::tempdir().unwrap();
    let log = log_of(scratch.path(), 0.0);
    let run = trundle(&["dock", &log, "--to=0.3,0,0", "--out", scratch.path().join("out").to_str().unwrap()]);
    assert_eq!(run.status.code(), Some(1));
    assert!(String::from_utf8(run.stderr).unwrap().contains("no beam of the scan hit an obstacle"));
}

#[test]
fn docking_in_a_scan_in_millimetres_fails() {
    let scratch = tempfile::tempdir().unwrap();
    let log = log_of(scratch.path(), 3000.0);
    let run = trundle(&["dock", &log, "--to=0.3,0,0", "--out", scratch.path().join("out").to_str().unwrap()]);
    let message = String::from_utf8(run.stderr).unwrap();
    assert_eq!(run.status.code(), Some(1), "{message}");
    assert!(message.contains("are they in millimetres?"), "{message}");
}

#[test]
fn a_topic_of_the_odometry_goes_with_a_bag() {
    let scratch = tempfile::tempdir().unwrap();
    let log = log_of(scratch.path(), 3.0);
    let run =
        trundle(&["map", &log, "--odom-topic=/odom", "--out", scratch.path().join("out").to_str().unwrap()]);
    let message = String::from_utf8(run.stderr).unwrap();
    assert_eq!(run.status.code(), Some(2), "{message}");
    assert!(message.contains("--odom-topic is /odom") && message.contains("expected a bag"), "{message}");
}

#[test]
fn images_of_one_timestamp_fail() {
    let scratch = tempfile::tempdir().unwrap();
    let data = scratch.path().join("data");
    let place = data.to_str().unwrap();
    let record = trundle(&["sim", "room", "--quiet", "--duration=1", "--rate=5", "--record", place]);
    assert!(record.status.success());
    for list in ["rgb.txt", "depth.txt"] {
        let text = std::fs::read_to_string(data.join(list)).unwrap();
        let rows = text.lines().filter(|line| !line.starts_with('#')).filter_map(|line| line.split_once(' '));
        let same: Vec<String> = rows.map(|(_, file)| format!("5.0 {file}\n")).collect();
        std::fs::write(data.join(list), same.concat()).unwrap();
    }
    let run = trundle(&["slam", place, "--quiet", "--out", scratch.path().join("out").to_str().unwrap()]);
    let message = String::from_utf8(run.stderr).unwrap();
    assert_eq!(run.status.code(), Some(1), "{message}");
    assert!(message.contains("images only 1 could be used: the others have the same timestamp"), "{message}");
}

#[test]
fn a_map_of_scans_with_one_timestamp_or_of_hardly_any_scan_fails() {
    let scratch = tempfile::tempdir().unwrap();
    let log = log_of_scans(scratch.path(), 4.0, 20);
    let text = std::fs::read_to_string(&log).unwrap();
    let out = scratch.path().join("out");
    let map = |text: &str| {
        std::fs::write(&log, text).unwrap();
        let run = trundle(&["map", &log, "--quiet", "--out", out.to_str().unwrap()]);
        (run.status.code(), String::from_utf8(run.stderr).unwrap())
    };
    let one_time: String = text
        .lines()
        .map(|line| {
            let words: Vec<&str> = line.split(' ').collect();
            let (last, rest) = (words.len() - 3, words.len() - 1);
            format!("{} 0 {} 0\n", words[..last].join(" "), words[rest - 1])
        })
        .collect();
    let (code, message) = map(&one_time);
    assert_eq!(code, Some(1), "{message}");
    assert!(message.contains("all 20 scans have the timestamp 0"), "{message}");
    let broken: String = text
        .lines()
        .enumerate()
        .map(|(i, line)| if i == 0 { format!("{line}\n") } else { "FLASER 181 1 2\n".to_owned() })
        .collect();
    let (code, message) = map(&broken);
    assert_eq!(code, Some(1), "{message}");
    assert!(message.contains("only 1 of 20 scans could be used"), "{message}");
}
