//! `trundle map` on laser logs, and saved maps.

use crate::program::{refusal, shared, summary, text, trundle};
use std::fs;
use std::path::Path;
use trundle::core::Hypotenuse;

/// The first `scans` scans of a log, in a separate file.
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

/// A short log and the folder of its map.
fn mapped(scratch: &Path) -> Option<(std::path::PathBuf, std::path::PathBuf)> {
    let log = shared("laser/sena.log")?;
    let (short, out) = (scratch.join("short.log"), scratch.join("first"));
    beginning(&log, 40, &short);
    map(&short, &out, "2");
    Some((short, out))
}

#[test]
fn a_saved_map_is_continued_and_used_for_localization() {
    let scratch = tempfile::tempdir().unwrap();
    let Some((log, first)) = mapped(scratch.path()) else { return };
    let (saved, grid) = (first.join("filter.map"), first.join("map.yaml"));
    let before = fs::read(&saved).unwrap();
    let run = |out: &Path, more: &[&str]| {
        let fixed = ["map", text(&log), "--particles=4", "--laser-x=0.78", "--quiet", "--out", text(out)];
        let output = trundle(&[&fixed[..], more].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        fs::read_to_string(out.join("trajectory.txt")).unwrap()
    };
    let pose = |line: &str| -> Vec<f64> { line.split(' ').skip(1).map(|v| v.parse().unwrap()).collect() };
    let original = fs::read_to_string(first.join("trajectory.txt")).unwrap();
    for (name, more) in [
        ("on", vec!["--map", text(&saved)]),
        ("in", vec!["--map", text(&saved), "--localise"]),
        ("grid", vec!["--map", text(&grid), "--localise"]),
    ] {
        let out = scratch.path().join(name);
        let found = run(&out, &more);
        assert!(found.lines().count() > 20, "{name}: {found}");
        // The same log in its own map gives the same poses.
        for line in found.lines() {
            let same = original.lines().find(|o| o.split(' ').next() == line.split(' ').next()).unwrap();
            let (a, b) = (pose(line), pose(same));
            assert!((a[0] - b[0]).hypotenuse(a[1] - b[1]) < 0.15, "{name}: {line} for {same}");
        }
        assert_eq!(out.join("filter.map").exists(), name == "on");
        assert!(fs::read(out.join("overview.png")).unwrap().starts_with(b"\x89PNG"), "{name}");
    }
    assert_eq!(fs::read(&saved).unwrap(), before);
}

#[test]
fn a_damaged_map_is_refused_with_the_reason() {
    let scratch = tempfile::tempdir().unwrap();
    let Some((log, first)) = mapped(scratch.path()) else { return };
    let saved = first.join("filter.map");
    let mut bytes = fs::read(&saved).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 4;
    fs::write(&saved, &bytes).unwrap();
    let sentence = refusal(&["map", text(&log), "--map", text(&saved)]);
    assert!(sentence.contains("filter.map: the map is damaged: its checksum is wrong"), "{sentence}");
    bytes[7] = 77;
    fs::write(&saved, &bytes).unwrap();
    let sentence = refusal(&["map", text(&log), "--map", text(&saved), "--localise"]);
    assert!(sentence.contains("map of version 77, expected"), "{sentence}");
}

#[test]
fn the_old_map_survives_a_death_at_any_moment_of_saving() {
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};
    let scratch = tempfile::tempdir().unwrap();
    let Some((log, first)) = mapped(scratch.path()) else { return };
    // A run killed during the replacement of another leaves that one's map in this folder or in that of the last run.
    let last = first.with_file_name("first.1");
    let staging = || {
        let entries = fs::read_dir(scratch.path()).unwrap().flatten();
        entries
            .filter(|e| e.file_name().to_string_lossy().starts_with(".trundle-"))
            .any(|e| e.path().join("out/filter.map").exists())
    };
    let mut died = 0;
    for k in 0..8_u64 {
        let mut child = Command::new(env!("CARGO_BIN_EXE_trundle"))
            .args(["map", text(&log), "--particles=4", "--laser-x=0.78", "--quiet", "--seed"])
            .args([&(k + 2).to_string(), "--out", text(&first)])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let started = Instant::now();
        while !staging() && child.try_wait().unwrap().is_none() && started.elapsed() < Duration::from_secs(60)
        {
            std::thread::sleep(Duration::from_micros(50));
        }
        std::thread::sleep(Duration::from_micros(150 * k));
        child.kill().unwrap();
        died += usize::from(!child.wait().unwrap().success());
        let mut config = trundle::mapping::ParticleConfig::default();
        config.particles = 4;
        let is_whole = |folder: &Path| {
            fs::read(folder.join("filter.map"))
                .is_ok_and(|bytes| trundle::mapping::ParticleMapper::load(&bytes, config.clone()).is_ok())
        };
        assert!(is_whole(&first) || is_whole(&last), "after {k}");
    }
    assert!(died > 0, "every run had ended before it was killed");
}

#[test]
fn the_old_map_survives_a_disk_that_fills_up() {
    use std::process::Command;
    let scratch = tempfile::tempdir().unwrap();
    let Some((log, first)) = mapped(scratch.path()) else { return };
    let read = |name: &str| fs::read(first.join(name)).unwrap();
    let names = ["filter.map", "map.pgm", "map.yaml", "trajectory.txt", "summary.json"];
    let old = names.map(read);
    // No file may grow beyond so many blocks of 512 bytes: as on a disk with so much room.
    for blocks in [0, 1, 8, 40] {
        let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$@\"");
        let output = Command::new("sh")
            .args(["-c", &script, "sh", env!("CARGO_BIN_EXE_trundle"), "map", text(&log)])
            .args(["--particles=4", "--laser-x=0.78", "--quiet", "--seed=9", "--out", text(&first)])
            .output()
            .unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        let last = first.with_file_name("first.1");
        if output.status.code() == Some(3) {
            assert!(message.contains("cannot write"), "{blocks} blocks: {message}");
            // Files that could not be written are reported, and the last run is preserved.
            fs::remove_dir_all(&first).unwrap();
            fs::rename(&last, &first).unwrap();
        } else {
            assert_eq!(output.status.code(), Some(2), "{blocks} blocks: {message}");
            assert!(message.contains("cannot create") && !last.exists(), "{blocks} blocks: {message}");
        }
        assert_eq!(names.map(read), old, "{blocks} blocks");
        let left: Vec<_> = fs::read_dir(scratch.path()).unwrap().flatten().map(|e| e.file_name()).collect();
        assert!(left.iter().all(|name| !name.to_string_lossy().starts_with('.')), "{left:?}");
    }
}

#[test]
fn options_of_a_laser_are_refused_for_an_rgbd_folder() {
    let scratch = tempfile::tempdir().unwrap();
    fs::write(scratch.path().join("rgb.txt"), "").unwrap();
    for option in ["--laser-x=0.1", "--laser-turn=5", "--upside-down", "--max-range=4"] {
        let sentence = refusal(&["map", text(scratch.path()), option]);
        let name = option.split('=').next().unwrap();
        assert!(sentence.contains(name) && sentence.contains("holds RGB-D images"), "{sentence}");
    }
}

#[test]
fn an_error_of_a_comparison_names_the_file_that_is_wrong() {
    let scratch = tempfile::tempdir().unwrap();
    let write = |name: &str, grey: &str| {
        fs::write(scratch.path().join(format!("{name}.pgm")), format!("P2\n2 2\n255\n{grey}\n")).unwrap();
        let yaml = scratch.path().join(format!("{name}.yaml"));
        let text = format!(
            "image: {name}.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
        );
        fs::write(&yaml, text).unwrap();
        yaml
    };
    let (walls, empty) = (write("walls", "0 254 0 0"), write("empty", "254 254 254 254"));
    let sentence = refusal(&["eval", "map", text(&empty), text(&walls)]);
    assert!(sentence.contains("empty.yaml: the reference map has no obstacle"), "{sentence}");
    let sentence = refusal(&["eval", "map", text(&walls), text(&empty)]);
    assert!(sentence.contains("empty.yaml: the estimate map has no obstacle"), "{sentence}");
    let lines = |name: &str, lines: &str| {
        let path = scratch.path().join(name);
        fs::write(&path, lines).unwrap();
        path
    };
    let route: String = (0..30).map(|k| format!("{k}.0 {k} 0 0\n")).collect();
    let (reference, late) = (lines("ref.txt", &route), lines("late.txt", "900 0 0 0\n901 1 0 0\n"));
    let sentence = refusal(&["eval", "relations", text(&reference), text(&late)]);
    assert!(sentence.contains("late.txt: the estimate has poses for none of the"), "{sentence}");
}
