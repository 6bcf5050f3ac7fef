//! Whether the robot could stand at a goal, by the present map.

use super::refusal::CommandRefusal;
use trundle_collision::RoundedHull;
use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid, Pose2};

/// Centimetres of a metre.
const CM_PER_M: f64 = 100.0;

/// Checks that no occupied cell is inside the outline at a goal. Unknown floor is no reason: the robot observes it when it comes near.
///
/// # Errors
/// When a cell is occupied there.
pub fn require_free(grid: &OccupancyGrid, hull: &RoundedHull, goal: Pose2) -> Result<(), CommandRefusal> {
    let geometry = grid.geometry();
    let base_from_map = goal.inverse();
    let occupied =
        cells_about(geometry, goal, hull.outer_radius()).filter(|cell| grid.get(*cell) == Cell::Occupied);
    let depths = occupied.map(|cell| -hull.signed_distance(base_from_map.transform(geometry.center(cell))));
    let depth_cm = CM_PER_M * depths.fold(0.0, f64::max);
    if depth_cm > 0.0 {
        return Err(CommandRefusal::of(format!(
            "An obstacle reaches {depth_cm:.0} cm into the robot's outline at this goal: choose a place farther away."
        )));
    }
    Ok(())
}

/// The cells of a square about a goal.
fn cells_about(geometry: &GridGeometry, goal: Pose2, reach: f64) -> impl Iterator<Item = CellIndex> + use<> {
    let index = |at: f64, origin: f64| ((at - origin) / geometry.resolution).floor().max(0.0) as usize;
    let end = |at: f64, origin: f64, cells: usize| index(at, origin).saturating_add(1).min(cells);
    let origin = geometry.origin;
    let rows = index(goal.y - reach, origin.y)..end(goal.y + reach, origin.y, geometry.height);
    let cols = index(goal.x - reach, origin.x)..end(goal.x + reach, origin.x, geometry.width);
    rows.flat_map(move |row| cols.clone().map(move |col| CellIndex { col, row }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Footprint;

    #[test]
    fn a_goal_in_a_wall_is_refused_and_one_beside_it_is_not() {
        let art = [&".".repeat(40)[..]; 20].join("\n") + "\n" + &"#".repeat(40);
        let grid = OccupancyGrid::from_ascii(0.05, &art).unwrap();
        let hull = RoundedHull::exact(&Footprint::KOBUKI);
        let at = |y: f64| require_free(&grid, &hull, Pose2::new(1.0, y, 0.0));
        assert!(at(0.5).is_ok());
        assert!(at(0.1).unwrap_err().text.contains("An obstacle reaches 10 cm"), "{:?}", at(0.1));
        for far in [1e5, -1e5, f64::NAN] {
            assert!(at(far).is_ok(), "no map there");
        }
    }
}
