//! Services of the map: get, save, and the clearing of costmaps.

use super::active_goal::ActiveGoal;
use crate::Ros2Error;
use crate::convert::grid;
use crate::generated::nav_msgs::{GetMap, GetMapResponse, OccupancyGridMessage};
use crate::generated::nav2_msgs::{
    ClearCostmapAroundRobot, ClearCostmapAroundRobotResponse, ClearCostmapExceptRegion,
    ClearCostmapExceptRegionResponse, ClearEntireCostmap, ClearEntireCostmapResponse, LoadMap,
    LoadMapRequest, LoadMapResponse, SaveMap, SaveMapRequest, SaveMapResponse,
};
use crate::node::{Diagnostics, RosNode, arrives};
use crate::outputs::{FrameNames, PublishedMap};
use std::path::Path;
use std::sync::Arc;
use trundle_app::operator::MapView;
use trundle_core::{OccupancyGrid, Stamp};
use trundle_io::{MapDescription, MapImage, map_picture, map_yaml, read_map, replace_file};
use trundle_runtime::{OperatorCommand, RobotConfig, require_loadable};

/// Size above which a YAML file is no description of a map \[bytes\]: these have some 200. Source: ours.
const MAX_YAML_BYTES: u64 = 65_536;

/// Offers `map_server/map`, `map_saver/save_map`, `map_server/load_map` and the clearing of both costmaps.
///
/// # Errors
/// When a service cannot be created.
pub fn offer(
    node: &mut RosNode,
    robot: &ActiveGoal,
    published: &PublishedMap,
    frames: &FrameNames,
    config: &RobotConfig,
) -> Result<(), Ros2Error> {
    let (map, frame, diagnostics) = (published.clone(), frames.map.clone(), node.diagnostics());
    node.serve::<GetMap>("map_server/map", move |_| get(&map, &frame, &diagnostics))?;
    let (map, diagnostics) = (published.clone(), node.diagnostics());
    node.serve::<SaveMap>("map_saver/save_map", move |request| {
        let saved = save(&request, &map);
        saved.as_ref().err().into_iter().for_each(|why| diagnostics.warn("map_saver/save_map", why));
        SaveMapResponse { result: saved.is_ok() }
    })?;
    let (robot, map, frame, diagnostics) =
        (robot.clone(), published.clone(), frames.map.clone(), node.diagnostics());
    let config = config.clone();
    node.serve::<LoadMap>("map_server/load_map", move |request| {
        load(&request, &robot, &config, &map, &frame).unwrap_or_else(|(result, why)| {
            diagnostics.warn("map_server/load_map", why);
            LoadMapResponse { result, ..LoadMapResponse::default() }
        })
    })?;
    for costmap in ["global_costmap", "local_costmap"] {
        // The costs follow the map every second, so a clear has no effect.
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

/// The map of the topic, if it fits into a reply. Otherwise an empty map, whose frame is the name of the topic.
fn get(published: &PublishedMap, frame: &str, diagnostics: &Diagnostics) -> GetMapResponse {
    let map = published.newest().map(|(map, at)| grid::to_ros(&map.grid, at, frame)).unwrap_or_default();
    let had_none = map.data.is_empty();
    let map = fitting(map);
    if map.data.is_empty() && !had_none {
        diagnostics.warn("map_server/map", &*map.header.frame_id);
    }
    GetMapResponse { map }
}

/// Writes the map of the topic to `map_url.yaml`, with its picture in the same folder.
fn save(request: &SaveMapRequest, published: &PublishedMap) -> Result<(), String> {
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
    let (map, _) = published.newest().ok_or("no map has been published yet")?;
    let (file, bytes) = map_picture(name, &map.grid, image).map_err(|error| error.to_string())?;
    let (picture, yaml) = (url.with_file_name(&file), url.with_file_name(format!("{name}.yaml")));
    require_free_or_map(&yaml, &picture)?;
    replace_file(&picture, &bytes).map_err(|error| error.to_string())?;
    replace_file(&yaml, map_yaml(&map.grid, &file).as_bytes()).map_err(|error| error.to_string())
}

/// Refuses to replace a file that is no map: anybody on the network may name any path.
fn require_free_or_map(yaml: &Path, picture: &Path) -> Result<(), String> {
    let is_there = |path: &Path| path.symlink_metadata().is_ok();
    let refused = |path: &Path| {
        Err(format!(
            "{} is no map of this name and is not replaced: give map_url another name",
            path.display()
        ))
    };
    let Some(map) = is_there(yaml).then(|| described_map(yaml)) else {
        return if is_there(picture) { refused(picture) } else { Ok(()) };
    };
    match map {
        None => refused(yaml),
        Some(map) if is_there(picture) && map.picture_path() != picture => refused(picture),
        Some(_) => Ok(()),
    }
}

/// The description of a map in a file, if the file is one.
fn described_map(yaml: &Path) -> Option<MapDescription> {
    let is_small = std::fs::metadata(yaml).is_ok_and(|file| file.is_file() && file.len() <= MAX_YAML_BYTES);
    let text = is_small.then(|| std::fs::read_to_string(yaml).ok()).flatten()?;
    MapDescription::parse(yaml, text).ok()
}

/// Reason why a map is not loaded: Nav2's code and a sentence.
type LoadRefusal = (u8, String);

/// Replaces the robot's map by the map of a file. The other services have the new map immediately, the topic once the robot has it; the
/// reply contains the map if it fits.
fn load(
    request: &LoadMapRequest,
    robot: &ActiveGoal,
    config: &RobotConfig,
    published: &PublishedMap,
    frame: &str,
) -> Result<LoadMapResponse, LoadRefusal> {
    let at = published.newest().map_or_else(Stamp::default, |(_, at)| at);
    let grid = read_for(&request.map_url, config)?;
    let view = MapView { number: 0, revision: 0, grid: grid.clone() };
    let map = fitting(grid::to_ros(&grid, at, frame));
    robot
        .send(OperatorCommand::LoadMap(Box::new(grid)))
        .map_err(|error| (LoadMapResponse::RESULT_UNDEFINED_FAILURE, error.to_string()))?;
    published.set(Arc::new(view), at);
    Ok(LoadMapResponse { result: LoadMapResponse::RESULT_SUCCESS, map })
}

/// The map of a file, which a robot of this configuration takes.
fn read_for(map_url: &str, config: &RobotConfig) -> Result<OccupancyGrid, LoadRefusal> {
    let path = Path::new(map_url.trim_start_matches("file://"));
    if !path.exists() {
        return Err((
            LoadMapResponse::RESULT_MAP_DOES_NOT_EXIST,
            format!("there is no file {}", path.display()),
        ));
    }
    let grid =
        read_map(path).map_err(|error| (LoadMapResponse::RESULT_INVALID_MAP_DATA, error.to_string()))?;
    require_loadable(grid.geometry(), config)
        .map_err(|problem| (LoadMapResponse::RESULT_INVALID_MAP_METADATA, problem.to_string()))?;
    Ok(grid)
}

/// The map if it fits into a reply; else an empty one, whose frame is the name of the topic.
fn fitting(map: OccupancyGridMessage) -> OccupancyGridMessage {
    if arrives(&map) {
        return map;
    }
    let mut empty = OccupancyGridMessage::default();
    empty.header.frame_id = format!(
        "the map has {} cells, more than a reply has room for: read the topic map, which late subscribers receive too",
        map.data.len()
    );
    empty
}

#[cfg(test)]
mod tests {
    use super::*;

    fn published(text: &str) -> PublishedMap {
        let published = PublishedMap::default();
        let grid = OccupancyGrid::from_ascii(0.05, text).unwrap();
        published.set(Arc::new(MapView { number: 0, revision: 1, grid }), Stamp::default());
        published
    }

    #[test]
    fn the_saved_picture_is_the_published_map_and_before_it_nothing_is_saved() {
        let folder = std::env::temp_dir().join(format!("trundle-save-map-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let map_url = folder.join("saved").display().to_string();
        let request = SaveMapRequest { map_url, ..SaveMapRequest::default() };
        assert!(save(&request, &PublishedMap::default()).unwrap_err().contains("no map"));
        let own = published("#..\n#??\n###");
        save(&request, &own).unwrap();
        let saved = trundle_io::read_map(&folder.join("saved.yaml")).unwrap();
        assert_eq!(saved.cells(), own.newest().unwrap().0.grid.cells());
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_map_replaces_a_map_of_its_name_and_no_other_file() {
        let folder = std::env::temp_dir().join(format!("trundle-keep-files-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let own = published("#..\n#??\n###");
        let save = |name: &str, format: &str| {
            let map_url = folder.join(name).display().to_string();
            save(
                &SaveMapRequest { map_url, image_format: format.to_owned(), ..SaveMapRequest::default() },
                &own,
            )
        };
        save("room", "pgm").unwrap();
        save("room", "pgm").unwrap();
        save("room", "png").unwrap();
        let refused = |name: &str, format: &str, file: &str| {
            let before = std::fs::read(folder.join(file)).unwrap();
            let why = save(name, format).unwrap_err();
            assert!(why.contains(file) && why.contains("not replaced"), "{why}");
            assert_eq!(std::fs::read(folder.join(file)).unwrap(), before);
        };
        refused("room", "pgm", "room.pgm");
        std::fs::write(folder.join("robot.yaml"), "wheel_radius_m: 0.035\n").unwrap();
        refused("robot", "pgm", "robot.yaml");
        assert!(!folder.join("robot.pgm").exists(), "nothing is written beside it");
        std::fs::write(folder.join("photo.png"), "holidays").unwrap();
        refused("photo", "png", "photo.png");
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_map_that_no_reply_has_room_for_is_refused_with_the_name_of_the_topic() {
        let diagnostics = Diagnostics::default();
        assert_eq!(get(&published("#..\n#??"), "map", &diagnostics).map.data.len(), 6);
        let row = "#".repeat(60) + "\n";
        let large = get(&published(&row.repeat(60)), "map", &diagnostics);
        assert!(large.map.data.is_empty() && large.map.header.frame_id.contains("topic map"));
        assert!(diagnostics.summary().contains("map_server/map: the map has 3600 cells"));
    }

    #[test]
    fn a_map_is_loaded_where_its_cells_fit_the_robot() {
        let folder = std::env::temp_dir().join(format!("trundle-load-map-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let url = |name: &str| folder.join(name).display().to_string();
        let request = |map_url| SaveMapRequest { map_url, ..SaveMapRequest::default() };
        save(&request(url("room")), &published("#..\n#??\n###")).unwrap();
        let yaml = url("room.yaml");
        let grid = read_for(&format!("file://{yaml}"), &RobotConfig::default()).unwrap();
        assert_eq!(grid.cells(), published("#..\n#??\n###").newest().unwrap().0.grid.cells());
        let code = |url: &str, config: &RobotConfig| read_for(url, config).unwrap_err();
        let with = |change: fn(&mut RobotConfig)| {
            let mut config = RobotConfig::default();
            change(&mut config);
            config
        };
        let (missing, why) = code("/nowhere/map.yaml", &RobotConfig::default());
        assert_eq!(missing, LoadMapResponse::RESULT_MAP_DOES_NOT_EXIST);
        assert!(why.contains("/nowhere/map.yaml"));
        let (other, why) = code(&yaml, &with(|config| config.mapping.resolution = 0.1));
        assert_eq!(other, LoadMapResponse::RESULT_INVALID_MAP_METADATA);
        assert!(why.contains("resolution of the map is 0.05 m, expected 0.1"), "{why}");
        let (far, why) = code(&yaml, &with(|config| config.mapping.half_extent = 0.1));
        assert_eq!(far, LoadMapResponse::RESULT_INVALID_MAP_METADATA);
        assert!(why.contains("extent of the map"), "{why}");
        std::fs::write(&yaml, "image: [").unwrap();
        assert_eq!(code(&yaml, &RobotConfig::default()).0, LoadMapResponse::RESULT_INVALID_MAP_DATA);
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
