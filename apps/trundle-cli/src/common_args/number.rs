//! Numbers of the command line, refused with option, value, unit and accepted range.

use clap::builder::TypedValueParser;
use clap::error::ErrorKind;
use clap::{Arg, Command, Error};
use std::ffi::OsStr;

/// The number of an option.
#[derive(Debug, Clone, Copy)]
pub struct NumberArg {
    /// Unit, as `m`; empty without a unit.
    unit: &'static str,
    /// Accepted numbers.
    range: Range,
}

/// Accepted finite numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Range {
    Any,
    FromZero,
    AboveZero,
    /// Above 0, to this.
    UpTo(f64),
}

impl NumberArg {
    /// Any finite number in `unit`.
    pub const fn any(unit: &'static str) -> Self {
        Self { unit, range: Range::Any }
    }

    /// 0 or more in `unit`.
    pub const fn from_zero(unit: &'static str) -> Self {
        Self { unit, range: Range::FromZero }
    }

    /// Above 0 in `unit`.
    pub const fn above_zero(unit: &'static str) -> Self {
        Self { unit, range: Range::AboveZero }
    }

    /// Above 0 in `unit`, `limit` at most.
    pub const fn up_to(limit: f64, unit: &'static str) -> Self {
        Self { unit, range: Range::UpTo(limit) }
    }

    fn takes(self, value: f64) -> bool {
        value.is_finite()
            && match self.range {
                Range::Any => true,
                Range::FromZero => value >= 0.0,
                Range::AboveZero => value > 0.0,
                Range::UpTo(limit) => value > 0.0 && value <= limit,
            }
    }

    fn wanted(self) -> String {
        let unit = if self.unit.is_empty() { String::new() } else { format!(" in {}", self.unit) };
        let range = match self.range {
            Range::Any => String::new(),
            Range::FromZero => ", 0 or more".to_owned(),
            Range::AboveZero => ", above 0".to_owned(),
            Range::UpTo(limit) => format!(", above 0 and at most {limit}"),
        };
        format!("a number{unit}{range}")
    }

    /// The number of the text given to `option`.
    fn read(self, option: &str, text: &str) -> Result<f64, String> {
        let wanted = self.wanted();
        match text.trim().parse::<f64>() {
            Ok(value) if self.takes(value) => Ok(value),
            Ok(value) if value.is_finite() => {
                let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
                Err(format!("{option} is {value}{unit}, expected {wanted}"))
            }
            _ => Err(format!("{option} is '{text}', expected {wanted}")),
        }
    }
}

impl TypedValueParser for NumberArg {
    type Value = f64;

    fn parse_ref(&self, command: &Command, arg: Option<&Arg>, value: &OsStr) -> Result<f64, Error> {
        let option =
            arg.and_then(Arg::get_long).map_or_else(|| "the number".to_owned(), |name| format!("--{name}"));
        self.read(&option, &value.to_string_lossy()).map_err(|problem| {
            Error::raw(ErrorKind::ValueValidation, format!("{problem}\n")).with_cmd(command)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command_line::Cli;
    use clap::CommandFactory;
    use std::any::TypeId;

    #[test]
    fn numbers_are_refused_with_option_value_unit_and_what_is_expected() {
        let refused = |number: NumberArg, text| number.read("--near", text).unwrap_err();
        assert_eq!(NumberArg::from_zero("m").read("--near", " 0.5"), Ok(0.5));
        assert_eq!(
            refused(NumberArg::from_zero("m"), "abc"),
            "--near is 'abc', expected a number in m, 0 or more"
        );
        assert_eq!(
            refused(NumberArg::from_zero("m"), "-1"),
            "--near is -1 m, expected a number in m, 0 or more"
        );
        assert_eq!(refused(NumberArg::any("deg"), "NaN"), "--near is 'NaN', expected a number in deg");
        assert_eq!(refused(NumberArg::above_zero(""), "0"), "--near is 0, expected a number, above 0");
        let long = refused(NumberArg::up_to(10.0, "s"), "11");
        assert_eq!(long, "--near is 11 s, expected a number in s, above 0 and at most 10");
    }

    /// The options of a command and its subcommands that take numbers, each with a word in place of its number.
    fn wrong_numbers(command: &Command, before: &[String]) -> Vec<Vec<String>> {
        let is_number = |arg: &&Arg| arg.get_value_parser().type_id() == TypeId::of::<f64>();
        let wrong = |arg: &Arg| {
            let option = format!("--{}", arg.get_long().unwrap_or_default());
            let pair = arg.get_value_names().is_some_and(|names| names.len() == 2);
            let values = if pair {
                vec![option, "abc".to_owned(), "abc".to_owned()]
            } else {
                vec![format!("{option}=abc")]
            };
            [before, &values].concat()
        };
        let mut all: Vec<Vec<String>> = command.get_arguments().filter(is_number).map(wrong).collect();
        for below in command.get_subcommands() {
            all.extend(wrong_numbers(below, &[before, &[below.get_name().to_owned()]].concat()));
        }
        all
    }

    #[test]
    fn every_number_of_every_command_is_refused_in_the_same_words() {
        let lines = wrong_numbers(&Cli::command(), &["trundle".to_owned()]);
        assert!(lines.len() > 15, "{lines:?}");
        for line in lines {
            let error = Cli::command().try_get_matches_from(&line).unwrap_err().to_string();
            assert!(error.contains(" is 'abc', expected a number"), "{line:?}: {error}");
        }
    }
}
