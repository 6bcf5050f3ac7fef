//! Views of the map as Nav2's costmaps: the forbidden space of the robot's body, for display.

use trundle_core::{Cell, GridGeometry, OccupancyGrid, Pose2, Vector2};
use trundle_grid::{DistanceField, UnknownIs};

/// Distance from the body within which a cell has a cost \[m\]. Source: Nav2's default `inflation_radius`, 0.55 m.
const INFLATION_M: f64 = 0.55;
/// Decay of the cost with the distance from the body \[1/m\]. Source: Nav2's default `cost_scaling_factor`.
const DECAY_PER_M: f64 = 3.0;
/// Side of the local view \[m\]. Source: Nav2's default.
pub const LOCAL_SIDE_M: f64 = 3.0;
/// Cost of an occupied cell. Source: Nav2's `Costmap2DPublisher`.
const LETHAL_COST: i8 = 100;
/// Cost of a cell on which the middle of the robot would touch an obstacle. Source: Nav2's `Costmap2DPublisher`.
const INSCRIBED_COST: i8 = 99;

/// Costs of all cells, row by row from the lowest y: 100 occupied, 99 within the body's radius, decreasing outside, -1 unknown. `radius` is
/// the radius of the largest disc inside the body \[m\].
#[must_use]
pub fn costs(grid: &OccupancyGrid, radius: f64) -> Vec<i8> {
    let field =
        DistanceField::up_to(radius + INFLATION_M + grid.geometry().resolution, grid, UnknownIs::Free);
    let cost = |(i, cell): (usize, &Cell)| match cell {
        Cell::Occupied => LETHAL_COST,
        _ => match (field.at_linear(i) - radius, cell) {
            (beyond, _) if beyond <= 0.0 => INSCRIBED_COST,
            (_, Cell::Unknown) => -1,
            (beyond, _) if beyond > INFLATION_M => 0,
            (beyond, _) => (f64::from(INSCRIBED_COST - 1) * (-DECAY_PER_M * beyond).exp()).round() as i8,
        },
    };
    grid.cells().iter().enumerate().map(cost).collect()
}

/// The part of the costs around the robot: its geometry, and its cells.
#[must_use]
pub fn local(geometry: &GridGeometry, costs: &[i8], robot: &Pose2) -> Option<(GridGeometry, Vec<i8>)> {
    let half = LOCAL_SIDE_M / 2.0;
    let index = |value: f64, origin: f64, count: usize| {
        (((value - origin) / geometry.resolution).floor().max(0.0) as usize).min(count)
    };
    let (left, right) = (
        index(robot.x - half, geometry.origin.x, geometry.width),
        index(robot.x + half, geometry.origin.x, geometry.width),
    );
    let (low, high) = (
        index(robot.y - half, geometry.origin.y, geometry.height),
        index(robot.y + half, geometry.origin.y, geometry.height),
    );
    let corner = geometry.origin + Vector2::new(left as f64, low as f64) * geometry.resolution;
    let part =
        GridGeometry::new(geometry.resolution, corner, right.checked_sub(left)?, high.checked_sub(low)?)
            .ok()?;
    let row =
        |row: usize| costs.get(row * geometry.width + left..row * geometry.width + right).unwrap_or_default();
    Some((part, (low..high).flat_map(row).copied().collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn costs_fall_with_the_distance_from_obstacles() {
        let grid = OccupancyGrid::from_ascii(0.1, "#...........").unwrap();
        let costs = costs(&grid, 0.2);
        assert_eq!(costs[..2], [LETHAL_COST, INSCRIBED_COST]);
        assert!(costs.windows(2).all(|pair| pair[0] >= pair[1]), "{costs:?}");
        assert_eq!(*costs.last().unwrap(), 0);
        let (part, cells) = local(grid.geometry(), &costs, &Pose2::new(1.2, 0.0, 0.0)).unwrap();
        assert_eq!((part.width, part.height, cells.len()), (12, 1, 12));
        assert_eq!(local(grid.geometry(), &costs, &Pose2::new(50.0, 0.0, 0.0)), None);
    }
}
