//! The room of a simulated robot: seed, start, charging station, mesh.

use super::{MeshArgs, PoseArg};
use clap::Args;
use trundle::experiments::simulated::SceneOptions;

/// The room of a simulated robot.
#[derive(Debug, Args)]
pub struct PlaceArgs {
    /// Seed of the room's furniture and textures and of all noise.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Start of the robot, world frame: m, m, deg [default: the scene's own, or a free place]
    #[arg(long, value_name = "X,Y,DEG", allow_hyphen_values = true)]
    pub start: Option<PoseArg>,
    /// A charging station, world frame: the middle of its front on the floor, x axis out of the front: m, m, deg [default: none]
    #[arg(long, value_name = "X,Y,DEG", allow_hyphen_values = true)]
    pub station: Option<PoseArg>,
    /// Axis, scale and floor of a mesh.
    #[command(flatten)]
    pub mesh: MeshArgs,
}

impl PlaceArgs {
    /// Options of the scene.
    pub fn options(&self) -> SceneOptions {
        let pose = |arg: Option<PoseArg>| arg.map(|pose| pose.0);
        let (start, station) = (pose(self.start), pose(self.station));
        SceneOptions { seed: self.seed, mesh: self.mesh.options(), start, station }
    }
}
