//! Help, version and usage errors of every command.

use crate::program::{refusal, trundle};

/// Every command and subcommand.
const COMMANDS: [&[&str]; 46] = [
    &[],
    &["demo"],
    &["replay"],
    &["slam"],
    &["map"],
    &["map", "crop"],
    &["map", "rotate"],
    &["map", "diff"],
    &["map", "merge"],
    &["map", "rooms"],
    &["calibrate"],
    &["calibrate", "camera"],
    &["calibrate", "mount"],
    &["calibrate", "wheels"],
    &["calibrate", "delay"],
    &["eval"],
    &["eval", "trajectory"],
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
    &["experiment", "known-map"],
    &["experiment", "real-time"],
    &["experiment", "corridor"],
    &["experiment", "look-alikes"],
    &["experiment", "docking-station"],
    &["experiment", "merge"],
    &["vocabulary"],
    &["vocabulary", "train"],
    &["vocabulary", "export"],
    &["vocabulary", "recall"],
    &["config"],
    &["doctor"],
    &["data"],
    &["data", "fetch-list"],
    &["completions"],
    &["man"],
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
fn commands_that_write_a_folder_print_its_path() {
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
fn the_version_is_the_packages_and_the_long_one_names_the_commit() {
    let package = format!("trundle {}", env!("CARGO_PKG_VERSION"));
    assert_eq!(output_of(&["-V"]).trim(), package);
    let long = output_of(&["--version"]);
    let rest = long.trim().strip_prefix(&package).expect("the package's version first");
    let commit = rest.strip_prefix(" (").and_then(|rest| rest.strip_suffix(')'));
    let is_commit = |text: &str| text.len() >= 7 && text.chars().all(|c| c.is_ascii_hexdigit());
    assert!(rest.is_empty() || commit.is_some_and(is_commit), "{long}");
}

fn output_of(args: &[&str]) -> String {
    let output = trundle(args);
    assert_eq!(output.status.code(), Some(0), "{args:?}");
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn completions_of_a_shell_name_every_command() {
    for shell in ["bash", "zsh", "fish"] {
        let script = output_of(&["completions", shell]);
        for command in COMMANDS.iter().filter(|command| command.len() == 1) {
            assert!(script.contains(command[0]), "{shell}: {command:?}");
        }
    }
    assert!(refusal(&["completions", "tcsh"]).contains("bash"), "the known shells are listed");
}

#[test]
fn the_fetch_list_names_origin_licence_and_command_of_each_data_set() {
    let list = output_of(&["data", "fetch-list"]);
    for fact in ["barn", "MIT-0", "CC0-1.0", "CC BY 4.0", "git clone https://", "trundle experiment house"] {
        assert!(list.contains(fact), "{fact}: {list}");
    }
    let missing = refusal(&["experiment", "mrpb", "--data", "no/such/folder"]);
    assert!(
        missing.contains("start_goal.csv is not there") && missing.contains("trundle data fetch-list"),
        "{missing}"
    );
}

#[test]
fn every_command_has_a_man_page() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("man1");
    output_of(&["man", out.to_str().unwrap()]);
    for command in COMMANDS {
        let name = ["trundle"].iter().chain(command).copied().collect::<Vec<_>>().join("-");
        let page = std::fs::read_to_string(out.join(format!("{name}.1"))).unwrap();
        assert!(page.contains(".SH SYNOPSIS"), "{name}: {page}");
    }
}

#[test]
fn a_man_page_that_cannot_be_written_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("man1");
    std::fs::write(&file, "").unwrap();
    assert!(refusal(&["man", file.to_str().unwrap()]).contains("man1"));
}

#[test]
fn there_is_no_colour_where_there_is_no_terminal() {
    for args in
        [&["--help"][..], &["demo", "--sed"], &["plan", "nowhere.yaml", "--from=0,0,0", "--goal=1,0,0"]]
    {
        let output = trundle(args);
        let printed = [output.stdout, output.stderr].concat();
        assert!(!printed.is_empty() && !printed.contains(&0x1b), "{args:?}");
    }
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
