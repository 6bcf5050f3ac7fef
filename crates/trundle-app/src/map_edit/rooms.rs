//! `trundle map rooms`: the rooms of a map.

use super::input::{read_upright, refused};
use super::output::{EditedMap, write_pictured};
use super::room_zones::room_annotations;
use super::rooms_picture::rooms_picture;
use crate::AppError;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use trundle_core::{Pose2, Vector2};
use trundle_io::{NamedArea, OutputFolder, Summary, annotations_text, areas_text, read_places};
use trundle_mapping::map_edit::{MapRooms, Room, RoomLimits, map_rooms};

/// A map to be divided into rooms.
#[derive(Debug, Clone, PartialEq)]
pub struct RoomsRequest {
    /// The map.
    pub map: PathBuf,
    /// Named places, which name the rooms that they lie in.
    pub places: Option<PathBuf>,
    /// Sizes of rooms, doors and furniture.
    pub limits: RoomLimits,
}

impl RoomsRequest {
    /// The rooms of a map, with names of a file of places.
    #[must_use]
    pub fn new(map: &Path, places: Option<&Path>) -> Self {
        Self { map: map.to_owned(), places: places.map(Path::to_owned), limits: RoomLimits::default() }
    }

    /// The same request with other sizes of doors \[m\], rooms \[m^2\] and furniture \[m\].
    #[must_use]
    pub fn with_limits(self, max_door_m: f64, min_area_m2: f64, max_furniture_m: f64) -> Self {
        Self { limits: RoomLimits { max_door_m, min_area_m2, max_furniture_m }, ..self }
    }
}

/// Divides a map into rooms, and writes the folder: `rooms.geojson`, `zones.geojson`, `rooms.png` and `summary.json`.
///
/// # Errors
/// When a file cannot be read or written, a limit is out of range, or the map has no room.
pub fn divide_map(request: &RoomsRequest, folder: OutputFolder) -> Result<EditedMap, AppError> {
    let grid = read_upright(&request.map)?;
    let places = request.places.as_deref().map(read_places).transpose()?.unwrap_or_default();
    let found = map_rooms(&grid, request.limits).map_err(refused(&request.map))?;
    if found.rooms().is_empty() {
        let min = request.limits.min_area_m2;
        let problem =
            format!("no room: no connected free floor of {min} m2 or more; a smaller --min-area finds more");
        return Err(AppError::Input(format!("{}: {problem}", request.map.display())));
    }
    let names = names(&found, &places, request.places.as_deref());
    let areas: Vec<NamedArea> =
        names.iter().zip(found.rooms()).map(|(name, room)| area(name, room)).collect();
    folder.write("rooms.geojson", areas_text(&areas).as_bytes())?;
    let zones = room_annotations(found.rooms(), &names, &places);
    folder.write("zones.geojson", annotations_text(&zones).as_bytes())?;
    let total: f64 = found.rooms().iter().map(|room| room.area_m2).sum();
    let mut summary = Summary::new("map rooms");
    let list: Vec<_> = areas.iter().map(|area| (&area.name, area.area_m2)).collect();
    summary
        .set("success", true)
        .set("rooms", list)
        .set("room_count", areas.len())
        .set("area_m2", total)
        .set("max_door_m", request.limits.max_door_m)
        .set("min_area_m2", request.limits.min_area_m2);
    let numbered = areas.iter().enumerate();
    let rows = numbered
        .map(|(i, area)| vec![format!("{}", i + 1), area.name.clone(), format!("{:.1} m2", area.area_m2)]);
    write_pictured("rooms.png", &rooms_picture(&grid, &found, &names), &summary, rows.collect(), folder)
}

fn area(name: &str, room: &Room) -> NamedArea {
    NamedArea { name: name.to_owned(), area_m2: room.area_m2, rings: room.rings.clone() }
}

/// The names of the rooms: of the first place in each, else `room 1` and so on. Other places are warned of.
fn names(found: &MapRooms, places: &BTreeMap<String, Pose2>, file: Option<&Path>) -> Vec<String> {
    let mut names: Vec<Option<String>> = vec![None; found.rooms().len()];
    let file = file.map(|file| file.display().to_string()).unwrap_or_default();
    for (place, pose) in places {
        let at = Vector2::new(pose.x, pose.y);
        match found.room_at(at).map(|room| &mut names[room]) {
            Some(name @ None) => *name = Some(place.clone()),
            Some(Some(name)) => {
                tracing::warn!("{file}: '{place}' lies in the room that is called '{name}'");
            }
            None => tracing::warn!("{file}: '{place}' at ({}, {}) m lies in no room", at.x, at.y),
        }
    }
    let numbered = names.into_iter().enumerate();
    numbered.map(|(i, name)| name.unwrap_or_else(|| format!("room {}", i + 1))).collect()
}
