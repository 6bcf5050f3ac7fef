//! Keep-out mask, speed mask and way-point graph of a plan, read from their files.

use crate::AppError;
use std::path::Path;
use trundle_core::{Cell, GridGeometry, OccupancyGrid};
use trundle_io::{read_graph, read_keep_out_mask, read_speed_mask};
use trundle_planning::{CostMask, Planner, SpeedMask, WaypointGraph};
use trundle_viz::MaskShares;

/// Number of cells of a speed mask that set a limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SpeedMaskLimits {
    /// Cells whose speed is not above 0, or above 100 %: they set no limit, as in Nav2.
    pub out_of_range: usize,
    /// All cells.
    pub cells: usize,
}

/// Gives the keep-out mask of a file to the planners; its shares, for pictures.
pub fn set_keep_out<'p>(
    path: &Path,
    grid: &OccupancyGrid,
    planners: impl Iterator<Item = &'p mut Planner>,
) -> Result<MaskShares, AppError> {
    let mask = read_keep_out_mask(path)?;
    let geometry = *mask.forbidden.geometry();
    require_overlap(path, &geometry, grid.geometry())?;
    let share = |(cell, cost): (&Cell, &u8)| match cell {
        Cell::Occupied => 1.0,
        _ => f32::from(*cost) / 100.0,
    };
    let shares = mask.forbidden.cells().iter().zip(&mask.costs).map(share).collect();
    let has_costs = mask.costs.iter().any(|value| *value > 0);
    let costs = has_costs.then(|| CostMask::new(geometry, mask.costs)).transpose()?;
    for planner in planners {
        planner.set_keep_out(Some(mask.forbidden.clone()));
        planner.set_cost_mask(costs.clone());
    }
    Ok(MaskShares { geometry, shares })
}

/// Gives the speed mask of a file to the planner; its shares, for pictures. `full`: the robot's highest speed, m/s.
pub fn set_speed_mask(
    path: &Path,
    full: f64,
    grid: &OccupancyGrid,
    planner: &mut Planner,
) -> Result<(MaskShares, SpeedMaskLimits), AppError> {
    let mask = read_speed_mask(path, full)?;
    require_overlap(path, &mask.geometry, grid.geometry())?;
    let limits = SpeedMaskLimits { out_of_range: mask.out_of_range, cells: mask.limits.len() };
    let share = |limit: &f32| (1.0 - limit / full as f32).clamp(0.0, 1.0);
    let shares = mask.limits.iter().map(share).collect();
    planner.set_speed_mask(Some(SpeedMask::new(mask.geometry, mask.limits)?));
    Ok((MaskShares { geometry: mask.geometry, shares }, limits))
}

/// The way-point graph of a file.
pub fn read_lanes(path: &Path) -> Result<WaypointGraph, AppError> {
    let file = read_graph(path)?;
    if !file.left.is_empty() {
        let kinds: Vec<String> = file.left.iter().map(|(kind, count)| format!("{kind} ({count})")).collect();
        let (count, kinds) = (file.left.values().sum::<usize>(), kinds.join(", "));
        tracing::warn!(
            "{}: {count} features are not nodes or lanes and are not used: {kinds}",
            path.display()
        );
    }
    WaypointGraph::one_way(file.nodes, file.lanes)
        .map_err(|error| AppError::Input(format!("{}: {error}", path.display())))
}

/// Refuses a mask without overlap with the map: such a mask belongs to another map or another frame.
fn require_overlap(path: &Path, mask: &GridGeometry, map: &GridGeometry) -> Result<(), AppError> {
    let span = |g: &GridGeometry, axis: usize, cells: usize| {
        (g.origin[axis], g.origin[axis] + cells as f64 * g.resolution)
    };
    let apart = |axis: usize, cells: (usize, usize)| {
        let ((a, b), (c, d)) = (span(mask, axis, cells.0), span(map, axis, cells.1));
        b <= c || d <= a
    };
    if apart(0, (mask.width, map.width)) || apart(1, (mask.height, map.height)) {
        let (x, y) = (span(mask, 0, mask.width), span(mask, 1, mask.height));
        let message = format!(
            "{}: the mask lies beside the map: x {:.2} to {:.2} m, y {:.2} to {:.2} m",
            path.display(),
            x.0,
            x.1,
            y.0,
            y.1
        );
        return Err(AppError::Input(message));
    }
    Ok(())
}
