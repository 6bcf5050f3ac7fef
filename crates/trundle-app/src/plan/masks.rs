//! Keep-out mask, speed mask and way-point graph of a plan, read from their files.

use crate::{AppError, MapExtent};
use std::path::Path;
use trundle_core::{Cell, GridGeometry, OccupancyGrid, Vector2};
use trundle_io::{degrees_hint, read_graph, read_keep_out_mask, read_speed_mask};
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

/// The way-point graph of a file, of which a node lies on the map.
pub fn read_lanes(path: &Path, map: &GridGeometry) -> Result<WaypointGraph, AppError> {
    let file = read_graph(path)?;
    if !file.left.is_empty() {
        let kinds: Vec<String> = file.left.iter().map(|(kind, count)| format!("{kind} ({count})")).collect();
        let (count, kinds) = (file.left.values().sum::<usize>(), kinds.join(", "));
        tracing::warn!(
            "{}: {count} features are not nodes or lanes and are not used: {kinds}",
            path.display()
        );
    }
    require_node_on(path, map, &file.nodes)?;
    WaypointGraph::one_way(file.nodes, file.lanes)
        .map_err(|error| AppError::Input(format!("{}: {error}", path.display())))
}

/// Refuses a graph without a node on the map: such a graph belongs to another map or another frame, or its units are others.
fn require_node_on(path: &Path, map: &GridGeometry, nodes: &[Vector2]) -> Result<(), AppError> {
    let (map, points) = (MapExtent::of(map), nodes.iter().map(|node| [node.x, node.y]).collect::<Vec<_>>());
    if points.iter().any(|point| map.contains(point)) {
        return Ok(());
    }
    let cause = degrees_hint(&points).unwrap_or_else(|| "is it the graph of this map?".to_owned());
    let [x, y] = points.first().copied().unwrap_or_default();
    Err(AppError::Input(format!(
        "{}: no node lies on the map, the first is at ({x}, {y}) m, the map has {map}: {cause}",
        path.display()
    )))
}

/// Refuses a mask without overlap with the map: such a mask belongs to another map or another frame.
fn require_overlap(path: &Path, mask: &GridGeometry, map: &GridGeometry) -> Result<(), AppError> {
    let (mask, map) = (MapExtent::of(mask), MapExtent::of(map));
    if mask.overlaps(&map) {
        return Ok(());
    }
    let path = path.display();
    Err(AppError::Input(format!("{path}: the mask lies beside the map: {mask}, the map has {map}")))
}
