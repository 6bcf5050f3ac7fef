//! Tests of an output folder: it appears complete, and no file is lost.

use super::*;

fn names(dir: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(dir).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// A run that writes one file.
fn run(target: &Path, name: &str, content: &str) {
    let out = OutputFolder::create(target).unwrap();
    out.write(name, content.as_bytes()).unwrap();
    out.commit().unwrap();
}

#[test]
fn appears_whole_at_commit() {
    let dir = tempfile::tempdir().unwrap();
    let target = dir.path().join("deep/er/run");
    let out = OutputFolder::create(&target).unwrap();
    out.write("a.txt", b"1").unwrap();
    out.write("sub/b.txt", b"2").unwrap();
    assert!(!target.exists());
    assert_eq!(out.commit().unwrap(), target);
    assert_eq!(names(&target), [".trundle-run", "a.txt", "sub"]);
    assert_eq!(fs::read(target.join("sub/b.txt")).unwrap(), b"2");
    assert_eq!(names(target.parent().unwrap()), ["run"]);
}

#[test]
fn leaves_no_trace_without_commit() {
    let dir = tempfile::tempdir().unwrap();
    drop(OutputFolder::create(&dir.path().join("deep/er/run")).unwrap().write("a", b"1"));
    assert_eq!(names(dir.path()), Vec::<String>::new());
    let empty = dir.path().join("empty");
    fs::create_dir(&empty).unwrap();
    let out = OutputFolder::create(&empty).unwrap();
    out.write("a", b"1").unwrap();
    drop(out);
    assert_eq!(names(dir.path()), ["empty"]);
    assert_eq!(names(&empty), Vec::<String>::new());
}

#[test]
fn the_last_run_is_kept_and_no_file_of_it_stays() {
    let dir = tempfile::tempdir().unwrap();
    let target = dir.path().join("run");
    run(&target, "old/map", "1");
    run(&target, "map", "2");
    assert_eq!(names(&target), [".trundle-run", "map"]);
    let last = dir.path().join("run.1");
    assert_eq!(fs::read(last.join("old/map")).unwrap(), b"1");
    run(&target, "plan", "3");
    assert_eq!(names(&last), [".trundle-run", "map"]);
    assert_eq!(names(dir.path()), ["run", "run.1"]);
    drop(OutputFolder::create(&target).unwrap());
    assert_eq!(names(&target), [".trundle-run", "plan"]);
}

#[test]
fn foreign_files_are_never_replaced_nor_removed() {
    let dir = tempfile::tempdir().unwrap();
    let refusal = |target: &Path| OutputFolder::create(target).unwrap_err().to_string();
    fs::write(dir.path().join("mine"), "1").unwrap();
    let sentence = refusal(dir.path());
    assert!(sentence.contains("files that trundle did not write there (mine)"), "{sentence}");
    let target = dir.path().join("run");
    run(&target, "map", "1");
    fs::create_dir(target.join("sub")).unwrap();
    fs::write(target.join("sub/notes"), "mine").unwrap();
    assert!(refusal(&target).contains("sub/notes"));
    fs::remove_file(target.join("sub/notes")).unwrap();
    fs::create_dir(dir.path().join("run.1")).unwrap();
    fs::write(dir.path().join("run.1/thesis"), "mine").unwrap();
    let sentence = refusal(&target);
    assert!(sentence.contains("run.1: here, where the last run is kept,"), "{sentence}");
    assert_eq!(names(dir.path()), ["mine", "run", "run.1"]);
}

#[test]
fn a_folder_that_gets_foreign_files_during_the_run_keeps_them_and_the_results_lie_beside() {
    let dir = tempfile::tempdir().unwrap();
    let target = dir.path().join("run");
    let out = OutputFolder::create(&target).unwrap();
    out.write("map", b"1").unwrap();
    fs::create_dir(&target).unwrap();
    fs::write(target.join("map"), "mine").unwrap();
    let error = out.commit().unwrap_err();
    assert!(error.to_string().ends_with("run.new"), "{error}");
    assert_eq!(fs::read(target.join("map")).unwrap(), b"mine");
    assert_eq!(fs::read(dir.path().join("run.new/map")).unwrap(), b"1");
}

#[test]
fn results_that_cannot_be_moved_get_a_name_that_is_free() {
    let dir = tempfile::tempdir().unwrap();
    let target = dir.path().join("run");
    for (number, name) in ["run.new", "run.new.1", "run.new.2"].into_iter().enumerate() {
        let out = OutputFolder::create(&target).unwrap();
        out.write("map", number.to_string().as_bytes()).unwrap();
        fs::create_dir(&target).unwrap();
        fs::write(target.join("notes"), "mine").unwrap();
        assert!(out.commit().unwrap_err().to_string().ends_with(name));
        assert_eq!(fs::read(dir.path().join(name).join("map")).unwrap(), number.to_string().as_bytes());
        fs::remove_dir_all(&target).unwrap();
    }
}

#[test]
fn an_edited_file_of_a_kept_run_is_not_deleted() {
    let dir = tempfile::tempdir().unwrap();
    let target = dir.path().join("run");
    run(&target, "map", "1");
    fs::write(target.join("map"), "cleaned by hand").unwrap();
    run(&target, "map", "2");
    let sentence = OutputFolder::create(&target).unwrap_err().to_string();
    assert!(
        sentence.contains("run.1: this run would be deleted") && sentence.contains("(map)"),
        "{sentence}"
    );
    assert_eq!(fs::read(dir.path().join("run.1/map")).unwrap(), b"cleaned by hand");
}

#[test]
fn an_input_in_the_folder_of_the_last_run_is_not_lost() {
    let dir = tempfile::tempdir().unwrap();
    let target = dir.path().join("run");
    run(&target, "map", "1");
    run(&target, "map", "2");
    let inputs = InputFiles::new([dir.path().join("run.1/map")]);
    let error = OutputFolder::create_apart_from(&inputs, &target).unwrap_err().to_string();
    assert!(error.contains("run.1") && error.contains("the input"), "{error}");
    assert!(OutputFolder::create_apart_from(&inputs, &dir.path().join("other")).is_ok());
}

#[test]
fn a_file_in_the_way_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("run");
    fs::write(&file, "mine").unwrap();
    let error = OutputFolder::create(&file).unwrap_err().to_string();
    assert_eq!(
        error,
        format!("{}: this is a file, expected a folder to write the results to", file.display())
    );
    let below = file.join("deeper");
    let error = OutputFolder::create(&below).unwrap_err().to_string();
    assert_eq!(error, format!("cannot create {}: a file is in the way", below.display()));
    assert_eq!(fs::read(&file).unwrap(), b"mine");
    assert!(OutputFolder::create(Path::new("")).is_err());
    let out = OutputFolder::create(&dir.path().join("new")).unwrap();
    let error =
        out.write("map.pgm/x", b"1").and_then(|()| out.write("map.pgm", b"2")).unwrap_err().to_string();
    assert!(error.starts_with("cannot write ") && error.ends_with("map.pgm: it is a folder"), "{error}");
}

#[test]
fn files_that_the_disk_refuses_are_named_and_the_rest_is_written() {
    let dir = tempfile::tempdir().unwrap();
    let target = dir.path().join("run");
    let out = OutputFolder::create(&target).unwrap();
    out.write("map", b"1").unwrap();
    for name in ["recording", "report"] {
        let full = std::io::Error::from(ErrorKind::StorageFull);
        out.leave_out(IoError::system(&target.join(name), "write")(full));
    }
    assert!(out.is_incomplete());
    let error = out.commit().unwrap_err();
    let (recording, folder) = (target.join("recording"), target.display());
    let expected = format!(
        "cannot write {}: the disk is full, nor report; the other results are in {folder}",
        recording.display()
    );
    assert_eq!(error.to_string(), expected);
    assert_eq!(names(&target), [".trundle-run", "map"]);
}

#[test]
#[cfg(unix)]
fn results_have_the_usual_permissions_and_links_to_folders_stay() {
    use std::os::unix::fs::PermissionsExt;
    let dir = tempfile::tempdir().unwrap();
    let plain = dir.path().join("plain");
    fs::create_dir(&plain).unwrap();
    let ours = OutputFolder::create(&dir.path().join("ours")).unwrap().commit().unwrap();
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&ours), mode(&plain));
    let link = dir.path().join("link");
    std::os::unix::fs::symlink(&plain, &link).unwrap();
    run(&link, "map", "1");
    run(&link, "map", "2");
    assert!(link.is_symlink());
    assert_eq!(fs::read(plain.join("map")).unwrap(), b"2");
    assert_eq!(fs::read(dir.path().join("plain.1/map")).unwrap(), b"1");
}

#[test]
fn a_removed_hidden_folder_is_not_made_again_by_a_late_writer() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = OutputFolder::create(&scratch.path().join("run")).unwrap();
    folder.write("deep/in/it.txt", b"1").unwrap();
    assert_eq!(std::fs::read(folder.staged("deep/in/it.txt")).unwrap(), b"1");
    let hidden = folder.staged("").parent().unwrap().to_owned();
    std::fs::remove_dir_all(&hidden).unwrap();
    for name in ["late.txt", "deep/in/late.txt"] {
        assert!(folder.write(name, b"2").is_err());
        assert!(!hidden.exists(), "{name}");
    }
}

/// The folders `run` and `run.1`, whose runs hold 3 files each, and a run into `run` that waits for its commit.
fn three_runs(target: &Path) -> OutputFolder {
    let write = |content: &str| {
        let out = OutputFolder::create(target).unwrap();
        ["a", "b", "sub/c"].iter().for_each(|name| out.write(name, content.as_bytes()).unwrap());
        out
    };
    write("first").commit().unwrap();
    write("second").commit().unwrap();
    let third = write("third");
    third.write("new", b"third").unwrap();
    third.write_marker();
    third
}

/// Whether `folder` contains the complete run of that content.
fn holds(folder: &Path, content: &str) -> bool {
    ["a", "b", "sub/c"].iter().all(|name| fs::read(folder.join(name)).is_ok_and(|b| b == content.as_bytes()))
}

#[test]
fn a_commit_that_ends_early_leaves_the_last_run_whole_and_the_next_run_keeps_it() {
    let dir = tempfile::tempdir().unwrap();
    let target = dir.path().join("run");
    let last = dir.path().join("run.1");
    let out = three_runs(&target);
    out.place.keep_last_run(&out.scratch).unwrap();
    assert!(holds(&target, "second") && holds(&last, "second"), "both, until the results are moved");
    out.place.replace_content(&out.scratch).unwrap();
    assert!(holds(&target, "third") && holds(&last, "second"));
    // The marker and the files of a process that was killed between two files.
    let marker = RunMarker::read(&target).unwrap();
    marker.clone().giving_place_to(marker).write(&target).unwrap();
    fs::remove_file(target.join("b")).unwrap();
    drop(out);
    run(&target, "map", "4");
    assert_eq!(names(&target), [".trundle-run", "map"]);
    assert!(holds(&last, "second"), "the last run that is whole");
    assert_eq!(names(dir.path()), ["run", "run.1"]);
    run(&target, "map", "5");
    assert_eq!(fs::read(last.join("map")).unwrap(), b"4");
}

#[test]
fn folders_of_the_user_without_files_stay() {
    let dir = tempfile::tempdir().unwrap();
    fs::create_dir_all(dir.path().join("run/mine/deeper")).unwrap();
    run(&dir.path().join("run"), "map", "1");
    assert!(dir.path().join("run/mine/deeper").exists());
}

#[test]
fn space_for_the_marker_is_kept_on_the_disk_until_the_commit() {
    let dir = tempfile::tempdir().unwrap();
    let target = dir.path().join("run");
    let out = OutputFolder::create(&target).unwrap();
    let hidden = dir.path().join(&names(dir.path())[0]);
    let kept = fs::metadata(hidden.join("reserve")).unwrap();
    assert_eq!(kept.len(), 1 << 16);
    #[cfg(unix)]
    assert!(std::os::unix::fs::MetadataExt::blocks(&kept) * 512 >= 1 << 16, "no hole");
    out.write("a", b"1").unwrap();
    out.commit().unwrap();
    assert_eq!(names(&target), [".trundle-run", "a"]);
    assert_eq!(names(dir.path()), ["run"]);
}
