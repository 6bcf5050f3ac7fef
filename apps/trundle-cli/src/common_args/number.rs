//! Numbers of the command line.

use clap::builder::TypedValueParser;
use clap::error::ErrorKind;
use clap::{Arg, Command, Error};
use std::ffi::OsStr;
pub use trundle::app::NumberText;

/// The number of an option.
#[derive(Debug, Clone, Copy)]
pub struct NumberArg(pub NumberText);

impl TypedValueParser for NumberArg {
    type Value = f64;

    fn parse_ref(&self, command: &Command, arg: Option<&Arg>, value: &OsStr) -> Result<f64, Error> {
        let option =
            arg.and_then(Arg::get_long).map_or_else(|| "the number".to_owned(), |name| format!("--{name}"));
        self.0.read(&option, &value.to_string_lossy()).map_err(|problem| {
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
