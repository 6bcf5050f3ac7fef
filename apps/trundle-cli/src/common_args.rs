//! Arguments that several commands take: quiet, threads, robot file, poses, up axis.

mod bag_topics;
mod choice;
mod number;
mod place;

pub use bag_topics::BagTopicsArgs;
pub use choice::choice;
pub use number::{NumberArg, NumberText};
pub use place::PlaceArgs;

use crate::output_args::leaf;
use clap::{ArgMatches, Args};
use std::path::PathBuf;
pub use trundle::app::PoseArg;
use trundle::app::{AppError, load_robot};
use trundle::experiments::simulated::MeshOptions;
use trundle::runtime::RobotConfig;
use trundle::sim::import::UpAxis;

/// Options of every command.
#[derive(Debug, Clone, Args)]
pub struct Common {
    /// Print only warnings and errors: no progress, no table.
    #[arg(long, short)]
    pub quiet: bool,
    /// Threads to use; the results are the same for any number [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub threads: Option<u16>,
}

/// The number of threads that a command is given; `None`: one per core.
pub fn threads(matches: &ArgMatches) -> Option<u16> {
    leaf(matches).try_get_one("threads").ok().flatten().copied()
}

/// Options of every command that has a robot.
#[derive(Debug, Clone, Args)]
pub struct RobotArgs {
    /// Robot file (see `trundle config`).
    #[arg(long, value_name = "FILE")]
    pub config: Option<PathBuf>,
    /// Set one key in place of the robot file's, as `--set control.settling.speed_m_s=0.2`; may be repeated.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

impl RobotArgs {
    /// The robot of the file, or the default one, with the keys of `--set`.
    ///
    /// # Errors
    /// Names the file or the key, and the fault.
    pub fn robot(&self) -> Result<RobotConfig, AppError> {
        load_robot(self.config.as_deref(), &self.set)
    }

    /// The robot if a file or a key is given, else `None`.
    ///
    /// # Errors
    /// As [`RobotArgs::robot`].
    pub fn robot_if_given(&self) -> Result<Option<RobotConfig>, AppError> {
        if self.config.is_none() && self.set.is_empty() { Ok(None) } else { self.robot().map(Some) }
    }
}

/// Placement of a .glb or .gltf in a scene.
#[derive(Debug, Clone, Copy, Args)]
pub struct MeshArgs {
    /// The axis that points up in a .glb or .gltf.
    #[arg(long, value_name = "AXIS", default_value = "y", hide_short_help = true, value_parser = choice(&UpAxis::CHOICES))]
    pub up: UpAxis,
    /// Metres per unit of a .glb or .gltf, as 0.01 for centimetres [default: 1]
    #[arg(long, value_name = "M", value_parser = NumberArg(NumberText::above_zero("m")), allow_negative_numbers = true)]
    pub scale: Option<f64>,
    /// Height of the floor in a .glb or .gltf, m: it is moved to z = 0 [default: the lowest large level]
    #[arg(long, value_name = "Z", hide_short_help = true, value_parser = NumberArg(NumberText::any("m")), allow_negative_numbers = true)]
    pub floor: Option<f64>,
}

impl MeshArgs {
    /// The options of the scene.
    pub fn options(self) -> MeshOptions {
        MeshOptions { up: self.up, scale: self.scale, floor: self.floor }
    }
}
