//! Fuzzing on the stable toolchain: builds the runner of `crates/trundle-fuzz` and starts it.

use crate::program;
use crate::workspace::Verdict;
use clap::Args;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Flags with which the compiler counts the edges of the control flow that are run through. Source: as `cargo fuzz` sets them.
const COUNTERS: &str = "-Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=3 \
    -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Ccodegen-units=16";
/// Build results with counters: they are of no use to others.
const GUIDED_TARGET: &str = "target/fuzz-guided";

/// `cargo xtask fuzz`
#[derive(Debug, Args)]
pub struct Options {
    /// Seconds for each target.
    #[arg(long, value_name = "N", default_value_t = 60)]
    seconds: u64,
    /// Only this target [default: all]
    #[arg(long, value_name = "NAME")]
    target: Option<String>,
    /// Seed of the mutations.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Store inputs that reach new code. This needs an additional build of the program.
    #[arg(long)]
    guided: bool,
    /// Read this one input of the target.
    #[arg(long, value_name = "FILE", requires = "target")]
    input: Option<PathBuf>,
}

impl Options {
    /// The arguments of the runner.
    fn arguments(&self) -> Vec<String> {
        let target = self.target.iter().cloned();
        match &self.input {
            Some(file) => ["reproduce".to_owned()]
                .into_iter()
                .chain(target)
                .chain([file.display().to_string()])
                .collect(),
            None => ["run".to_owned(), self.seconds.to_string(), self.seed.to_string()]
                .into_iter()
                .chain(target)
                .collect(),
        }
    }
}

/// Runs every target, or one, for some seconds. Returns whether no fault was found.
pub fn run(root: &Path, options: &Options) -> Verdict {
    let arguments = options.arguments();
    let mut cargo = vec!["run", "--quiet", "--package", "trundle-fuzz", "--"];
    cargo.extend(arguments.iter().map(String::as_str));
    let environment = [("CARGO_TARGET_DIR", GUIDED_TARGET), ("RUSTFLAGS", COUNTERS)];
    program::cargo(root, &cargo, if options.guided { &environment } else { &[] })
}

/// Two seconds per target, with the runner built by the workspace's tests: no compilation.
pub fn run_in_ci(root: &Path) -> Verdict {
    if !program::cargo(root, &["test", "--workspace", "--no-run", "--quiet"], &[])? {
        return Ok(false);
    }
    let runner =
        program::target(root)?.join("debug").join(format!("trundle-fuzz{}", std::env::consts::EXE_SUFFIX));
    let status =
        Command::new(&runner).args(["run", "2", "1"]).current_dir(root).stdin(Stdio::null()).status();
    Ok(status.map_err(|error| format!("cannot start {}: {error}", runner.display()))?.success())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_runner_gets_a_time_or_a_file() {
        let run = Options { seconds: 60, target: Some("graph".into()), seed: 1, guided: false, input: None };
        assert_eq!(run.arguments(), ["run", "60", "1", "graph"]);
        let reproduce = Options { input: Some("a.bin".into()), ..run };
        assert_eq!(reproduce.arguments(), ["reproduce", "graph", "a.bin"]);
    }
}
