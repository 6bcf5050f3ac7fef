//! The runner of the fuzz targets on the stable toolchain: `trundle-fuzz run SECONDS SEED [TARGET]`, `trundle-fuzz reproduce TARGET FILE`.
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "this is a program that talks")]

mod counting_allocator;
mod coverage;
mod current_input;
mod finding;
mod mutation;
mod supervisor;
mod watchdog;
mod worker;

use std::process::ExitCode;
use std::time::Duration;
use trundle_fuzz::{FuzzTarget, TARGETS};

/// Counts the memory of the readers.
#[global_allocator]
static MEMORY: counting_allocator::CountingAllocator = counting_allocator::CountingAllocator::new();

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let is_clean = match words[..] {
        ["run", seconds, seed] => {
            numbers(seconds, seed).and_then(|(time, seed)| supervisor::run(&TARGETS, time, seed))
        }
        ["run", seconds, seed, name] => numbers(seconds, seed)
            .and_then(|(time, seed)| target(name).and_then(|target| supervisor::run(&[*target], time, seed))),
        ["work", seconds, seed, name, folder] => numbers(seconds, seed).and_then(|(time, seed)| {
            target(name).and_then(|target| worker::run(target, time, seed, folder.as_ref()))
        }),
        ["reproduce", name, file] => target(name).and_then(|target| worker::reproduce(target, file.as_ref())),
        _ => Err("usage: trundle-fuzz run SECONDS SEED [TARGET] | reproduce TARGET FILE".to_owned()),
    };
    match is_clean {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(problem) => {
            eprintln!("trundle-fuzz: {problem}");
            ExitCode::from(2)
        }
    }
}

fn numbers(seconds: &str, seed: &str) -> Result<(Duration, u64), String> {
    let wrong = |name: &str, text: &str| format!("{name} is '{text}', expected a whole number");
    let time = seconds.parse().map_err(|_| wrong("SECONDS", seconds))?;
    Ok((Duration::from_secs(time), seed.parse().map_err(|_| wrong("SEED", seed))?))
}

fn target(name: &str) -> Result<&'static FuzzTarget, String> {
    FuzzTarget::named(name).ok_or_else(|| {
        let names: Vec<&str> = TARGETS.iter().map(|target| target.name).collect();
        format!("no target '{name}', expected one of {}", names.join(", "))
    })
}
