//! `trundle map crop`, `rotate`, `diff`, `merge` and `rooms`: tools for finished maps.

use crate::common_args::{Common, NumberArg, NumberText, PoseArg, choice};
use crate::outcome::Outcome;
use crate::output_args::OutputDirArg;
use crate::{console, logging};
use clap::{Args, Subcommand};
use std::path::PathBuf;
use trundle::app::AppError;
use trundle::app::map_edit::{
    BoxArg, CropExtent, DiffPose, DiffRequest, EditedMap, MergeRequest, RoomsRequest, RotationTarget,
    crop_map, diff_maps, divide_map, merge_maps, rotate_map,
};
use trundle::io::OutputFolder;
use trundle::mapping::map_edit::RoomLimits;

/// Tools for finished maps.
#[derive(Debug, Subcommand)]
pub enum MapTool {
    /// Cut a part out of a map.
    Crop(CropArgs),
    /// Turn a map about the origin of its frame: its walls along the axes, or by an angle.
    Rotate(RotateArgs),
    /// Compare two maps cell by cell.
    Diff(DiffArgs),
    /// Join maps of one place; newer ones replace older ones.
    Merge(MergeArgs),
    /// Divide a map into rooms.
    Rooms(RoomsArgs),
}

/// The result of a tool.
#[derive(Debug, Args)]
pub struct ResultArgs {
    /// Folder for the results; the previous run in it is renamed to DIR.1
    #[arg(long, value_name = "DIR")]
    pub out: OutputDirArg,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}

/// `trundle map crop`
#[derive(Debug, Args)]
#[command(after_help = "Example: trundle map crop out/map/map.yaml --to=-2,0,6.5,8 --out out/part\n\n\
    The frame of the map does not change: poses, zones and places stay valid.")]
pub struct CropArgs {
    /// The map, in map_server's format.
    pub map: PathBuf,
    /// The part: a box of the map frame, m. Cells that it touches remain.
    #[arg(long, value_name = "X0,Y0,X1,Y1", allow_hyphen_values = true, required_unless_present = "known")]
    pub to: Option<BoxArg>,
    /// The part: the smallest box with all known cells.
    #[arg(long, conflicts_with = "to")]
    pub known: bool,
    /// The results.
    #[command(flatten)]
    pub result: ResultArgs,
}

/// `trundle map rotate`
#[derive(Debug, Args)]
#[command(after_help = "Example: trundle map rotate out/map/map.yaml --to walls --out out/upright\n\n\
    The map is resampled once: walls keep their thickness and stay closed. summary.json has the turn.")]
pub struct RotateArgs {
    /// The map, in map_server's format.
    pub map: PathBuf,
    /// The direction of the walls, found in the map.
    #[arg(long, value_name = "WHAT", required_unless_present = "by", value_parser = choice(&RotationTarget::CHOICES))]
    pub to: Option<RotationTarget>,
    /// The turn, counter-clockwise, deg.
    #[arg(long, value_name = "DEG", conflicts_with = "to", value_parser = NumberArg(NumberText::any("deg")), allow_negative_numbers = true)]
    pub by: Option<f64>,
    /// Zones and places of the map, GeoJSON, to be turned with it.
    #[arg(long, value_name = "FILE")]
    pub zones: Option<PathBuf>,
    /// The results.
    #[command(flatten)]
    pub result: ResultArgs,
}

/// `trundle map diff`
#[derive(Debug, Args)]
#[command(
    after_help = "Example: trundle map diff monday/map.yaml friday/map.yaml --within 0.1 --out out/diff\n\n\
    Maps of another origin or cell size are laid onto the cells of A. diff.png shows the cells, summary.json counts them."
)]
pub struct DiffArgs {
    /// The first map, in map_server's format.
    pub a: PathBuf,
    /// The second map.
    pub b: PathBuf,
    /// Pose of the frame of B in the frame of A: m, m, deg.
    #[arg(long, value_name = "X,Y,DEG", allow_hyphen_values = true, default_value = "0,0,0")]
    pub at: PoseArg,
    /// Find the pose of B in A by matching the maps.
    #[arg(long, conflicts_with = "at")]
    pub align: bool,
    /// Occupied cells agree if their centres are at most this far apart, m.
    #[arg(long, value_name = "M", default_value_t = 0.0, value_parser = NumberArg(NumberText::from_zero("m")), allow_negative_numbers = true)]
    pub within: f64,
    /// The results.
    #[command(flatten)]
    pub result: ResultArgs,
}

/// `trundle map merge`
#[derive(Debug, Args)]
#[command(after_help = "Example: trundle map merge monday/map.yaml friday/map.yaml --out out/both\n\n\
    The frame is that of the first map. A map that fits nowhere, or at two poses, is refused; give its pose with --poses.\n\
    A later map replaces an earlier one where it is known.")]
pub struct MergeArgs {
    /// The maps, in map_server's format, the oldest first.
    #[arg(required = true, num_args = 2.., value_name = "MAP")]
    pub maps: Vec<PathBuf>,
    /// Pose of the frame of the next map in the frame of the first one, once for each further map: m, m, deg [default: found by matching]
    #[arg(long, value_name = "X,Y,DEG", allow_hyphen_values = true)]
    pub poses: Vec<PoseArg>,
    /// The results.
    #[command(flatten)]
    pub result: ResultArgs,
}

/// `trundle map rooms`
#[derive(Debug, Args)]
#[command(
    after_help = "Example: trundle map rooms out/map/map.yaml --places places.toml --out out/rooms\n\n\
    Writes rooms.geojson (polygons with name and area_m2), zones.geojson (rooms as areas and places), rooms.png and summary.json."
)]
pub struct RoomsArgs {
    /// The map, in map_server's format.
    pub map: PathBuf,
    /// Named places, which name the rooms they lie in: TOML, one table per place with x, y, heading_deg, or GeoJSON.
    #[arg(long, value_name = "FILE")]
    pub places: Option<PathBuf>,
    /// Width up to which an opening divides rooms, m.
    #[arg(long, value_name = "M", default_value_t = RoomLimits::default().max_door_m, value_parser = NumberArg(NumberText::above_zero("m")), allow_negative_numbers = true)]
    pub door: f64,
    /// Smallest area of a room, m2.
    #[arg(long, value_name = "M2", default_value_t = RoomLimits::default().min_area_m2, value_parser = NumberArg(NumberText::above_zero("m2")), allow_negative_numbers = true)]
    pub min_area: f64,
    /// Length up to which an obstacle that stands free is furniture, not a wall, m.
    #[arg(long, value_name = "M", default_value_t = RoomLimits::default().max_furniture_m, value_parser = NumberArg(NumberText::from_zero("m")), allow_negative_numbers = true)]
    pub furniture: f64,
    /// The results.
    #[command(flatten)]
    pub result: ResultArgs,
}

/// Runs a tool, writes its folder and prints its table.
pub fn run(tool: &MapTool) -> Result<Outcome, AppError> {
    match tool {
        MapTool::Crop(args) => written(&args.result, |folder| {
            crop_map(&args.map, args.to.map_or(CropExtent::Known, CropExtent::Box), folder)
        }),
        MapTool::Rotate(args) => written(&args.result, |folder| {
            rotate_map(&args.map, args.zones.as_deref(), args.by.into(), folder)
        }),
        MapTool::Diff(args) => written(&args.result, |folder| {
            let pose = if args.align { DiffPose::Search } else { DiffPose::At(args.at.0) };
            let (first, second) = (args.a.clone(), args.b.clone());
            diff_maps(&DiffRequest { first, second, pose, within: args.within }, folder)
        }),
        MapTool::Merge(args) => written(&args.result, |folder| {
            let poses = args.poses.iter().map(|pose| pose.0).collect();
            merge_maps(&MergeRequest { maps: args.maps.clone(), poses }, folder)
        }),
        MapTool::Rooms(args) => written(&args.result, |folder| {
            let request = RoomsRequest::new(&args.map, args.places.as_deref());
            divide_map(&request.with_limits(args.door, args.min_area, args.furniture), folder)
        }),
    }
}

/// Makes the folder of a tool and prints its table.
fn written(
    result: &ResultArgs,
    work: impl FnOnce(OutputFolder) -> Result<EditedMap, AppError>,
) -> Result<Outcome, AppError> {
    let edited = work(logging::output_folder(&result.out)?)?;
    console::print_result(result.common.quiet, &edited.rows, &edited.picture);
    Ok(Outcome::Reached)
}
