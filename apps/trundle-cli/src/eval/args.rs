//! The command line of `trundle eval`.

use crate::common_args::{Common, PoseArg};
use clap::{Args, Subcommand};
use std::path::PathBuf;

/// `trundle eval`
#[derive(Debug, Args)]
pub struct EvalArgs {
    /// What is judged.
    #[command(subcommand)]
    pub which: Which,
}

/// What can be judged.
#[derive(Debug, Subcommand)]
pub enum Which {
    /// A trajectory, by relations between its poses (Kuemmerle et al. 2009).
    Relations(RelationsArgs),
    /// A map, by its occupied cells against the true map's.
    Map(MapsArgs),
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
    /// The trajectory to judge.
    pub estimate: PathBuf,
    /// REFERENCE is a relation file.
    #[arg(long)]
    pub file: bool,
    /// A pose stands for a time at most so far away, s.
    #[arg(long, value_name = "S", default_value_t = 0.01)]
    pub max_difference: f64,
    /// Write summary.json into this folder.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// What every command takes.
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
    /// The true map, in map_server's form.
    pub truth: PathBuf,
    /// The map to judge.
    pub map: PathBuf,
    /// Where the map's frame lies in the true one's: m, m, deg.
    #[arg(long, value_name = "X,Y,DEG", allow_hyphen_values = true, default_value = "0,0,0")]
    pub at: PoseArg,
    /// --at is exact: the map is judged where it lies.
    #[arg(long)]
    pub exact: bool,
    /// Occupied cells agree when their centres are at most so far apart, m.
    #[arg(long, value_name = "M", default_value_t = 0.05)]
    pub within: f64,
    /// Write summary.json into this folder.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// What every command takes.
    #[command(flatten)]
    pub common: Common,
}

impl EvalArgs {
    /// What every command takes.
    pub fn common(&self) -> &Common {
        match &self.which {
            Which::Relations(args) => &args.common,
            Which::Map(args) => &args.common,
        }
    }
}
