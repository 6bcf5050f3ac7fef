//! Help, version and usage errors of every command.

use crate::program::{refusal, trundle};

/// Every command and subcommand.
const COMMANDS: [&[&str]; 26] = [
    &[],
    &["demo"],
    &["replay"],
    &["slam"],
    &["map"],
    &["eval"],
    &["eval", "relations"],
    &["eval", "map"],
    &["plan"],
    &["sim"],
    &["dock"],
    &["experiment"],
    &["experiment", "poses"],
    &["experiment", "obstacles"],
    &["experiment", "house"],
    &["experiment", "faults"],
    &["experiment", "people"],
    &["experiment", "barn"],
    &["experiment", "mrpb"],
    &["experiment", "real-time"],
    &["experiment", "corridor"],
    &["vocabulary"],
    &["vocabulary", "train"],
    &["vocabulary", "export"],
    &["vocabulary", "recall"],
    &["config"],
];

fn help(command: &[&str]) -> String {
    let output = trundle(&[command, &["--help"]].concat());
    assert_eq!(output.status.code(), Some(0), "{command:?}");
    assert!(output.stderr.is_empty(), "{command:?}");
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn every_command_has_help_with_its_usage() {
    for command in COMMANDS {
        let text = help(command);
        let usage = format!("Usage: trundle {}", command.join(" "));
        assert!(text.contains(usage.trim()), "{command:?}: {text}");
    }
}

#[test]
fn the_help_of_trundle_lists_every_command() {
    let text = help(&[]);
    for command in COMMANDS.iter().filter(|command| command.len() == 1) {
        assert!(text.contains(&format!("\n  {}", command[0])), "{command:?}: {text}");
    }
}

#[test]
fn commands_that_write_a_folder_say_where() {
    for command in [&["demo"][..], &["slam"], &["map"], &["plan"], &["dock"], &["experiment", "poses"]] {
        let text = help(command);
        assert!(text.contains("--out <DIR>") && text.contains("[default: out/"), "{command:?}: {text}");
    }
}

#[test]
fn commands_that_have_a_robot_take_its_file_and_single_keys() {
    for command in [&["demo"][..], &["plan"], &["dock"], &["experiment", "faults"], &["experiment", "barn"]] {
        let text = help(command);
        assert!(text.contains("--config <FILE>") && text.contains("--set <KEY=VALUE>"), "{command:?}");
    }
}

#[test]
fn the_version_is_the_packages() {
    let output = trundle(&["--version"]);
    assert_eq!(output.status.code(), Some(0));
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(text.trim(), format!("trundle {}", env!("CARGO_PKG_VERSION")));
}

#[test]
fn an_unknown_command_or_option_is_a_usage_error() {
    assert!(refusal(&["dance"]).contains("unrecognized subcommand 'dance'"));
    assert!(refusal(&["demo", "--sed", "3"]).contains("--sed"));
    assert!(refusal(&["plan"]).contains("<MAP>"), "a missing argument is named");
    assert!(refusal(&["plan", "map.yaml", "--from=0,0,0"]).contains("--goal"));
}

#[test]
fn values_outside_their_range_are_named_with_their_option() {
    for (args, option) in [
        (&["demo", "--seed", "-1"][..], "--seed"),
        (&["demo", "--time-limit", "0"], "--time-limit"),
        (&["demo", "--threads", "0"], "--threads"),
        (&["demo", "--goal", "1,2"], "--goal"),
        (&["map", "log", "--particles", "0"], "--particles"),
        (&["slam", "dir", "--frames", "0"], "--frames"),
        (&["sim", "room", "--resolution", "0"], "--resolution"),
        (&["sim", "room", "--rate", "-3"], "--rate"),
        (&["sim", "room", "--camera", "sonar"], "--camera"),
        (&["dock", "x", "--scan", "0"], "--scan"),
        (&["vocabulary", "train", "--seeds", "3-1", "--out", "x"], "--seeds"),
        (&["experiment", "poses", "--seeds", "0"], "--seeds"),
    ] {
        let sentence = refusal(args);
        assert!(sentence.contains(option), "{args:?}: {sentence}");
    }
}

#[test]
fn options_that_exclude_each_other_are_refused() {
    let both = refusal(&["sim", "room", "--drive", "a", "--follow", "b"]);
    assert!(both.contains("--drive") && both.contains("--follow"), "{both}");
    assert!(refusal(&["map", "log", "--localise"]).contains("--map"));
    assert!(refusal(&["map", "log", "--poses-drift"]).contains("--poses"));
    assert!(refusal(&["demo", "--resume", "1,1,0"]).contains("--checkpoint"));
}
