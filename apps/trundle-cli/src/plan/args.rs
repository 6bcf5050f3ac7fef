//! The command line of `trundle plan`.

use crate::common_args::{Common, NumberArg, NumberText, RobotArgs};
use crate::output_args::OutputDirArg;
use clap::Args;
use std::path::PathBuf;
use trundle::app::plan::PlaceArg;

/// `trundle plan`
#[derive(Debug, Args)]
#[command(
    after_help = "Example: trundle plan ../shared/data/nav/nav2/depot.yaml --from=9.3,10.7,114 --goal=17.1,9.2,-80\n\n\
    Several goals are driven to in a row: --goal kitchen --goal=1,2,90. docs/algorithms/planning.md describes the files.\n\n\
    Exit code: 0 a plan for every goal, 1 no plan (reason and picture are written instead), 2 bad input, nothing is written."
)]
pub struct PlanArgs {
    /// A map in map_server's format.
    pub map: PathBuf,
    /// Start: a pose in the map frame (m, m, deg), or a place of --places.
    #[arg(long, value_name = "X,Y,DEG|NAME", allow_hyphen_values = true)]
    pub from: PlaceArg,
    /// Goal: a pose in the map frame (m, m, deg), or a place of --places; may be repeated for further goals.
    #[arg(
        long,
        visible_alias = "to",
        value_name = "X,Y,DEG|NAME",
        allow_hyphen_values = true,
        required = true
    )]
    pub goal: Vec<PlaceArg>,
    /// Named places: TOML, one table per place with x, y, heading_deg, or GeoJSON.
    #[arg(long, value_name = "FILE")]
    pub places: Option<PathBuf>,
    /// Keep-out mask in Nav2's format: black is forbidden, grey (mode scale) has extra costs.
    #[arg(long, value_name = "MASK.yaml")]
    pub keepout: Option<PathBuf>,
    /// Speed mask, as Nav2's: the darker the slower; black sets no limit.
    #[arg(long, value_name = "MASK.yaml")]
    pub speed_mask: Option<PathBuf>,
    /// Way-point graph, in the GeoJSON format of Nav2's route server: drive along its lanes.
    #[arg(long, value_name = "FILE")]
    pub graph: Option<PathBuf>,
    /// If a goal is blocked, stop at the nearest reachable point, at most this far away, m [default when given: 1]
    #[arg(long, value_name = "M", num_args = 0..=1, require_equals = true, default_missing_value = "1", value_parser = NumberArg(NumberText::from_zero("m")), allow_negative_numbers = true)]
    pub near: Option<f64>,
    /// Print the curve's polynomials and its active constraints.
    #[arg(long)]
    pub coefficients: bool,
    /// The robot's settings.
    #[command(flatten)]
    pub robot: RobotArgs,
    /// Folder for the results; the previous run in it is renamed to DIR.1
    #[arg(long, value_name = "DIR", default_value = "out/plan")]
    pub out: OutputDirArg,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}
