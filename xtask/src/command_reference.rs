//! The reference of commands: `--help` of each command of the program, as a page of the docs.

use crate::program::output;
use crate::workspace::Verdict;
use std::path::Path;

/// The generated page.
const PAGE: &str = "docs/commands.md";
/// Heading of the list of commands in a help text.
const COMMANDS: &str = "Commands:";
/// The command that only repeats the help of others.
const HELP: &str = "help";
/// Deepest nesting of commands, as in `trundle calibrate camera`; a guard against a program that lists itself. Source: ours.
const MAX_DEPTH: usize = 3;

/// Writes the page from the program's help, or checks that the page is that of the program.
pub fn run(root: &Path, trundle: &Path, is_check: bool) -> Verdict {
    let mut text = String::from(
        "# Commands\n\n<!-- Written by cargo xtask commands from the program's own help. -->\n\nThe help of each command, as `trundle COMMAND --help` prints it. The program has the \
         features of a release: `ros2`, `mqtt`, `foxglove`, `tls`.\n",
    );
    append(&mut text, trundle, &[])?;
    let page = root.join(PAGE);
    if !is_check {
        std::fs::write(&page, &text).map_err(|e| format!("cannot write {PAGE}: {e}"))?;
        return Ok(true);
    }
    let is_same = std::fs::read_to_string(&page).is_ok_and(|present| present == text);
    if !is_same {
        println!("{PAGE} is not the help of the program: run cargo xtask commands");
    }
    Ok(is_same)
}

/// Appends the help of a command and of those below it.
fn append(text: &mut String, trundle: &Path, command: &[&str]) -> Result<(), String> {
    let help = output(trundle, &[command, &["--help"]].concat())?;
    let help = String::from_utf8_lossy(&help);
    let name = [&["trundle"], command].concat().join(" ");
    let lines: Vec<&str> = help.trim_end().lines().map(str::trim_end).collect();
    text.push_str(&format!("\n## {name}\n\n```text\n{}\n```\n", lines.join("\n")));
    if command.len() < MAX_DEPTH {
        for next in commands_of(&help) {
            append(text, trundle, &[command, &[next]].concat())?;
        }
    }
    Ok(())
}

/// The names in the list of commands of a help text.
fn commands_of(help: &str) -> Vec<&str> {
    let list = help.lines().skip_while(|line| *line != COMMANDS).skip(1).take_while(|line| !line.is_empty());
    // A continued description stands further to the right.
    let names = list.filter_map(|line| line.strip_prefix("  ").filter(|line| !line.starts_with(' ')));
    names.filter_map(|line| line.split_whitespace().next()).filter(|name| *name != HELP).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_read_from_a_help_text() {
        let help = "Does much.\n\nUsage: x\n\nCommands:\n  crop      Cut a part\n            out of a map\n  look-alikes  Rooms\n  help  Print\n\nOptions:\n  -h\n";
        assert_eq!(commands_of(help), ["crop", "look-alikes"]);
        assert!(commands_of("Usage: x\n\nOptions:\n  -h  Print help\n").is_empty());
    }
}
