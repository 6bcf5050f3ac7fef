//! Open-loop command scripts: twists by time.

use super::rows::rows;
use trundle_core::{Invalid, Twist2};

/// A twist from a time on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedCommand {
    /// Seconds since the start, 0 or more.
    pub time: f64,
    /// The twist from then on.
    pub twist: Twist2,
}

/// No drive takes longer than this, s: eleven days. Source: ours.
const MAX_DRIVE_DURATION_S: f64 = 1e6;

/// Timed commands: each is active until the next one. Before the first command the robot is at rest; the last time is the script's end (a
/// script ends with a line `t 0 0`).
#[derive(Debug, Clone, PartialEq)]
pub struct CommandScript {
    commands: Vec<TimedCommand>,
}

impl CommandScript {
    /// A script of lines `t v omega` (s, m/s, rad/s), by rising time; `#` starts a comment.
    ///
    /// # Errors
    /// When the text has no line, a line is not three finite numbers, or times do not increase from 0; the error names the line.
    pub fn parse(text: &str) -> Result<Self, Invalid> {
        let mut commands: Vec<TimedCommand> = Vec::new();
        for (line, [time, v, omega]) in rows(text, ["t", "v", "omega"])? {
            let before = commands.last().map(|command| command.time);
            if time > MAX_DRIVE_DURATION_S {
                return Err(Invalid::new(
                    format!("t in line {line}"),
                    time,
                    "s",
                    format!("at most {MAX_DRIVE_DURATION_S}"),
                ));
            }
            if time < 0.0 || before.is_some_and(|before| time <= before) {
                let expected = before.map_or("0 or more".to_owned(), |before| format!("more than {before}"));
                return Err(Invalid::new(format!("t in line {line}"), time, "s", expected));
            }
            commands.push(TimedCommand { time, twist: Twist2::new(v, omega) });
        }
        if commands.is_empty() {
            return Err(Invalid::new("lines of commands", 0, "", "1 or more"));
        }
        Ok(Self { commands })
    }

    /// The commands, by rising time.
    pub fn commands(&self) -> &[TimedCommand] {
        &self.commands
    }

    /// When the script is over, s.
    pub fn duration(&self) -> f64 {
        self.commands.last().map_or(0.0, |command| command.time)
    }

    /// The twist `time` seconds after the start.
    pub fn at(&self, time: f64) -> Twist2 {
        let begun_count = self.commands.partition_point(|command| command.time <= time);
        begun_count.checked_sub(1).map_or(Twist2::ZERO, |i| self.commands[i].twist)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_command_holds_until_the_next() {
        let script = CommandScript::parse("# t v omega\n0.5 0.3 0\n2 0 -1\n3 0 0\n").unwrap();
        assert_eq!(script.at(0.4), Twist2::ZERO);
        assert_eq!(script.at(0.5), Twist2::new(0.3, 0.0));
        assert_eq!(script.at(2.5), Twist2::new(0.0, -1.0));
        assert_eq!((script.at(9.0), script.duration()), (Twist2::ZERO, 3.0));
    }

    #[test]
    fn bad_scripts_name_their_line() {
        let error = |text: &str| CommandScript::parse(text).unwrap_err().to_string();
        assert_eq!(error("0 0.1 0\n0 0 0"), "t in line 2 is 0 s, expected more than 0");
        assert_eq!(error("-1 0.1 0"), "t in line 1 is -1 s, expected 0 or more");
        assert_eq!(error("0 1 0\n1e12 0 0"), "t in line 2 is 1000000000000 s, expected at most 1000000");
        assert_eq!(error("1 inf 0"), "v in line 1 is inf, expected a finite number");
        assert_eq!(error("# nothing"), "lines of commands is 0, expected 1 or more");
    }
}
