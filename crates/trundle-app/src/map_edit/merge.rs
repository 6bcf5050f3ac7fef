//! `trundle map merge`: several maps of one place as one map.

use super::alignment::AlignedMap;
use super::input::{read_picture, read_upright, refused};
use super::output::{EditedMap, row, size_row, write_edited};
use crate::AppError;
use serde::Serialize;
use std::path::{Path, PathBuf};
use trundle_core::Pose2;
use trundle_io::{OutputFolder, Summary};
use trundle_mapping::map_edit::{MergeCounts, merged};

/// Maps to be merged.
#[derive(Debug, Clone, PartialEq)]
pub struct MergeRequest {
    /// The maps, the oldest first. The frame of the first one remains.
    pub maps: Vec<PathBuf>,
    /// Poses of the frames of the further maps in the first one's; empty for a search.
    pub poses: Vec<Pose2>,
}

/// A merged map in `summary.json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct MergedMap {
    file: String,
    x_m: f64,
    y_m: f64,
    heading_deg: f64,
    agreeing_share: Option<f64>,
    agreeing_m: Option<f64>,
    contradicting_m: Option<f64>,
    second_best_share: Option<f64>,
    second_best_m: Option<f64>,
    added_cells: usize,
    shared_cells: usize,
    freed_cells: usize,
    newly_occupied_cells: usize,
}

impl MergedMap {
    fn new(file: &Path, aligned: &AlignedMap, counts: MergeCounts) -> Self {
        let AlignedMap { other_from_map: pose, fit, rival } = aligned;
        Self {
            file: file.display().to_string(),
            x_m: pose.x,
            y_m: pose.y,
            heading_deg: pose.theta.to_degrees(),
            agreeing_share: fit.map(|fit| fit.agreeing_share()),
            agreeing_m: fit.map(|fit| fit.agreeing_m),
            contradicting_m: fit.map(|fit| fit.contradicting_m),
            second_best_share: rival.map(|rival| rival.agreeing_share()),
            second_best_m: rival.map(|rival| rival.agreeing_m),
            added_cells: counts.added,
            shared_cells: counts.shared,
            freed_cells: counts.freed,
            newly_occupied_cells: counts.occupied,
        }
    }
}

/// Merges maps in the frame of the first one, and writes the folder. Each map is matched with all maps before it.
///
/// # Errors
/// When a map cannot be read, the number of poses is wrong, a map does not fit or fits at several poses, or a file cannot be written.
pub fn merge_maps(request: &MergeRequest, folder: OutputFolder) -> Result<EditedMap, AppError> {
    let MergeRequest { maps, poses } = request;
    let (Some(first_file), further) = (maps.first(), maps.len().saturating_sub(1)) else {
        return Err(AppError::input("no map, expected two or more"));
    };
    if !poses.is_empty() && poses.len() != further {
        let problem =
            format!("{} poses for {further} maps after the first one, expected one for each", poses.len());
        return Err(AppError::Input(problem));
    }
    let mut grid = read_upright(first_file)?;
    let (mut rows, mut merges) = (Vec::new(), Vec::new());
    for (i, file) in maps.iter().enumerate().skip(1) {
        let map = read_picture(file)?;
        let aligned = match poses.get(i - 1) {
            Some(pose) => AlignedMap::given(&grid, &map, *pose),
            None => AlignedMap::found((first_file, &grid), (file, &map))?,
        };
        let pose = aligned.other_from_map * map.map_from_grid;
        let (joined, counts) = merged(&grid, &map.grid, pose).map_err(refused(file))?;
        grid = joined;
        rows.push(row(&file.display().to_string(), ""));
        rows.extend(aligned.rows().into_iter().map(|line| vec![format!("  {}", line[0]), line[1].clone()]));
        rows.push(row("  cells added, freed, newly occupied", counts_text(counts)));
        merges.push(MergedMap::new(file, &aligned, counts));
    }
    rows.push(size_row(&grid));
    let mut summary = Summary::new("map merge");
    summary.set("maps", merges);
    write_edited(&grid, &mut summary, rows, folder)
}

fn counts_text(counts: MergeCounts) -> String {
    format!("{}, {}, {}", counts.added, counts.freed, counts.occupied)
}
