//! The picture of the rooms of a map.

use std::collections::BTreeSet;
use trundle_core::{CellIndex, OccupancyGrid, Vector2};
use trundle_mapping::map_edit::MapRooms;
use trundle_viz::{Color, MapPicture};

/// Colours of rooms; neighbours differ.
const ROOM_COLORS: [Color; 6] =
    [Color::SKY, Color::ORANGE, Color::GREEN, Color::YELLOW, Color::PURPLE, Color::BLUE];
/// Opacity of a room, of 255. Source: ours.
const ROOM_ALPHA: u8 = 120;

/// The rooms in colours, with their numbers. An 8-bit RGB PNG.
pub(super) fn rooms_picture(grid: &OccupancyGrid, found: &MapRooms, names: &[String]) -> Vec<u8> {
    let colors = colors(found);
    let mut picture = MapPicture::over(grid);
    for (i, color) in ROOM_COLORS.iter().enumerate() {
        let geometry = *found.geometry();
        let share = |cell: CellIndex| {
            let is_of_color = found.room_of(cell).is_some_and(|room| colors[room] == i);
            if is_of_color { 1.0 } else { 0.0 }
        };
        let shares = (0..geometry.len()).map(|cell| share(geometry.cell(cell))).collect();
        picture = picture.tint(&label(names, &colors, i), geometry, shares, color.alpha(ROOM_ALPHA));
    }
    let numbers: Vec<(String, Vector2)> =
        found.rooms().iter().enumerate().map(|(i, room)| ((i + 1).to_string(), room.center)).collect();
    picture.badges("number of the room", &numbers, Color::BLACK).to_png()
}

/// The rooms of a colour, for the legend.
fn label(names: &[String], colors: &[usize], color: usize) -> String {
    let of_color = names.iter().enumerate().filter(|(i, _)| colors[*i] == color);
    let entry = |(i, name): (usize, &String)| {
        let number = i + 1;
        if *name == format!("room {number}") { name.clone() } else { format!("{number} {name}") }
    };
    of_color.map(entry).collect::<Vec<_>>().join(", ")
}

/// The colour of each room, other than those of its neighbours as far as the colours suffice.
fn colors(found: &MapRooms) -> Vec<usize> {
    let neighbours = neighbours(found);
    let mut colors: Vec<usize> = Vec::new();
    for room in 0..found.rooms().len() {
        let taken: BTreeSet<usize> = colors
            .iter()
            .enumerate()
            .filter(|(i, _)| neighbours.contains(&(*i, room)))
            .map(|(_, c)| *c)
            .collect();
        let wanted = (0..ROOM_COLORS.len()).map(|step| (room + step) % ROOM_COLORS.len());
        colors.push(wanted.clone().find(|color| !taken.contains(color)).unwrap_or(room % ROOM_COLORS.len()));
    }
    colors
}

/// Cells across a wall within which rooms count as neighbours. Source: ours, 30 cm at 5 cm.
const NEIGHBOUR_CELLS: usize = 6;

/// Pairs of rooms beside each other, the lower index first.
fn neighbours(found: &MapRooms) -> BTreeSet<(usize, usize)> {
    let geometry = found.geometry();
    let mut pairs = BTreeSet::new();
    for i in 0..geometry.len() {
        let cell = geometry.cell(i);
        let Some(room) = found.room_of(cell) else { continue };
        let right = CellIndex { col: cell.col + NEIGHBOUR_CELLS, ..cell };
        let up = CellIndex { row: cell.row + NEIGHBOUR_CELLS, ..cell };
        for near in [right, up] {
            let is_inside = near.col < geometry.width && near.row < geometry.height;
            let other = is_inside.then(|| found.room_of(near)).flatten().filter(|other| *other != room);
            pairs.extend(other.map(|other| (room.min(other), room.max(other))));
        }
    }
    pairs
}
