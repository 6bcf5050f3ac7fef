//! The camera's field of view on the floor, and the part of a path that the camera does not observe in time.

use super::known_floor::{cells_about, is_in_sight};
use super::visibility_constraint::VisibilityConstraint;
use crate::{config::RobotConfig, range_source::RangeSource};
use std::collections::HashSet;
use trundle_core::{Cell, CellIndex, Invalid, OccupancyGrid, Pose2, TrajectoryPoint, Vector2, Vector3};
use trundle_mapping::DepthScanner;

/// The camera's field of view on the floor: a sector.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CameraFov {
    /// Position and direction of the sector in the base frame.
    pub(crate) base_from_sector: Pose2,
    /// Half the angle of the field of view, rad.
    pub(crate) half_angle: f64,
    /// Minimum distance of visible floor, m.
    pub(crate) nearest: f64,
}

/// Angle at the edge of the image that does not count as seen \[rad\]. Source: ours.
const IMAGE_EDGE_RAD: f64 = 0.1;
/// Distance at the edge of the blind zone that does not count as seen \[m\]. Source: ours.
const BLIND_EDGE_M: f64 = 0.1;
/// Range beyond which the floor does not count as seen \[m\]. Source: ours.
const MAX_SEEN_RANGE_M: f64 = 3.0;
/// Distance between two poses of a path at which the view is checked \[m\]. Source: ours.
const PATH_STEP_M: f64 = 0.05;
/// Turn between two poses of a path at which the view is checked \[rad\]. Source: ours.
const PATH_STEP_RAD: f64 = 0.1;
/// Area of unseen floor under the footprint that is accepted \[m^2\]: scans leave slivers. Source: ours.
const MAX_UNSEEN_AREA_M2: f64 = 0.02;
/// Radius around the start pose within which unseen floor is accepted \[m\]: the robot starts in its own blind zone. Source: ours.
const START_RADIUS_M: f64 = 0.8;

impl CameraFov {
    /// The field of view of the robot's camera. None for a laser, whose blind range is negligible, and for a lens that is too narrow.
    pub(crate) fn of(config: &RobotConfig) -> Result<Option<Self>, Invalid> {
        let base_from_camera = config.mount.validated()?.base_from_camera();
        let scanner = DepthScanner::new(config.camera, base_from_camera, config.scan.clone())?;
        let half_angle = (config.camera.width() as f64 / 2.0 / config.camera.fx()).atan() - IMAGE_EDGE_RAD;
        let (at, axis) = (base_from_camera.translation, base_from_camera.rotate(Vector3::z()));
        let base_from_sector = Pose2::new(at.x, at.y, axis.y.atan2(axis.x));
        let view = Self { base_from_sector, half_angle, nearest: scanner.blind_range() + BLIND_EDGE_M };
        Ok((config.sight == RangeSource::DepthCamera && half_angle > 0.0).then_some(view))
    }

    /// The first place of the path at which the disc of `radius` covers unseen floor. Unseen floor is unknown and not observed from an
    /// earlier pose, or was observed without result.
    pub(crate) fn first_unseen(
        self,
        way: &[TrajectoryPoint],
        grid: &OccupancyGrid,
        radius: f64,
        unseen: &VisibilityConstraint,
    ) -> Option<Vector2> {
        let mut passed: Vec<Pose2> = Vec::new();
        let mut judged = HashSet::new();
        let least = MAX_UNSEEN_AREA_M2 / grid.geometry().resolution.powi(2);
        for pose in way.iter().map(|point| point.pose) {
            if passed.last().is_some_and(|last| is_near(*last, pose)) {
                continue;
            }
            let under = unknown_about(grid, pose.position(), radius, unseen.home);
            let under: Vec<_> = under.filter(|cell| !judged.contains(cell)).collect();
            if under.len() as f64 >= least {
                let middle = middle(grid, &under);
                let is_shown = || passed.iter().any(|from| self.shows(grid, *from, middle));
                if unseen.was_observed(middle) || !is_shown() {
                    return Some(middle);
                }
                judged.extend(under);
            }
            passed.push(pose);
        }
        None
    }

    /// Whether a point is in the camera's view from base pose `from`, without an occupied cell in between.
    pub(crate) fn shows(self, grid: &OccupancyGrid, from: Pose2, at: Vector2) -> bool {
        let sector = from * self.base_from_sector;
        let to = sector.inverse().transform(at);
        (self.nearest..MAX_SEEN_RANGE_M).contains(&to.norm())
            && to.y.atan2(to.x).abs() < self.half_angle
            && is_in_sight(grid, sector.position(), at, 0.0)
    }
}

/// The unknown cells within `radius` of a point, without those around the start pose.
pub(crate) fn unknown_about(
    grid: &OccupancyGrid,
    at: Vector2,
    radius: f64,
    home: Option<Vector2>,
) -> impl Iterator<Item = CellIndex> {
    let is_off = move |cell: CellIndex| {
        home.is_none_or(|home| (grid.geometry().center(cell) - home).norm() > START_RADIUS_M)
    };
    cells_about(grid, at, radius).filter(move |cell| grid.get(*cell) == Cell::Unknown && is_off(*cell))
}

/// The cell nearest to the mean of these cells.
fn middle(grid: &OccupancyGrid, cells: &[CellIndex]) -> Vector2 {
    let centers = || cells.iter().map(|cell| grid.geometry().center(*cell));
    let mean = centers().sum::<Vector2>() / cells.len().max(1) as f64;
    centers().min_by(|a, b| (a - mean).norm().total_cmp(&(b - mean).norm())).unwrap_or(mean)
}

fn is_near(a: Pose2, b: Pose2) -> bool {
    let step = a.inverse() * b;
    step.position().norm() < PATH_STEP_M && step.theta.abs() < PATH_STEP_RAD
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::behaviour::navigator::testing::floor;
    use trundle_core::{Stamp, Trajectory, Twist2};

    const VIEW: CameraFov = CameraFov { base_from_sector: Pose2::IDENTITY, half_angle: 0.5, nearest: 0.6 };

    fn way(poses: impl Iterator<Item = Pose2>) -> Trajectory {
        let point =
            |(i, pose): (usize, Pose2)| TrajectoryPoint { time: 0.1 * i as f64, pose, twist: Twist2::ZERO };
        Trajectory::new(poses.enumerate().map(point).collect()).unwrap()
    }

    #[test]
    fn floor_ahead_is_seen_before_it_is_driven_on() {
        let ahead = floor(|at| at.x > 4.0);
        let straight = way((0..60).map(|i| Pose2::new(2.0 + 0.05 * f64::from(i), 2.0, 0.0)));
        let mut in_vain = VisibilityConstraint::default();
        in_vain.record_observation(Vector2::new(4.1, 2.0), Vector2::new(3.0, 2.0), Stamp::default());
        assert!(VIEW.first_unseen(straight.points(), &ahead, 0.2, &in_vain).is_some());
        assert_eq!(VIEW.first_unseen(straight.points(), &ahead, 0.2, &VisibilityConstraint::default()), None);
    }

    #[test]
    fn floor_around_a_tight_bend_is_not() {
        let beside = floor(|at| at.y > 2.3);
        // Along the edge of the known floor, then a turn on the spot, then ahead.
        let along = (0..8).map(|i| Pose2::new(3.6 + 0.05 * f64::from(i), 2.0, 0.0));
        let turn = || (0..16).map(|i| Pose2::new(3.95, 2.0, 0.1 * f64::from(i)));
        let on = || (0..20).map(|i| Pose2::new(3.95, 2.0 + 0.05 * f64::from(i), 1.57));
        let bend = way(along.chain(turn()).chain(on()));
        let at = VIEW.first_unseen(bend.points(), &beside, 0.2, &VisibilityConstraint::default()).unwrap();
        assert!((at - Vector2::new(3.95, 2.35)).norm() < 0.1, "{at}");
        assert_eq!(beside.at(at), Cell::Unknown);
        // The robot starts at this place, on floor that its camera cannot observe.
        let mut set_down = VisibilityConstraint::default();
        set_down.home = Some(at);
        assert_eq!(VIEW.first_unseen(bend.points(), &beside, 0.2, &set_down), None);
        // The same over known floor, and over a sliver of unknown floor.
        for grid in [floor(|_| false), floor(|at| (at.y - 2.4).abs() < 0.03 && at.x < 3.9)] {
            assert_eq!(
                VIEW.first_unseen(
                    way(turn().chain(on())).points(),
                    &grid,
                    0.2,
                    &VisibilityConstraint::default()
                ),
                None
            );
        }
    }
}
