//! Chores of the workspace: `cargo xtask ci | tidy | book | commands | golden | packages | dist | deb | sbom | semver | reproduce | results | gallery | pictures | replay-check | fuzz | fault-scenarios | aarch64 | robot-memory | ros-interfaces | states | demo-seeds`.
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "this is a program that talks")]

mod aarch64;
mod book;
mod ci;
mod command_reference;
mod compare;
mod dist;
mod fault_scenarios;
mod fuzz;
mod gallery;
mod golden;
mod markdown;
mod packages;
mod program;
mod replay_check;
mod results;
mod robot_memory;
mod ros_interfaces;
mod seeds;
mod semver;
mod settings;
mod shell_block;
mod states;
mod tidy;
mod workspace;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Chores of the workspace.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: XtaskCommand,
}

#[derive(Debug, Subcommand)]
enum XtaskCommand {
    /// Everything that must hold before a change is merged, in order, until the first failure.
    Ci {
        /// Leave out `cargo test --workspace`: it ran just before.
        #[arg(long)]
        tested: bool,
    },
    /// Check the design's invariants in the sources.
    Tidy {
        /// Lower the allow-list (xtask/tidy-allowed.txt) to the present findings.
        #[arg(long)]
        shrink: bool,
        /// Take up all findings into the allow-list: for a new rule only.
        #[arg(long, hide = true)]
        grow: bool,
    },
    /// Run the tested commands of docs, build the book with mdbook, check its links and search in it. The build is skipped if mdbook is missing.
    Book,
    /// Write docs/commands.md from the help of the release program.
    Commands,
    /// Replace links of the book to files outside docs: called by mdbook, with its JSON on standard input.
    #[command(hide = true)]
    BookLinks {
        /// `supports RENDERER`: mdbook's question whether the renderer is supported.
        question: Vec<String>,
    },
    /// Compare hashes of twists, poses, grids, maps and plans with the committed ones.
    Golden {
        /// Write the hashes that were found into the golden file.
        #[arg(long)]
        update: bool,
        /// Only cases whose name holds this.
        #[arg(long, value_name = "WORD")]
        only: Option<String>,
        /// Build profile of the program under test: release or dev.
        #[arg(long, default_value = "release")]
        profile: String,
    },
    /// Build the program of a release; print its size and checksum.
    Dist {
        /// Also build it with the default features, and print that size.
        #[arg(long)]
        sizes: bool,
    },
    /// Build the Debian package, check its content, unpack it and run its program. Skipped if tools are missing.
    Deb(dist::deb::Options),
    /// Write the list of parts (SBOM) of the program of a release as CycloneDX.
    Sbom,
    /// Compare the public interfaces with those of the last tag. Skipped without a tag or cargo-semver-checks.
    Semver,
    /// Build the committed sources at two paths: both programs must have the same bytes. Takes two builds from nothing.
    Reproduce,
    /// Run the publication of every crate without an upload, or only pack them without a network; check the packages and the facade's features.
    Packages {
        /// Build every feature of the facade alone, not only the algorithms'.
        #[arg(long)]
        every_feature: bool,
    },
    /// Write docs/results.md from results/*.json.
    Results {
        /// Repeat this measurement first (its name in results/); may be given several times.
        #[arg(long, value_name = "NAME")]
        measure: Vec<String>,
        /// Take the figures from this file, the standard output of an earlier run of the command, in place of running it.
        #[arg(long, value_name = "FILE", requires = "measure")]
        printed: Option<std::path::PathBuf>,
    },
    /// Write docs/gallery.md and its charts from results/*.json.
    Gallery {
        /// Repeat the measurements of the page first: all of them, with its pictures, or the named ones.
        #[arg(long, value_name = "NAME", num_args = 0..)]
        measure: Option<Vec<String>>,
    },
    /// Draw the pictures of docs by the release program: all of them, or those whose names contain a word.
    Pictures {
        /// Words in the names of the pictures.
        words: Vec<String>,
    },
    /// Write the reference of settings from the doc comments of the configuration structs.
    Settings,
    /// Write diagram and tables of docs/explanation/behaviour.md from the state machine's table of transitions.
    States,
    /// Write the Rust structures of the ROS 2 interfaces in crates/trundle-ros2/interfaces.
    RosInterfaces,
    /// Demo on one thread, on two, and replayed: all three must write the same bytes.
    ReplayCheck {
        /// Seed of the demo.
        #[arg(long, default_value_t = 1)]
        seed: u64,
    },
    /// Feed broken files to every reader: none may panic, hang or take unbounded memory.
    Fuzz(fuzz::Options),
    /// Broken sensors, slipping wheels, people in the robot's path: each run must end as its scenario expects.
    FaultScenarios,
    /// Kernels and short runs on aarch64, under qemu: the same bytes as here. Skipped if tools are missing.
    Aarch64,
    /// Resident memory of `trundle run` during the exploration of a simulated office, with the simulator in another process.
    RobotMemory {
        /// Duration of the exploration.
        #[arg(long, default_value_t = 10.0)]
        minutes: f64,
    },
    /// Run the demo on many seeds and print a table of their summaries.
    DemoSeeds {
        /// Number of seeds, from the first on.
        #[arg(long, default_value_t = 10)]
        seeds: u64,
        /// The first seed.
        #[arg(long, default_value_t = 1)]
        first: u64,
        /// Explore first, as the README's demo does.
        #[arg(long)]
        explore: bool,
    },
}

fn main() -> ExitCode {
    let root = workspace::root();
    let verdict = match Cli::parse().command {
        XtaskCommand::Ci { tested } => ci::run(&root, tested),
        XtaskCommand::Tidy { shrink, grow } if shrink || grow => tidy::shrink(&root, grow),
        XtaskCommand::Tidy { .. } => tidy::run(&root),
        XtaskCommand::Book => book::run(&root),
        XtaskCommand::Commands => {
            program::release_trundle(&root).and_then(|trundle| command_reference::run(&root, &trundle, false))
        }
        XtaskCommand::BookLinks { question } => book::repository_links::run(&question),
        XtaskCommand::Golden { update, only, profile } => {
            golden::run(&root, &golden::Options { update, only, profile })
        }
        XtaskCommand::Dist { sizes } => dist::run(&root, sizes),
        XtaskCommand::Deb(options) => dist::deb::run(&root, &options),
        XtaskCommand::Sbom => dist::sbom::run(&root),
        XtaskCommand::Semver => semver::run(&root),
        XtaskCommand::Reproduce => dist::reproduce::run(&root),
        XtaskCommand::Packages { every_feature } => packages::run(&root, every_feature),
        XtaskCommand::Results { measure, printed } => results::run(&root, &measure, printed.as_deref()),
        XtaskCommand::Gallery { measure } => gallery::run(&root, measure.as_deref()),
        XtaskCommand::Pictures { words } => gallery::pictures::draw(&root, &words),
        XtaskCommand::Settings => settings::run(&root, false),
        XtaskCommand::States => states::run(&root, false),
        XtaskCommand::RosInterfaces => ros_interfaces::run(&root, false),
        XtaskCommand::ReplayCheck { seed } => replay_check::run(&root, seed),
        XtaskCommand::Fuzz(options) => fuzz::run(&root, &options),
        XtaskCommand::FaultScenarios => fault_scenarios::run(&root),
        XtaskCommand::Aarch64 => aarch64::run(&root),
        XtaskCommand::RobotMemory { minutes } => robot_memory::run(&root, minutes),
        XtaskCommand::DemoSeeds { seeds, first, explore } => {
            seeds::run(&root, first..first.saturating_add(seeds), explore)
        }
    };
    match verdict {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(why) => {
            eprintln!("xtask: {why}");
            ExitCode::FAILURE
        }
    }
}
