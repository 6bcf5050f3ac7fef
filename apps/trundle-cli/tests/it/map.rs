use crate::program::{refusal, shared, summary, text, trundle};
use std::fs;
use std::path::Path;

/// The first `scans` scans of a log, as a file of its own.
fn beginning(log: &Path, scans: usize, to: &Path) {
    let all = fs::read_to_string(log).unwrap();
    let lines: Vec<&str> = all.lines().filter(|line| line.starts_with("FLASER")).take(scans).collect();
    fs::write(to, lines.join("\n")).unwrap();
}

fn map(log: &Path, out: &Path, threads: &str) {
    let output = trundle(&[
        "map",
        text(log),
        "--particles=4",
        "--laser-x=0.78",
        "--quiet",
        "--threads",
        threads,
        "--out",
        text(out),
    ]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn a_log_becomes_a_map_and_the_same_on_any_number_of_threads() {
    let Some(log) = shared("laser/sena.log") else { return };
    let scratch = tempfile::tempdir().unwrap();
    let short = scratch.path().join("short.log");
    beginning(&log, 40, &short);
    let (one, two) = (scratch.path().join("one"), scratch.path().join("two"));
    map(&short, &one, "1");
    map(&short, &two, "2");
    for name in ["trajectory.txt", "map.pgm", "map.yaml"] {
        assert_eq!(fs::read(one.join(name)).unwrap(), fs::read(two.join(name)).unwrap(), "{name}");
    }
    let trajectory = fs::read_to_string(one.join("trajectory.txt")).unwrap();
    assert_eq!(trajectory.lines().count(), 40);
    assert!(trajectory.starts_with("1137834225.713386"), "{trajectory}");
    assert!(trajectory.lines().all(|line| line.split(' ').count() == 4));
    assert!(trundle::io::read_map(&one.join("map.yaml")).is_ok());
    assert!(summary(&one)["memory_mb"].as_f64().unwrap() > 0.1);
}

#[test]
fn a_log_without_scans_is_refused_by_name() {
    let scratch = tempfile::tempdir().unwrap();
    let log = scratch.path().join("empty.log");
    fs::write(&log, "ODOM 1 2\n").unwrap();
    let sentence = refusal(&["map", text(&log), "--out", text(&scratch.path().join("out"))]);
    assert!(sentence.contains("empty.log, line 1: the line ends before its theta"), "{sentence}");
    assert!(!scratch.path().join("out").exists());
    fs::write(&log, "FLASER 1 2 0 0 0 0 0 0 1 h 1\n").unwrap();
    let sentence = refusal(&["map", text(&log), "--resolution=-1"]);
    assert!(sentence.contains("resolution is -1"), "{sentence}");
}
