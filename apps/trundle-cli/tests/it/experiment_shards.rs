//! Experiments in parts, and their merge.

use crate::program::{refusal, text, trundle};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// An experiment of three runs, a few seconds each: docks of a robot with a laser.
const EXPERIMENT: [&str; 5] = ["experiment", "docking-station", "--seeds", "3", "--set=sight=\"laser\""];

/// Runs the experiment with more options into `out`; its standard output.
fn run(options: &[&str], out: &Path) -> String {
    let output = trundle(&[&EXPERIMENT[..], options, &["--out", text(out)]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

fn merge(folders: &[&Path], out: &Path) -> String {
    let folders: Vec<&str> = folders.iter().map(|folder| text(folder)).collect();
    let output = trundle(&[&["experiment", "merge"], &folders[..], &["--out", text(out)]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The files of a folder, without the log and the marker of the run.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let name = |path: &PathBuf| path.file_name().unwrap().to_str().unwrap().to_owned();
    let is_result = |path: &PathBuf| !["log.txt", ".trundle-run"].contains(&name(path).as_str());
    entries.filter(is_result).map(|path| (name(&path), fs::read(&path).unwrap())).collect()
}

/// The table and the verdict, without the line that names the folder.
fn table(stdout: &str) -> String {
    stdout.lines().filter(|line| !line.starts_with("See ")).collect::<Vec<_>>().join("\n")
}

#[test]
fn merged_parts_are_one_run_byte_for_byte_and_a_missing_run_can_be_made_alone() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = |name: &str| scratch.path().join(name);
    let (whole, one, two, merged) = (folder("whole"), folder("one"), folder("two"), folder("merged"));
    let in_one = run(&[], &whole);
    run(&["--shard", "1/2"], &one);
    run(&["--shard", "2/2"], &two);
    assert_eq!(table(&merge(&[&one, &two], &merged)), table(&in_one));
    assert_eq!(files(&merged), files(&whole));

    let missing = refusal(&["experiment", "merge", text(&one), "--out", text(&folder("wrong"))]);
    assert!(missing.contains("1 of 3 runs are missing in the shards: 'seed 2'"), "{missing}");
    assert!(missing.contains("--run 'seed 2' --shard 1/1"), "{missing}");
    let alone = folder("alone");
    run(&["--run", "seed 2", "--shard", "1/1"], &alone);
    assert_eq!(table(&merge(&[&one, &alone], &folder("again"))), table(&in_one));
    assert_eq!(files(&folder("again")), files(&whole));

    // A part whose last line was cut, as by a power failure, lacks its last run.
    let runs = two.join("runs.jsonl");
    let bytes = fs::read(&runs).unwrap();
    fs::write(&runs, &bytes[..bytes.len() - 20]).unwrap();
    let cut = refusal(&["experiment", "merge", text(&one), text(&two), "--out", text(&folder("wrong"))]);
    assert!(cut.contains("'seed 2'"), "{cut}");
}

#[test]
fn folders_that_do_not_belong_together_are_refused() {
    let scratch = tempfile::tempdir().unwrap();
    let part = |name: &str, seeds: &str| {
        let folder = scratch.path().join(name);
        fs::create_dir(&folder).unwrap();
        let manifest = serde_json::json!({
            "arguments": ["faults", "--seeds", seeds], "robot_toml": null, "version": "0.1.0", "shard": "1/2"
        });
        fs::write(folder.join("shard.json"), manifest.to_string()).unwrap();
        fs::write(folder.join("runs.jsonl"), "").unwrap();
        folder
    };
    let merge = |folders: &[&Path]| {
        let folders: Vec<&str> = folders.iter().map(|folder| text(folder)).collect();
        let out = scratch.path().join("out");
        refusal(&[&["experiment", "merge"], &folders[..], &["--out", text(&out)]].concat())
    };
    let (one, two) = (part("one", "1"), part("two", "2"));
    let mixed = merge(&[&one, &two]);
    assert!(
        mixed.contains("two/shard.json: the experiment is 'faults --seeds 2', expected 'faults --seeds 1'"),
        "{mixed}"
    );
    assert!(merge(&[scratch.path()]).contains("expected the folder of `trundle experiment ... --shard K/N`"));
    fs::write(one.join("runs.jsonl"), "{\"run\": 3}\n").unwrap();
    assert!(merge(&[&one]).contains("runs.jsonl, line 1: "));
    fs::write(one.join("shard.json"), "[]").unwrap();
    assert!(merge(&[&one]).contains("shard.json: "));
    let beyond = refusal(&["experiment", "faults", "--shard", "3/2"]);
    assert!(beyond.contains("expected K/N"), "{beyond}");
}
