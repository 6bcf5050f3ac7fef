//! The command line of `trundle dock`.

use crate::common_args::{Common, NumberArg, NumberText, PoseArg, RobotArgs, choice};
use crate::output_args::{OutputDirArg, OutputFileArg};
use clap::Args;
use std::path::PathBuf;
use trundle::core::Footprint;
use trundle::docking::Method;

/// `trundle dock`
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  trundle dock map.yaml --from 1.0,2.0,90 --to 1.2,2.0,90 --footprint '0.3,0.2 -0.3,0.2 -0.3,-0.2 0.3,-0.2'\n  \
    trundle dock hong24-a --method paper\n  \
    trundle dock hong24-a --write-problem corridor.txt\n  \
    trundle dock corridor.txt --problem hong24-a\n  \
    trundle dock robot.log --scan 12 --to 0.4,0.1,0\n\n\
    Exit code: 0 a manoeuvre was found, 1 no manoeuvre, or start or goal do not fit (reason and picture are written instead), 2 bad input, nothing is written."
)]
pub struct DockArgs {
    /// A map in map_server's format (*.yaml), a laser log (*.log, one scan of it), a file of corridor problems
    /// (docs/corridor-benchmark.md), or one of the built-in hong24-a, -b, -c, -d.
    pub place: PathBuf,
    /// Start pose in the map frame: m, m, deg [default: the problem's; in a scan, the robot's pose: 0,0,0]
    #[arg(long, value_name = "X,Y,DEG", allow_hyphen_values = true)]
    pub from: Option<PoseArg>,
    /// Goal pose in the map frame: m, m, deg [default: the problem's]
    #[arg(long, value_name = "X,Y,DEG", allow_hyphen_values = true)]
    pub to: Option<PoseArg>,
    /// The robot's outline: a radius, or the corners of a convex polygon, also in Nav2's format ([[X,Y],[X,Y],...]), base frame, m
    /// [default: the problem's or the robot file's]
    #[arg(long, value_name = "R|'X,Y X,Y X,Y...'", allow_hyphen_values = true)]
    pub footprint: Option<Footprint>,
    /// Number of the scan in the log, from 1; poses are in the frame of the robot that made it [default: the last]. With a log only.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub scan: Option<u32>,
    /// Name of the problem in the file [default: the first]. With a file of problems only.
    #[arg(long, value_name = "NAME")]
    pub problem: Option<String>,
    /// Planning method [default: the robot file's, or optimal]
    #[arg(long, value_parser = choice(&Method::CHOICES))]
    pub method: Option<Method>,
    /// Only write the problem to a file, as text to edit, including --from, --to and --footprint; a map's outlines become walls.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["out", "method", "margin"])]
    pub write_problem: Option<OutputFileArg>,
    /// Treat unknown cells of the map, and the space outside it, as free instead of blocked. With a map only.
    #[arg(long)]
    pub through_unknown: bool,
    /// Margin from every obstacle, m [default: the robot file's docking.planner.margin, which is 0.05; without a robot file 0.01]
    #[arg(long, value_name = "M", value_parser = NumberArg(NumberText::from_zero("m")), allow_negative_numbers = true)]
    pub margin: Option<f64>,
    /// The robot: its footprint, and the settings of [docking.planner], with which the robot itself plans.
    #[command(flatten)]
    pub robot: RobotArgs,
    /// Folder for the results; the previous run in it is renamed to DIR.1
    #[arg(long, value_name = "DIR", default_value = "out/dock")]
    pub out: OutputDirArg,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}
