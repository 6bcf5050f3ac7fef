//! The program under test, and its output.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// Runs `trundle` with `args`.
pub fn trundle(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_trundle"))
        .args(args)
        .stdin(Stdio::null())
        .output()
        .expect("the program starts")
}

/// The sentence with which `trundle args` refuses its input: exit code 2, without standard output.
pub fn refusal(args: &[&str]) -> String {
    let output = trundle(args);
    let sentence = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{args:?}: {sentence}");
    assert!(output.stdout.is_empty(), "{args:?}");
    assert!(!sentence.contains("panicked"), "{args:?}: {sentence}");
    sentence
}

/// `summary.json` of a folder.
pub fn summary(folder: &Path) -> serde_json::Value {
    serde_json::from_slice(&std::fs::read(folder.join("summary.json")).unwrap()).unwrap()
}

/// A file or folder of the shared data; prints a note if absent.
pub fn shared(name: &str) -> Option<PathBuf> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data")).join(name);
    if !path.exists() {
        eprintln!("skipped: {} is not here", path.display());
    }
    path.exists().then_some(path)
}

/// A path as an argument.
pub fn text(path: &Path) -> &str {
    path.to_str().expect("scratch paths are UTF-8")
}
