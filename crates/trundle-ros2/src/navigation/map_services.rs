//! Services of the map: get, save, and the clearing of costmaps.

use super::active_goal::ActiveGoal;
use crate::Ros2Error;
use crate::convert::grid;
use crate::generated::nav_msgs::{GetMap, GetMapResponse};
use crate::generated::nav2_msgs::{
    ClearCostmapAroundRobot, ClearCostmapAroundRobotResponse, ClearCostmapExceptRegion,
    ClearCostmapExceptRegionResponse, ClearEntireCostmap, ClearEntireCostmapResponse, LoadMap,
    LoadMapResponse, SaveMap, SaveMapRequest, SaveMapResponse,
};
use crate::node::{Diagnostics, RosNode};
use crate::outputs::FrameNames;
use std::path::Path;
use trundle_io::{MapImage, map_picture, map_yaml, replace_file};

/// Offers `map_server/map`, `map_saver/save_map`, `map_server/load_map` and the clearing of both costmaps.
///
/// # Errors
/// When a service cannot be made.
pub fn offer(node: &mut RosNode, active: &ActiveGoal, frames: &FrameNames) -> Result<(), Ros2Error> {
    let (map, frame) = (active.clone(), frames.map.clone());
    node.serve::<GetMap>("map_server/map", move |_| GetMapResponse {
        map: newest(&map).map(|(view, at)| grid::to_ros(&view.grid, at, &frame)).unwrap_or_default(),
    })?;
    let (map, diagnostics) = (active.clone(), node.diagnostics());
    node.serve::<SaveMap>("map_saver/save_map", move |request| {
        let saved = save(&request, &map);
        saved.as_ref().err().into_iter().for_each(|why| diagnostics.warn("map_saver/save_map", why));
        SaveMapResponse { result: saved.is_ok() }
    })?;
    let diagnostics = node.diagnostics();
    node.serve::<LoadMap>("map_server/load_map", move |_| refuse_load(&diagnostics))?;
    for costmap in ["global_costmap", "local_costmap"] {
        // The costs follow the map at each second: there is nothing to clear.
        let clear = |service: &str| format!("{costmap}/{service}_{costmap}");
        node.serve::<ClearEntireCostmap>(&clear("clear_entirely"), |_| {
            ClearEntireCostmapResponse::default()
        })?;
        node.serve::<ClearCostmapAroundRobot>(&clear("clear_around"), |_| {
            ClearCostmapAroundRobotResponse::default()
        })?;
        node.serve::<ClearCostmapExceptRegion>(&clear("clear_except"), |_| {
            ClearCostmapExceptRegionResponse::default()
        })?;
    }
    Ok(())
}

/// The newest map, and its time on the ROS clock.
fn newest(
    active: &ActiveGoal,
) -> Option<(std::sync::Arc<trundle_app::operator::MapView>, trundle_core::Stamp)> {
    let view = active.view()?;
    let at = active.clock().to_ros(view.stamp);
    Some((view.map.clone()?, at))
}

/// Writes the map to `map_url.yaml` and its picture beside it.
fn save(request: &SaveMapRequest, active: &ActiveGoal) -> Result<(), String> {
    let url = Path::new(request.map_url.trim_start_matches("file://"));
    let name = url.file_name().and_then(|name| name.to_str());
    let name =
        name.ok_or_else(|| format!("map_url is '{}', expected a path without extension", request.map_url))?;
    let image = match request.image_format.as_str() {
        "" | "pgm" => MapImage::Pgm,
        "png" => MapImage::Png,
        other => return Err(format!("image_format is '{other}', expected pgm or png")),
    };
    if !["", "trinary"].contains(&request.map_mode.as_str()) {
        return Err(format!("map_mode is '{}', expected trinary", request.map_mode));
    }
    let (map, _) = newest(active).ok_or("there is no map yet")?;
    let (file, bytes) = map_picture(name, &map.grid, image).map_err(|error| error.to_string())?;
    replace_file(&url.with_file_name(&file), &bytes).map_err(|error| error.to_string())?;
    let yaml = map_yaml(&map.grid, &file);
    replace_file(&url.with_file_name(format!("{name}.yaml")), yaml.as_bytes())
        .map_err(|error| error.to_string())
}

fn refuse_load(diagnostics: &Diagnostics) -> LoadMapResponse {
    let message = "the map of a running robot cannot be replaced: start trundle with --resume CHECKPOINT";
    diagnostics.warn("map_server/load_map", message);
    LoadMapResponse { result: LoadMapResponse::RESULT_UNDEFINED_FAILURE, ..LoadMapResponse::default() }
}
