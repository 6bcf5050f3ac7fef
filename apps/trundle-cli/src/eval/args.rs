//! The command line of `trundle eval`.

use crate::common_args::{Common, NumberArg, NumberText, PoseArg, choice};
use crate::output_args::OutputDirArg;
use clap::{Args, Subcommand};
use std::path::PathBuf;
use trundle::eval::{Alignment, DeltaUnit};

/// `trundle eval`
#[derive(Debug, Args)]
pub struct EvalArgs {
    /// The object of the evaluation.
    #[command(subcommand)]
    pub which: EvalObject,
}

/// Objects of an evaluation.
#[derive(Debug, Subcommand)]
pub enum EvalObject {
    /// A trajectory, by its absolute and relative errors (ATE and RPE, as evo takes them).
    Trajectory(TrajectoryArgs),
    /// A trajectory, by relations between its poses (Kuemmerle et al. 2009).
    Relations(RelationsArgs),
    /// A map, by its occupied cells against the true map's.
    Map(MapsArgs),
}

/// `trundle eval trajectory`
#[derive(Debug, Args)]
#[command(
    after_help = "Example: trundle eval trajectory groundtruth.txt out/slam/trajectory.txt --out out/eval\n\n\
    The absolute error is taken after alignment, the relative one needs none. Defaults are evo's."
)]
pub struct TrajectoryArgs {
    /// The true trajectory.
    pub reference: PathBuf,
    /// The trajectory to evaluate.
    pub estimate: PathBuf,
    /// Alignment of the estimate with the reference for the absolute error.
    #[arg(long, value_name = "HOW", default_value = "se3", value_parser = choice(&Alignment::CHOICES))]
    pub align: Alignment,
    /// Length of the motions of the relative error, in --unit.
    #[arg(long, value_name = "N", default_value_t = 1.0, value_parser = NumberArg(NumberText::above_zero("")), allow_negative_numbers = true)]
    pub delta: f64,
    /// Unit of --delta.
    #[arg(long, default_value = "frames", value_parser = choice(&DeltaUnit::CHOICES))]
    pub unit: DeltaUnit,
    /// Start a motion at every pose: motions overlap.
    #[arg(long)]
    pub all_pairs: bool,
    /// Poses further apart in time than this are not compared, s.
    #[arg(long, value_name = "S", default_value_t = 0.01, value_parser = NumberArg(NumberText::from_zero("s")), allow_negative_numbers = true)]
    pub max_difference: f64,
    /// Write report.html, its pictures and summary.json into this folder; the previous one is renamed to DIR.1
    #[arg(long, value_name = "DIR")]
    pub out: Option<OutputDirArg>,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}

/// `trundle eval relations`
#[derive(Debug, Args)]
#[command(
    after_help = "Example: trundle eval relations ../shared/data/laser/killian_g2o.ref.traj out/map/trajectory.txt\n\n\
    Trajectories: lines of t x y theta, or of a TUM trajectory. Of a reference the relations 1 m and 10 m apart and\n\
    those of places visited again are taken."
)]
pub struct RelationsArgs {
    /// A reference trajectory, or with --file a relation file: from_time to_time x y z roll pitch yaw.
    pub reference: PathBuf,
    /// The trajectory to evaluate.
    pub estimate: PathBuf,
    /// REFERENCE is a relation file.
    #[arg(long)]
    pub file: bool,
    /// A pose is matched to a time at most this far away, s.
    #[arg(long, value_name = "S", default_value_t = 0.01, value_parser = NumberArg(NumberText::from_zero("s")), allow_negative_numbers = true)]
    pub max_difference: f64,
    /// Write summary.json into this folder; the previous one is renamed to DIR.1
    #[arg(long, value_name = "DIR")]
    pub out: Option<OutputDirArg>,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}

/// `trundle eval map`
#[derive(Debug, Args)]
#[command(
    after_help = "Example: trundle eval map data/office/map.yaml out/map/map.yaml --at 0.75,5.9,100\n\n\
    The map is laid over the true one by iterated closest points, beginning at --at, unless --exact."
)]
pub struct MapsArgs {
    /// The true map, in map_server's format.
    pub truth: PathBuf,
    /// The map to evaluate.
    pub map: PathBuf,
    /// Pose of the map's frame in the true one's: m, m, deg.
    #[arg(long, value_name = "X,Y,DEG", allow_hyphen_values = true, default_value = "0,0,0")]
    pub at: PoseArg,
    /// --at is exact: the map is evaluated at this pose.
    #[arg(long)]
    pub exact: bool,
    /// Occupied cells agree if their centres are at most this far apart, m.
    #[arg(long, value_name = "M", default_value_t = 0.05, value_parser = NumberArg(NumberText::above_zero("m")), allow_negative_numbers = true)]
    pub within: f64,
    /// Write summary.json into this folder; the previous one is renamed to DIR.1
    #[arg(long, value_name = "DIR")]
    pub out: Option<OutputDirArg>,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}
