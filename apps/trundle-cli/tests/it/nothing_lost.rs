//! No result replaces an input, or a file that trundle did not write.

use crate::program::{refusal, summary, text, trundle};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The files of a folder, with their bytes.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries
        .flat_map(|path| {
            if path.is_dir() {
                contents(&path)
            } else {
                BTreeMap::from([(path.clone(), fs::read(&path).unwrap())])
            }
        })
        .collect()
}

/// Runs a command that must end well.
fn ran(args: &[&str]) {
    let output = trundle(args);
    assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
}

/// A recorded drive of a second.
fn recorded(folder: &Path) -> PathBuf {
    let place = folder.join("recorded");
    ran(&["sim", "demo", "--quiet", "--duration", "1", "--rate", "4", "--record", text(&place)]);
    place
}

#[test]
fn a_recording_is_not_overwritten_by_its_own_results() {
    let scratch = tempfile::tempdir().unwrap();
    let data = recorded(scratch.path());
    let before = contents(&data);
    let (dotted, list) = (data.join("../recorded/."), data.join("map.yaml"));
    for out in [data.as_path(), &dotted, scratch.path()] {
        let sentence = refusal(&["slam", text(&data), "--out", text(out)]);
        assert!(sentence.contains("the input") && sentence.contains("name another folder"), "{sentence}");
        let plan = ["plan", text(&list), "--from=1.2,1.1,20", "--to=1.5,1.2,0", "--out", text(out)];
        assert!(refusal(&plan).contains("the input"));
        assert!(refusal(&["dock", text(&list), "--from=1,1,0", "--out", text(out)]).contains("the input"));
        assert!(
            refusal(&["eval", "map", text(&list), text(&list), "--out", text(out)]).contains("the input")
        );
    }
    let images = data.join("rgb");
    assert!(refusal(&["slam", text(&data), "--out", text(&images)]).contains("the input"));
    assert_eq!(contents(&data), before);
    let entries = fs::read_dir(scratch.path()).unwrap().count();
    assert_eq!(entries, 1, "nothing else was written");
}

#[test]
#[cfg(unix)]
fn links_do_not_hide_an_input() {
    let scratch = tempfile::tempdir().unwrap();
    let data = recorded(scratch.path());
    let [alias, hard] = ["alias", "hard"].map(|name| scratch.path().join(name));
    std::os::unix::fs::symlink(&data, &alias).unwrap();
    fs::create_dir(&hard).unwrap();
    fs::hard_link(data.join("map.pgm"), hard.join("map.pgm")).unwrap();
    assert!(refusal(&["slam", text(&data), "--out", text(&alias)]).contains("the input"));
    assert!(refusal(&["slam", text(&alias), "--out", text(&data)]).contains("the input"));
    let map = data.join("map.yaml");
    let plan = ["plan", text(&map), "--from=1.2,1.1,20", "--to=1.5,1.2,0", "--out", text(&hard)];
    assert!(refusal(&plan).contains("the input"), "the picture of the map is an input");
}

#[test]
fn the_last_run_is_kept_and_foreign_files_stay() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    let dock = |method: &str| ran(&["dock", "hong24-b", "--quiet", "--method", method, "--out", text(&out)]);
    let motions = |folder: &Path| summary(folder)["motions"].to_string();
    dock("paper");
    let paper = motions(&out);
    dock("optimal");
    let last = scratch.path().join("out.1");
    assert_eq!(motions(&last), paper);
    fs::write(out.join("notes.txt"), "mine").unwrap();
    let sentence = refusal(&["dock", "hong24-b", "--out", text(&out)]);
    assert!(sentence.contains("notes.txt"), "{sentence}");
    fs::rename(out.join("notes.txt"), scratch.path().join("notes.txt")).unwrap();
    dock("optimal");
    assert_eq!(fs::read_dir(scratch.path()).unwrap().count(), 3);
}

#[test]
fn a_single_file_is_kept_and_no_input_is_replaced() {
    let scratch = tempfile::tempdir().unwrap();
    let [problem, map] = ["corridor.txt", "room.yaml"].map(|name| scratch.path().join(name));
    fs::write(&problem, "mine").unwrap();
    ran(&["dock", "hong24-a", "--quiet", "--write-problem", text(&problem)]);
    let kept = scratch.path().join("corridor.txt.1");
    assert_eq!(fs::read_to_string(&kept).unwrap(), "mine");
    let sentence = refusal(&["dock", text(&problem), "--write-problem", text(&problem)]);
    assert!(sentence.contains("it is the input"), "{sentence}");
    for resolution in ["0.1", "0.1", "0.2"] {
        ran(&["sim", "demo", "--quiet", "--resolution", resolution, "--map", text(&map)]);
    }
    let names = ["room.yaml", "room.yaml.1", "room.pgm", "room.pgm.1"];
    assert!(names.iter().all(|name| scratch.path().join(name).exists()));
    assert_eq!(fs::read_dir(scratch.path()).unwrap().count(), 6);
}
