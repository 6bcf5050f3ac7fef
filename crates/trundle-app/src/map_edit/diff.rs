//! `trundle map diff`: what differs between two maps.

use super::alignment::AlignedMap;
use super::diff_picture::diff_picture;
use super::input::{read_picture, read_upright, refused};
use super::output::{EditedMap, area, area_text, row, write_pictured};
use crate::AppError;
use std::path::PathBuf;
use trundle_core::{Cell, Pose2};
use trundle_io::{OutputFolder, Summary};
use trundle_mapping::map_edit::{CellPair, MapComparison};

/// Two maps to be compared.
#[derive(Debug, Clone, PartialEq)]
pub struct DiffRequest {
    /// The first map.
    pub first: PathBuf,
    /// The second map.
    pub second: PathBuf,
    /// Pose of the second map's frame in the first one's.
    pub pose: DiffPose,
    /// Largest distance of occupied cells that agree \[m\].
    pub within: f64,
}

/// The pose of the second map's frame in the first one's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DiffPose {
    /// This pose.
    At(Pose2),
    /// The pose at which the maps fit best.
    Search,
}

/// The kinds of cells: key of `summary.json`, words of the table, values.
const KINDS: [(&str, &str, CellPair); 9] = [
    ("occupied_in_both", "occupied in both", [Cell::Occupied, Cell::Occupied]),
    ("occupied_in_a_free_in_b", "occupied in A, free in B", [Cell::Occupied, Cell::Free]),
    ("occupied_in_a_unknown_in_b", "occupied in A, unknown in B", [Cell::Occupied, Cell::Unknown]),
    ("free_in_a_occupied_in_b", "free in A, occupied in B", [Cell::Free, Cell::Occupied]),
    ("unknown_in_a_occupied_in_b", "unknown in A, occupied in B", [Cell::Unknown, Cell::Occupied]),
    ("free_in_both", "free in both", [Cell::Free, Cell::Free]),
    ("free_in_a_unknown_in_b", "free in A, unknown in B", [Cell::Free, Cell::Unknown]),
    ("unknown_in_a_free_in_b", "unknown in A, free in B", [Cell::Unknown, Cell::Free]),
    ("unknown_in_both", "unknown in both", [Cell::Unknown, Cell::Unknown]),
];

/// Compares two maps on the cells of the first one, and writes the folder: `diff.png` and `summary.json`.
///
/// # Errors
/// When a map cannot be read, the maps do not fit one grid, or a file cannot be written.
pub fn diff_maps(request: &DiffRequest, folder: OutputFolder) -> Result<EditedMap, AppError> {
    let first = read_upright(&request.first)?;
    let second = read_picture(&request.second)?;
    let aligned = match request.pose {
        DiffPose::At(pose) => AlignedMap::given(&first, &second, pose),
        DiffPose::Search => AlignedMap::found((&request.first, &first), (&request.second, &second))?,
    };
    let pose = aligned.other_from_map * second.map_from_grid;
    let found =
        MapComparison::new(&first, &second.grid, pose, request.within).map_err(refused(&request.second))?;
    let mut rows = if request.pose == DiffPose::Search { aligned.rows() } else { Vec::new() };
    rows.extend(KINDS[..8].iter().map(|(_, words, pair)| {
        let cells = found.count(*pair);
        row(words, format!("{cells} cells, {}", area_text(cells, found.geometry())))
    }));
    write_pictured("diff.png", &diff_picture(&found), &summary(request, &aligned, &found), rows, folder)
}

fn summary(request: &DiffRequest, aligned: &AlignedMap, found: &MapComparison) -> Summary {
    let mut summary = Summary::new("map diff");
    let pose = aligned.other_from_map;
    summary
        .set("success", true)
        .set("resolution_m", found.geometry().resolution)
        .set("within_m", request.within)
        .set("b_x_m", pose.x)
        .set("b_y_m", pose.y)
        .set("b_heading_deg", pose.theta.to_degrees())
        .set("agreeing_share", aligned.fit.map(|fit| fit.agreeing_share()));
    let mut set = |key: &str, cells: usize| {
        summary.set(&format!("{key}_cells"), cells).set(&format!("{key}_m2"), area(cells, found.geometry()));
    };
    KINDS.iter().for_each(|(key, _, pair)| set(key, found.count(*pair)));
    let occupied = |pair: CellPair| found.count(pair);
    set("only_in_a", occupied(KINDS[1].2) + occupied(KINDS[2].2));
    set("only_in_b", occupied(KINDS[3].2) + occupied(KINDS[4].2));
    summary
}
