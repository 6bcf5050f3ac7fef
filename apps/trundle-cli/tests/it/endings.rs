//! Every end preserves existing results: Ctrl-C, SIGTERM, kill -9, a full disk.
#![cfg(unix)]

use crate::program::{summary, text, trundle};
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// Time limit of a program \[s\].
const PATIENCE_S: u64 = 120;

fn start(args: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_trundle"))
        .args(args)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Whether a hidden folder of results is in `folder`.
fn writes_in(folder: &Path) -> bool {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries.map(|entry| entry.file_name()).any(|name| name.to_string_lossy().starts_with(".trundle-"))
}

fn wait_until(what: &str, is_so: impl Fn() -> bool) {
    let started = Instant::now();
    while !is_so() {
        assert!(started.elapsed() < Duration::from_secs(PATIENCE_S), "{what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Runs `trundle args --out OUT`, with OUT in `folder`, and sends `signal` once it writes.
fn signalled(args: &[&str], out: &Path, signal: &str) -> Output {
    let child = start(args);
    wait_until("the program writes nothing", || writes_in(out.parent().unwrap()));
    let kill = Command::new("kill").args([signal, &child.id().to_string()]).status();
    assert!(kill.unwrap().success());
    child.wait_with_output().unwrap()
}

/// Asserts that the program was stopped by Ctrl-C or SIGTERM, reported it, and wrote its results.
fn assert_stopped(output: &Output, out: &Path, (code, signal): (i32, &str)) {
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{message}");
    let place = format!("; the results so far are in {}", out.display());
    assert!(
        message.contains(&format!("stopped by {signal} after ")) && message.contains(&place),
        "{message}"
    );
    assert_eq!(summary(out)["interrupted"], true);
    assert!(!writes_in(out.parent().unwrap()));
}

const CTRL_C: (i32, &str) = (130, "Ctrl-C");
const TERMINATED: (i32, &str) = (143, "SIGTERM");

#[test]
fn an_operated_run_that_is_stopped_with_open_tasks_is_no_success() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    let output = signalled(&["demo", "--live", "127.0.0.1:0", "--out", text(&out)], &out, "-TERM");
    assert_stopped(&output, &out, TERMINATED);
    assert_eq!(summary(&out)["success"], false);
    let message = String::from_utf8_lossy(&output.stdout);
    assert!(
        message.contains("tasks were open at the end, 0 done") && !message.contains("Mission done"),
        "{message}"
    );
}

#[test]
fn a_stopped_drive_is_a_recording_and_stopped_slam_and_map_write_what_they_know() {
    let scratch = tempfile::tempdir().unwrap();
    let [data, slam, map] = ["data", "slam", "map"].map(|name| scratch.path().join(name));
    let sim = [
        "sim",
        "office",
        "--laser",
        "urg-04lx",
        "--duration",
        "100000",
        "--rate",
        "10",
        "--quiet",
        "--record",
    ];
    let child = start(&[&sim[..], &[text(&data)]].concat());
    wait_until("nothing is recorded", || {
        let hidden =
            fs::read_dir(scratch.path()).unwrap().flatten().map(|entry| entry.path().join("out/rgb"));
        hidden.into_iter().any(|images| fs::read_dir(images).is_ok_and(|images| images.count() >= 16))
    });
    assert!(Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap().success());
    assert_stopped(&child.wait_with_output().unwrap(), &data, TERMINATED);
    assert!(summary(&data)["images"].as_u64().unwrap() >= 16);

    let args = ["slam", text(&data), "--height=0.45", "--tilt=8", "--out", text(&slam)];
    let output = signalled(&args, &slam, "-INT");
    assert_stopped(&output, &slam, CTRL_C);
    assert!(String::from_utf8_lossy(&output.stderr).contains(" frames;"), "N of M frames");

    let log = data.join("laser.log");
    let output = signalled(&["map", text(&log), "--particles=900", "--out", text(&map)], &map, "-INT");
    assert_stopped(&output, &map, CTRL_C);
    assert!(map.join("map.yaml").exists() && map.join("trajectory.txt").exists());
    let numbers = summary(&map);
    let [read, scans] = ["scans_read", "scans"].map(|name| numbers[name].as_u64().unwrap());
    assert!(read < scans && read >= numbers["processed"].as_u64().unwrap(), "{numbers}");
}

/// Whether the tracking of `trundle slam`, whose results come into `folder`, is over: its recording has its end.
fn is_tracked(folder: &Path) -> bool {
    const END: &[u8] = b"\x89MCAP0\r\n";
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let recordings =
        entries.map(|entry| fs::read(entry.path().join("out/recording.mcap")).unwrap_or_default());
    recordings.into_iter().any(|bytes| bytes.len() > END.len() && bytes.ends_with(END))
}

#[test]
fn a_surface_that_is_stopped_is_an_interrupted_result_with_the_tracking() {
    let scratch = tempfile::tempdir().unwrap();
    let [data, out, mesh] = ["data", "out", "x.glb"].map(|name| scratch.path().join(name));
    let sim = ["sim", "room", "--quiet", "--duration", "40", "--rate", "3", "--record", text(&data)];
    assert!(trundle(&sim).status.success());
    let args = ["--record", "events", "--voxel", "0.005", "--mesh", text(&mesh), "--out", text(&out)];
    let child = start(&[&["slam", text(&data), "--quiet"], &args[..]].concat());
    wait_until("the tracking has no end", || is_tracked(scratch.path()));
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_stopped(&output, &out, CTRL_C);
    assert!(String::from_utf8_lossy(&output.stderr).contains("after surface of "), "the surface was stopped");
    assert_eq!(summary(&out)["success"], false);
    assert!(summary(&out)["frames"].as_u64().unwrap() >= 100);
    assert!(out.join("map.yaml").exists() && out.join("trajectory.txt").exists());
}

#[test]
fn a_stopped_run_and_its_stopped_replay_have_their_results() {
    let scratch = tempfile::tempdir().unwrap();
    let [live, again, trials] = ["live", "again", "trials"].map(|name| scratch.path().join(name));
    let demo = ["demo", "--direct", "--seed", "2", "--record", "all", "--out", text(&live)];
    let child = start(&demo);
    std::thread::sleep(Duration::from_secs(4));
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    assert_stopped(&child.wait_with_output().unwrap(), &live, CTRL_C);
    let recording = live.join("recording.mcap");
    let output = trundle(&["replay", text(&recording), "--quiet", "--out", text(&again)]);
    assert_eq!(output.status.code(), Some(1), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(fs::read(live.join("map.pgm")).unwrap(), fs::read(again.join("map.pgm")).unwrap());
    assert_eq!(summary(&again)["interrupted"], true);

    let output = signalled(&["replay", text(&recording), "--out", text(&trials)], &trials, "-TERM");
    assert_stopped(&output, &trials, TERMINATED);
}

/// The images that a stopped calibration has not read are no fault of the recording.
#[test]
fn a_stopped_calibration_names_no_fault_of_its_recording() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("run");
    trundle(&["demo", "--direct", "--time-limit", "6", "--record", "all", "--quiet", "--out", text(&out)]);
    let recording = out.join("recording.mcap");
    let child = start(&["calibrate", "mount", text(&recording)]);
    std::thread::sleep(Duration::from_secs(1));
    assert!(Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(143), "{message}");
    assert!(message.contains("stopped by SIGTERM") && !message.contains("floor in"), "{message}");
}

#[test]
fn a_command_that_has_nothing_yet_ends_at_once() {
    let scratch = tempfile::tempdir().unwrap();
    let voc = scratch.path().join("own.voc");
    let child = start(&[
        "vocabulary",
        "train",
        "--scene",
        "house",
        "--views",
        "5000",
        "--quiet",
        "--out",
        text(&voc),
    ]);
    std::thread::sleep(Duration::from_secs(2));
    let asked = Instant::now();
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    assert!(asked.elapsed() < Duration::from_secs(5));
    assert!(String::from_utf8_lossy(&output.stderr).contains("stopped by Ctrl-C; nothing was written"));
    assert_eq!(fs::read_dir(scratch.path()).unwrap().count(), 0);
}

/// The map of `sim --map` exists before the drive, so a stopped drive names it.
#[test]
fn a_stopped_drive_names_the_map_that_it_has_written() {
    let scratch = tempfile::tempdir().unwrap();
    let map = scratch.path().join("map.yaml");
    let child = start(&["sim", "room", "--duration", "600", "--quiet", "--map", text(&map)]);
    wait_until("the program writes no map", || map.exists());
    assert!(Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(143), "{message}");
    assert!(!message.contains("nothing was written") && message.contains("map.yaml"), "{message}");
}

/// The drawing of a map has no loop that reads the signal. Its result is complete, and a script that calls the program ends.
#[test]
fn a_signal_after_the_last_loop_is_the_exit_code_too() {
    let scratch = tempfile::tempdir().unwrap();
    let map = scratch.path().join("map.yaml");
    let child = start(&["sim", "warehouse", "--resolution=0.005", "--map", text(&map)]);
    std::thread::sleep(Duration::from_millis(500));
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{message}");
    assert!(message.contains("stopped by Ctrl-C") && message.contains("map.yaml"), "{message}");
    assert!(map.exists() && map.with_extension("pgm").exists());
}

/// A closed terminal, or a pipe without a reader, receives no message of a program ended by a signal.
#[test]
fn a_signal_ends_a_command_whose_standard_error_has_no_reader() {
    let scratch = tempfile::tempdir().unwrap();
    let voc = scratch.path().join("own.voc");
    let (reader, writer) = std::io::pipe().unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_trundle"))
        .args(["vocabulary", "train", "--scene", "house", "--views", "5000", "--out", text(&voc)])
        .stdin(Stdio::null())
        .stdout(writer.try_clone().unwrap())
        .stderr(writer)
        .spawn()
        .unwrap();
    drop(reader);
    std::thread::sleep(Duration::from_secs(2));
    assert!(Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap().success());
    let asked = Instant::now();
    let status = loop {
        match child.try_wait().unwrap() {
            Some(status) => break Some(status),
            None if asked.elapsed() > Duration::from_secs(5) => break None,
            None => std::thread::sleep(Duration::from_millis(10)),
        }
    };
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(status.and_then(|status| status.code()), Some(143));
    assert_eq!(fs::read_dir(scratch.path()).unwrap().count(), 0);
}

#[test]
fn files_of_a_killed_run_are_named_and_removed() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    let output = signalled(&["demo", "--direct", "--out", text(&out)], &out, "-KILL");
    assert_eq!(output.status.code(), None);
    assert!(writes_in(scratch.path()) && !out.exists());
    let output = trundle(&["dock", "hong24-b", "--out", text(&out)]);
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && message.contains("left by a run that was killed"), "{message}");
    assert!(!writes_in(scratch.path()) && out.exists());
}

/// The place of a hidden folder stands in its file `owner`, which no process holds after a kill.
#[test]
fn the_hidden_folder_of_a_killed_run_into_a_single_file_is_named_and_removed() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().canonicalize().unwrap();
    let [map, left] = ["map.yaml", ".trundle-killed"].map(|name| folder.join(name));
    fs::create_dir(&left).unwrap();
    fs::write(left.join("owner"), text(&map)).unwrap();
    let output = trundle(&["sim", "room", "--quiet", "--map", text(&map)]);
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(message.contains(".trundle-killed was left by a run that was killed"), "{message}");
    assert!(output.status.success() && map.exists() && !writes_in(&folder));
}

/// Runs `trundle args` on a disk that takes no file of more than `kilobytes`.
fn on_full_disk(kilobytes: usize, args: &[&str]) -> Output {
    let script = format!("ulimit -f {}; exec \"$0\" \"$@\"", 2 * kilobytes); // in blocks of 512 bytes
    Command::new("sh")
        .args(["-c", &script, env!("CARGO_BIN_EXE_trundle")])
        .args(args)
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

#[test]
fn every_file_that_a_full_disk_refuses_is_named_and_no_missing_one_is_shown() {
    let scratch = tempfile::tempdir().unwrap();
    let [data, slam, bag, tum, map] =
        ["data", "slam", "bag", "tum", "map.yaml"].map(|name| scratch.path().join(name));
    let sim = ["sim", "room", "--quiet", "--duration", "2", "--rate", "4", "--record", text(&data)];
    assert!(trundle(&sim).status.success());
    let run = |args: &[&str]| {
        let output = on_full_disk(30, args);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(3), "{args:?}: {message}");
        assert!(message.contains("trundle: cannot write "), "{message}");
        (message, String::from_utf8_lossy(&output.stdout).into_owned())
    };
    let (message, shown) = run(&["slam", text(&data), "--height=0.45", "--tilt=8", "--out", text(&slam)]);
    assert!(message.contains("recording.mcap") && message.contains("visual.map, report.html"), "{message}");
    assert!(!slam.join("report.html").exists() && !shown.contains("See "), "{shown}");
    assert!(fs::read_to_string(slam.join("log.txt")).unwrap().contains("report.html"));

    let (message, _) = run(&["convert", text(&data), text(&bag), "--to", "bag"]);
    assert!(message.contains("bag.mcap") && !bag.exists(), "{message}");
    run(&["convert", text(&data), text(&tum), "--to", "tum"]);
    let images = |list: &str| fs::read_to_string(tum.join(list)).unwrap_or_default();
    let listed = ["rgb.txt", "depth.txt"].map(|list| images(list).lines().skip(1).count());
    assert!(listed[0] == listed[1] && listed[0] < 8, "{listed:?}");

    let (message, _) = run(&["sim", "room", "--quiet", "--resolution=0.02", "--map", text(&map)]);
    assert!(message.contains("map.pgm") && map.exists(), "{message}");
    assert!(!writes_in(scratch.path()));
}

/// A limited file size simulates a full disk.
#[test]
fn results_that_a_full_disk_refuses_are_named_and_the_rest_is_there() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    let program = env!("CARGO_BIN_EXE_trundle");
    let script = format!("ulimit -f 8; exec {program} dock hong24-b --out {}", text(&out));
    let output = Command::new("sh").args(["-c", &script]).stdin(Stdio::null()).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{message}");
    assert!(message.contains("the other results are in"), "{message}");
    assert_eq!(summary(&out)["command"], "dock");
    assert!(!out.join("dock.png").exists());
    let output = trundle(&["dock", "hong24-a", "--write-problem", "/dev/full"]);
    assert_eq!(output.status.code(), Some(3), "{}", String::from_utf8_lossy(&output.stderr));
}

/// A short command stopped at any moment leaves all its results or none.
#[test]
fn a_stopped_short_command_leaves_all_or_nothing() {
    let scratch = tempfile::tempdir().unwrap();
    for delay_ms in (0..120).step_by(8) {
        let out = scratch.path().join(format!("out{delay_ms}"));
        let child = start(&["dock", "hong24-d", "--out", text(&out)]);
        std::thread::sleep(Duration::from_millis(delay_ms));
        let _ = Command::new("kill").args(["-TERM", &child.id().to_string()]).stderr(Stdio::null()).status();
        let output = child.wait_with_output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(!writes_in(scratch.path()), "{delay_ms} ms: a hidden folder is left: {message}");
        match output.status.code() {
            Some(0) => assert!(out.join("summary.json").exists(), "{delay_ms} ms"),
            Some(143) => {
                assert!(!out.exists() && message.contains("nothing was written"), "{delay_ms} ms: {message}")
            }
            other => assert!(other.is_none(), "{delay_ms} ms: {other:?} {message}"), // before it listens
        }
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_standard_output_that_is_full_is_an_incomplete_result() {
    let full = || fs::File::options().write(true).open("/dev/full").unwrap();
    for args in [
        &["config"][..],
        &["completions", "bash"],
        &["data", "fetch-list"],
        &["sim", "--list"],
        &["--help"],
        &["--version"],
    ] {
        let program = || Command::new(env!("CARGO_BIN_EXE_trundle"));
        let output = program().args(args).stdin(Stdio::null()).stdout(full()).output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(3), "{args:?}: {message}");
        assert!(message.contains("cannot write to standard output: the disk is full"), "{args:?}: {message}");
    }
}

#[test]
fn man_pages_take_the_place_of_no_other_file() {
    let scratch = tempfile::tempdir().unwrap();
    let (pages, important) = (scratch.path().join("man1"), scratch.path().join("important"));
    fs::create_dir(&pages).unwrap();
    fs::write(&important, "IMPORTANT").unwrap();
    std::os::unix::fs::symlink(&important, pages.join("trundle.1")).unwrap();
    fs::write(pages.join("trundle-map.1"), "MINE").unwrap();
    assert!(trundle(&["man", text(&pages)]).status.success());
    assert_eq!(fs::read_to_string(&important).unwrap(), "IMPORTANT");
    assert_eq!(fs::read_to_string(pages.join("trundle-map.1.1")).unwrap(), "MINE");
    assert!(fs::read_to_string(pages.join("trundle-map.1")).unwrap().contains("trundle"));
    let count = || fs::read_dir(&pages).unwrap().count();
    let before = count();
    assert!(trundle(&["man", text(&pages)]).status.success());
    assert_eq!(count(), before, "the same pages again are not new files");
}

#[test]
fn a_disk_that_takes_no_image_is_named() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    let program = env!("CARGO_BIN_EXE_trundle");
    let script = format!(
        "trap '' XFSZ; ulimit -f 8; exec {program} sim office --duration 0.3 --record {}",
        text(&out)
    );
    let output = Command::new("sh").args(["-c", &script]).stdin(Stdio::null()).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{message}");
    assert!(message.contains("cannot write") && !message.contains("no image to write"), "{message}");
}

/// Ends a drive recorded into `out` `delay_ms` after the start of its commit, seen from outside, by a second signal or by `kill -9`.
/// Returns the exit code.
fn end_in_commit(out: &Path, signal: &str, delay_ms: u64) -> Option<i32> {
    let child =
        start(&["sim", "room", "--duration", "1000", "--rate", "5", "--quiet", "--record", text(out)]);
    let beside = out.parent().unwrap();
    wait_until("nothing is recorded", || writes_in(beside));
    std::thread::sleep(Duration::from_millis(200));
    for (signal, delay_ms) in [("-INT", delay_ms), (signal, 0)] {
        let _ = Command::new("kill").args([signal, &child.id().to_string()]).stderr(Stdio::null()).status();
        std::thread::sleep(Duration::from_millis(delay_ms));
    }
    child.wait_with_output().unwrap().status.code()
}

/// All files below `folder`, with their content.
fn content(folder: &Path) -> std::collections::BTreeMap<std::path::PathBuf, Vec<u8>> {
    let (mut files, mut open) = (std::collections::BTreeMap::new(), vec![folder.to_owned()]);
    while let Some(dir) = open.pop() {
        for path in fs::read_dir(dir).into_iter().flatten().flatten().map(|entry| entry.path()) {
            if path.is_dir() {
                open.push(path);
            } else {
                files.insert(path.strip_prefix(folder).unwrap().to_owned(), fs::read(&path).unwrap());
            }
        }
    }
    files
}

/// After a second signal or `kill -9` at any moment, the previous run is complete in one folder.
#[test]
fn a_run_that_is_ended_twice_leaves_the_run_before_whole() {
    let scratch = tempfile::tempdir().unwrap();
    let [out, last] = ["out", "out.1"].map(|name| scratch.path().join(name));
    assert!(trundle(&["sim", "room", "--duration", "2", "--quiet", "--record", text(&out)]).status.success());
    for delay_ms in (0..60).step_by(4) {
        let before = content(&out);
        let signal = if delay_ms % 8 == 0 { "-TERM" } else { "-KILL" };
        let code = end_in_commit(&out, signal, delay_ms);
        let is_kept = [&out, &last].iter().any(|folder| content(folder) == before);
        assert!(is_kept, "{delay_ms} ms {signal}: {code:?}");
        assert!(matches!((signal, code), (_, Some(130 | 143)) | ("-KILL", None)), "{delay_ms} ms: {code:?}");
        assert!(signal == "-KILL" || !writes_in(scratch.path()), "{delay_ms} ms: a hidden folder is left");
        // The next run, which the test of the next moment begins with.
        let next = trundle(&["sim", "room", "--duration", "1", "--quiet", "--record", text(&out)]);
        assert!(next.status.success(), "{delay_ms} ms: {}", String::from_utf8_lossy(&next.stderr));
    }
}
