//! Viewpoints: poses from which the robot observes a blocked path or unknown floor.

use crate::behaviour::path_planner::camera_fov::CameraFov;
use crate::behaviour::path_planner::known_floor::is_in_sight;
use crate::behaviour::path_planner::visibility_constraint::VisibilityConstraint;
use std::f64::consts::TAU;
use trundle_core::{Cell, OccupancyGrid, Pose2, Stamp, Trajectory, Vector2, difference_of_angles};

/// The path to a viewpoint.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) enum Viewpoint {
    /// No viewpoint was searched since the last plan.
    #[default]
    Unknown,
    /// Candidate viewpoints without a plan so far, the best one last.
    Choosing(ViewTarget, Vec<Pose2>),
    /// The robot drives to the viewpoint.
    Going(ViewTarget, Trajectory),
    /// The robot is at the viewpoint and observes until this time.
    Looking(Stamp),
    /// Finished: at the viewpoint, or without any viewpoint.
    Settled,
}

/// Target of an observation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ViewTarget {
    /// The obstacle that blocks the path.
    Blockage,
    /// Floor that has not been observed.
    UnknownFloor,
}

/// Distances from the target at which viewpoints are sought \[m\]. Source: ours.
const VIEWPOINT_DISTANCES_M: [f64; 2] = [1.2, 0.9];
/// Number of bearings at which viewpoints are sought. Source: ours.
const VIEWPOINT_BEARINGS: usize = 16;
/// Number of viewpoints, the nearest first, to which a path is planned, one per step. Source: ours.
const MAX_VIEWPOINT_PLANS: usize = 4;
/// These poses by decreasing distance: the nearest is last and tried first.
pub(crate) fn best_last(mut places: Vec<Pose2>) -> Vec<Pose2> {
    places.truncate(MAX_VIEWPOINT_PLANS);
    places.reverse();
    places
}

/// Places on the map's free floor with a clear line of sight to `at`, nearest to `here` first. Occupied cells on the last `own_size` m do
/// not block the line.
pub(crate) fn free_viewpoints(
    grid: &OccupancyGrid,
    here: Pose2,
    at: Vector2,
    own_size: f64,
    view: Option<CameraFov>,
) -> Vec<Pose2> {
    let around = (0..VIEWPOINT_BEARINGS).map(|i| TAU * i as f64 / VIEWPOINT_BEARINGS as f64);
    let around = around.flat_map(|bearing| {
        VIEWPOINT_DISTANCES_M.map(|away| at - away * Vector2::new(bearing.cos(), bearing.sin()))
    });
    let stands =
        around.filter(|stand| grid.at(*stand) == Cell::Free && is_in_sight(grid, *stand, at, own_size));
    let mut places: Vec<Pose2> = stands.map(|stand| facing(stand, at, view)).collect();
    places.sort_by(|a, b| a.distance(&here).total_cmp(&b.distance(&here)));
    places
}

/// Viewpoints from which the camera observes the floor at `at`, without those of earlier observations. The present place comes first if a
/// turn is enough; then the nearest places.
pub(crate) fn new_viewpoints(
    grid: &OccupancyGrid,
    here: Pose2,
    at: Vector2,
    view: Option<CameraFov>,
    unseen: &VisibilityConstraint,
) -> Vec<Pose2> {
    let Some(view) = view else { return Vec::new() };
    let turned = facing(here.position(), at, Some(view));
    let all = std::iter::once(turned).chain(free_viewpoints(grid, here, at, 0.0, Some(view)));
    let is_new = |place: &Pose2| unseen.is_elsewhere(at, place.position());
    all.filter(is_new).filter(|place| view.shows(grid, *place, at)).collect()
}

/// The pose at `stand` with `at` in the middle of the view.
pub(crate) fn facing(stand: Vector2, at: Vector2, view: Option<CameraFov>) -> Pose2 {
    let way = at - stand;
    let aside = view.map_or(0.0, |view| view.base_from_sector.theta);
    Pose2::new(stand.x, stand.y, difference_of_angles(way.y.atan2(way.x), aside))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn viewpoints_see_the_blockage_and_are_off_the_path() {
        // A wall with a door that a person blocks.
        let rows = [".".repeat(40), "#".repeat(18) + "####" + &"#".repeat(18), ".".repeat(40)];
        let text =
            [vec![rows[0].clone(); 10], vec![rows[1].clone()], vec![rows[2].clone(); 30]].concat().join("\n");
        let grid = OccupancyGrid::from_ascii(0.1, &text).unwrap();
        let (here, at) = (Pose2::new(2.0, 2.6, 1.5), Vector2::new(2.0, 2.7));
        let places = free_viewpoints(&grid, here, at, 0.0, None);
        assert!(!places.is_empty());
        for place in &places {
            let way = at - place.position();
            assert!(way.norm() > 0.8 && place.y < 2.9, "{place:?}");
            assert!((way.y.atan2(way.x) - place.theta).sin().abs() < 1e-9);
        }
        assert!(places[0].distance(&here) <= places[places.len() - 1].distance(&here));
    }

    #[test]
    fn the_nearest_places_are_kept_and_the_nearest_of_all_is_asked_for_first() {
        let all: Vec<Pose2> = (0..9).map(|i| Pose2::new(f64::from(i), 0.0, 0.0)).collect();
        let mut kept = best_last(all.clone());
        let asked: Vec<Pose2> = std::iter::from_fn(|| kept.pop()).collect();
        assert_eq!(asked, all[..MAX_VIEWPOINT_PLANS]);
    }

    #[test]
    fn a_sight_shows_the_floor_to_the_camera_wherever_it_looks_and_is_none_of_the_old_ones() {
        use crate::behaviour::navigator::testing::floor;
        let (grid, here) = (floor(|at| at.x > 4.0), Pose2::new(3.0, 2.0, 0.0));
        let at = Vector2::new(4.5, 2.0);
        for aside in [0.0, 1.0, -2.5] {
            let base_from_sector = Pose2::new(0.05, 0.0, aside);
            let view = CameraFov { base_from_sector, half_angle: 0.5, nearest: 0.6 };
            let mut unseen = VisibilityConstraint::default();
            let first = new_viewpoints(&grid, here, at, Some(view), &unseen);
            assert!(first.len() > 2 && first.iter().all(|place| view.shows(&grid, *place, at)), "{first:?}");
            assert_eq!(first[0].position(), here.position(), "a turn is enough");
            unseen.record_observation(at, here.position(), Stamp::default());
            let second = new_viewpoints(&grid, here, at, Some(view), &unseen);
            assert!(!second.is_empty() && second.len() < first.len());
            assert!(second.iter().all(|place| place.distance(&here) > 0.4), "{second:?}");
        }
        assert!(
            new_viewpoints(&grid, here, at, None, &VisibilityConstraint::default()).is_empty(),
            "a laser sees all"
        );
    }
}
