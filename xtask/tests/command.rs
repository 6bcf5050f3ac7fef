//! The program itself, as a shell starts it. A test that starts it also makes the build of the tests leave it in `target/debug`, where `.ci/run`
//! takes it: a build of this package alone would compile its dependencies again, with fewer features.

use std::process::{Command, Output};

fn xtask(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_xtask")).args(args).output().expect("xtask starts")
}

#[test]
fn without_a_command_it_prints_its_commands() {
    let output = xtask(&[]);
    let text = String::from_utf8(output.stderr).expect("its messages are text");
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(["ci", "tidy", "golden", "results"].iter().all(|name| text.contains(name)), "{text}");
}

#[test]
fn an_unknown_command_is_named() {
    let output = xtask(&["tiddy"]);
    let text = String::from_utf8(output.stderr).expect("its messages are text");
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains("tiddy") && text.contains("tidy"), "{text}");
}
