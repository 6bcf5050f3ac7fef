//! Places of the known floor for the search of a station's light.
//!
//! A station shines into a sector of +-60 deg and 3 m, which contains a disc of 1.3 m radius. Light is therefore found if every free place
//! has a searched place within 1.3 m and in sight.

use trundle_core::{Cell, CellIndex, Hypotenuse, OccupancyGrid, Pose2, Vector2};

/// Radius around a searched place that counts as searched \[m\]. Source: the largest disc in the sector of a station's light.
const SEARCHED_RADIUS_M: f64 = 1.3;
/// Distance between candidates \[m\]. Source: ours.
const CANDIDATE_STEP_M: f64 = 0.25;
/// Clearance of a candidate from all cells that are not free \[m\]. Source: ours, a Kobuki and 0.1 m.
const CLEARANCE_M: f64 = 0.28;

/// Searched places.
#[derive(Debug, Clone, Default)]
pub(crate) struct LightSearch {
    searched: Vec<Vector2>,
    place: Option<Vector2>,
}

impl LightSearch {
    /// Marks a place where the robot turned without detecting light.
    pub(crate) fn mark_searched(&mut self, at: Vector2) {
        self.searched.push(at);
    }

    /// Ends the drive to the present place; an unreachable place counts as searched.
    pub(crate) fn end_place(&mut self, has_failed: bool) {
        let place = self.place.take();
        self.searched.extend(place.filter(|_| has_failed));
    }

    /// The nearest free unsearched place, with the heading of the drive to this place. `None` if all places are searched.
    pub(crate) fn next_place(&mut self, grid: &OccupancyGrid, from: Pose2) -> Option<Pose2> {
        let here = from.position();
        let distance = |at: &Vector2| (at - here).norm();
        let place = candidates(grid)
            .filter(|at| self.searched.iter().all(|old| !is_searched_from(grid, *old, *at)))
            .filter(|at| is_clear(grid, *at))
            .min_by(|a, b| distance(a).total_cmp(&distance(b)));
        self.place = place;
        let offset = place? - here;
        place.map(|at| Pose2::new(at.x, at.y, offset.y.atan2(offset.x)))
    }
}

/// Free places on a raster.
fn candidates(grid: &OccupancyGrid) -> impl Iterator<Item = Vector2> + '_ {
    let geometry = *grid.geometry();
    let step = ((CANDIDATE_STEP_M / geometry.resolution).round() as usize).max(1);
    let rows = (0..geometry.height).step_by(step);
    rows.flat_map(move |row| (0..geometry.width).step_by(step).map(move |col| CellIndex { col, row }))
        .filter(|cell| grid.get(*cell) == Cell::Free)
        .map(move |cell| geometry.center(cell))
}

fn is_searched_from(grid: &OccupancyGrid, searched: Vector2, at: Vector2) -> bool {
    (at - searched).norm() <= SEARCHED_RADIUS_M && is_in_sight(grid, searched, at)
}

/// Whether no occupied cell is between two points.
fn is_in_sight(grid: &OccupancyGrid, from: Vector2, to: Vector2) -> bool {
    let (offset, step) = (to - from, grid.geometry().resolution);
    let count = (offset.norm() / step).ceil().max(1.0);
    (0..=count as usize).all(|i| grid.at(from + offset * (i as f64 / count)) != Cell::Occupied)
}

/// Whether all cells around a point are free.
fn is_clear(grid: &OccupancyGrid, at: Vector2) -> bool {
    let step = grid.geometry().resolution;
    let reach = (CLEARANCE_M / step).ceil() as i32;
    let offsets = || (-reach..=reach).map(|i| f64::from(i) * step);
    offsets().all(|x| {
        offsets().all(|y| x.hypotenuse(y) > CLEARANCE_M || grid.at(at + Vector2::new(x, y)) == Cell::Free)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two rooms of 3 x 3 m side by side, with or without a door.
    fn rooms(has_door: bool) -> OccupancyGrid {
        let row =
            |door: bool| format!("#{}{}{}#\n", ".".repeat(30), if door { "." } else { "#" }, ".".repeat(30));
        let rows = (0..30).map(|i| row(has_door && (12..20).contains(&i)));
        let wall = "#".repeat(63) + "\n";
        let text: String = [wall.clone()].into_iter().chain(rows).chain([wall]).collect();
        OccupancyGrid::from_ascii(0.1, &text).unwrap()
    }

    #[test]
    fn every_free_place_gets_a_searched_one_near_by_and_in_sight() {
        for grid in [rooms(true), rooms(false)] {
            let (mut search, mut pose, mut count) = (LightSearch::default(), Pose2::new(1.0, 1.0, 0.0), 0);
            search.mark_searched(pose.position());
            while let Some(place) = search.next_place(&grid, pose) {
                assert!(is_clear(&grid, place.position()), "{place:?}");
                search.end_place(false);
                search.mark_searched(place.position());
                (pose, count) = (place, count + 1);
                assert!(count < 30, "it comes to an end");
            }
            let is_covered = |at: &Vector2| search.searched.iter().any(|s| is_searched_from(&grid, *s, *at));
            assert!(candidates(&grid).filter(|at| is_clear(&grid, *at)).all(|at| is_covered(&at)));
            assert!(count >= 3, "{count}");
        }
    }

    #[test]
    fn a_place_that_cannot_be_reached_is_not_asked_for_again() {
        let (grid, pose) = (rooms(true), Pose2::new(1.0, 1.0, 0.0));
        let mut search = LightSearch::default();
        let first = search.next_place(&grid, pose).unwrap();
        search.end_place(true);
        let second = search.next_place(&grid, pose).unwrap();
        assert!(first.distance(&second) > SEARCHED_RADIUS_M);
    }
}
