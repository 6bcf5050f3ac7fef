//! The command line of `trundle`, for the program and for the Python package.

mod calibrate;
mod command_line;
mod common_args;
mod console;
mod convert;
mod data;
mod demo;
mod devices;
mod dock;
mod doctor;
mod eval;
mod experiment;
mod live;
mod logging;
mod map;
#[cfg(feature = "mqtt")]
mod mqtt;
mod outcome;
mod output_args;
mod plan;
mod replay;
mod robot_file;
#[cfg(feature = "ros2")]
mod ros2;
#[cfg(feature = "ros2")]
mod ros_node;
mod run;
mod run_output;
mod shell_files;
mod sim;
mod slam;
mod vocabulary;

use clap::{CommandFactory, FromArgMatches};
use command_line::{Cli, Command};
use outcome::Outcome;
use trundle::app::{AppError, on_threads, stop};
use trundle::io::{abandon_outputs, abandon_unfinished, wait_for_abandonment};

/// Runs the command line of these arguments, the program's name first. Returns the exit code of the process. A command handles Ctrl-C and
/// SIGTERM, and starts the log, so the process must do nothing else.
pub fn run(arguments: impl IntoIterator<Item = std::ffi::OsString>) -> u8 {
    let matches = command().try_get_matches_from(arguments);
    let (cli, matches) = match matches.and_then(|found| Ok((Cli::from_arg_matches(&found)?, found))) {
        Ok(parsed) => parsed,
        Err(usage) => {
            // This case includes help and version.
            let code = usage.exit_code() as u8;
            return if console::print_usage(&usage) { code } else { outcome::end(Ok(Outcome::Reached), &[]) };
        }
    };
    let started = stop::survive_file_limits().and_then(|()| trundle::app::start_log(cli.verbose));
    match started.and_then(|()| output_args::check(&matches)) {
        Ok(folders) => {
            let threads = common_args::threads(&matches);
            let result = listen(&cli.command).and_then(|()| on_threads(threads, || run_command(cli.command)));
            wait_for_abandonment();
            outcome::end(result, &folders)
        }
        Err(error) => outcome::end(Err(error), &[]),
    }
}

/// The definition of the command line.
pub fn command() -> clap::Command {
    with_negative_numbers(Cli::command())
}

/// Handles Ctrl-C: a request to stop for commands with long loops, the end of the program for others.
fn listen(command: &Command) -> Result<(), AppError> {
    use Command::{Calibrate, Convert, Demo, Experiment, GuardBase, Map, Replay, Run, Sim, Slam};
    match command {
        Map(args) if args.tool.is_some() => stop::end_at_once(end_at_once),
        Calibrate(_) | Convert(_) | Demo(_) | Run(_) | Replay(_) | Slam(_) | Map(_) | Sim(_)
        | Experiment(_) => stop::listen(end_unfinished),
        // A guard must outlive its program.
        GuardBase => stop::ignore(),
        #[cfg(feature = "ros2")]
        Command::Ros2(_) => stop::listen(end_unfinished),
        _ => stop::end_at_once(end_at_once),
    }
}

/// Handles the first signal of a command without long loops. Returns whether the program ends.
fn end_at_once(signal: stop::StopSignal) -> bool {
    let is_ending = abandon_outputs();
    if is_ending {
        console::print_stopped(signal.name(), &format!("; {}", trundle::app::written_text()));
    }
    is_ending
}

/// Handles a second signal: completes results that are being moved to their place, and removes others.
fn end_unfinished(signal: stop::StopSignal) {
    abandon_unfinished();
    console::print_stopped(signal.name(), ", the second signal; unfinished results are removed");
}

/// A negative number is the value of the option before it, not an option.
fn with_negative_numbers(command: clap::Command) -> clap::Command {
    let takes_numbers = |arg: clap::Arg| {
        if arg.get_action().takes_values() { arg.allow_negative_numbers(true) } else { arg }
    };
    command.mut_args(takes_numbers).mut_subcommands(with_negative_numbers)
}

fn run_command(command: Command) -> Result<Outcome, AppError> {
    match command {
        Command::Demo(args) => demo::run(&args),
        Command::Run(args) => run::run(&args),
        #[cfg(feature = "ros2")]
        Command::Ros2(args) => ros2::run(&args),
        Command::Replay(args) => replay::run(&args),
        Command::Slam(args) => slam::run(&args),
        Command::Convert(args) => convert::run(&args),
        Command::Map(args) => map::run(&args),
        Command::Calibrate(args) => calibrate::run(&args),
        Command::Eval(args) => eval::run(&args),
        Command::Plan(args) => plan::run(&args),
        Command::Sim(args) => sim::run(&args),
        Command::Dock(args) => dock::run(&args),
        Command::Experiment(args) => experiment::run(&args),
        Command::Vocabulary(args) => vocabulary::run(&args),
        Command::Config(args) => robot_file::print(&args),
        Command::Doctor(args) => Ok(doctor::run(&args)),
        Command::Devices(args) => Ok(devices::run(&args)),
        Command::ServeCamera(args) => devices::serve(&args),
        Command::GuardBase => devices::guard(),
        Command::Data(args) => data::run(&args),
        Command::Completions(args) => shell_files::print_completions(&args, Cli::command()),
        Command::Man(args) => shell_files::write_man_pages(&args, Cli::command()),
    }
}
