//! The log: silent by default, with the same `log.txt` at every level.

use crate::program::text;
use std::path::Path;
use std::process::{Command, Stdio};

/// Runs the demo for 6 s of simulated time into `out`; returns its standard error.
fn demo(out: &Path, filter: Option<&str>, flags: &[&str]) -> String {
    let mut program = Command::new(env!("CARGO_BIN_EXE_trundle"));
    program.args(["demo", "--direct", "--seed", "2", "--time-limit", "6", "--quiet", "--out", text(out)]);
    program.args(flags).stdin(Stdio::null()).env_remove("TRUNDLE_LOG");
    filter.into_iter().for_each(|filter| _ = program.env("TRUNDLE_LOG", filter));
    String::from_utf8(program.output().expect("the program starts").stderr).unwrap()
}

#[test]
fn state_changes_are_printed_where_they_are_asked_for_and_always_in_log_txt() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = |name| scratch.path().join(name);
    let silent = demo(&folder("silent"), None, &[]);
    assert!(
        silent.starts_with("trundle: Failed") && silent.lines().count() == 1,
        "no log by default: {silent}"
    );
    let by_variable = demo(&folder("variable"), Some("info"), &[]);
    let by_flag = demo(&folder("flag"), None, &["-v"]);

    let log = std::fs::read_to_string(folder("silent").join("log.txt")).unwrap();
    assert!(log.starts_with("info: run in 'demo', seed 2: go to ("), "{log}");
    assert!(
        log.contains(" s: idle -> initializing: a goal is given\n")
            && log.contains("-> driving: a path is found\n"),
        "{log}"
    );
    assert!(log.lines().last().unwrap().starts_with("info: run over after 6."), "{log}");
    for name in ["variable", "flag"] {
        assert_eq!(std::fs::read_to_string(folder(name).join("log.txt")).unwrap(), log, "{name}");
    }
    for line in log.lines() {
        let printed = format!("trundle: {line}\n");
        assert!(by_variable.contains(&printed) && by_flag.contains(&printed), "{line}");
    }
}

#[test]
fn a_filter_that_is_none_is_refused_with_its_text() {
    let scratch = tempfile::tempdir().unwrap();
    let error = demo(&scratch.path().join("out"), Some("trundle_runtime=loud"), &[]);
    assert!(error.contains("TRUNDLE_LOG is 'trundle_runtime=loud'"), "{error}");
    assert!(!scratch.path().join("out").exists());
}
