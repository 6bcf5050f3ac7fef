//! Ways that show the camera what they lead onto before the robot is too near to see it.

use super::{Navigator, Surroundings};
use crate::{config::RobotConfig, sight::Sight};
use std::collections::HashSet;
use trundle_core::{Cell, CellIndex, Invalid, OccupancyGrid, Pose2, Trajectory, Twist2, Vector2, Vector3};
use trundle_mapping::DepthScanner;
use trundle_planning::{Plan, PlanResult};

/// What a camera sees of the floor: a sector.
#[derive(Debug, Clone, Copy)]
pub(super) struct View {
    /// Where it stands on the base and looks to.
    base_from_sector: Pose2,
    /// Half its angle, rad.
    half_angle: f64,
    /// Where it begins, m.
    nearest: f64,
}

/// The edge of the image, rad, and of the blind zone, m, do not count as seen.
const RIM: (f64, f64) = (0.1, 0.1);
/// Things farther off are not seen well, m.
const FARTHEST: f64 = 3.0;
/// The way is looked at where it has gone on so far, m and rad.
const STEP: (f64, f64) = (0.05, 0.1);
/// So much unseen floor under the robot counts, m^2: scans leave slivers.
const SLIVER: f64 = 0.02;
/// Where it was switched on the robot stands in what it cannot see, m about the map's origin.
const HOME: f64 = 0.8;
/// What a way must not lead onto is walled off so far about, m, and so many times a plan.
const WALL: f64 = 0.3;
const MOST_WALLS: usize = 3;
/// A way that shows all may take so many times as long as the best, and so many seconds more.
const WORTH: (f64, f64) = (1.5, 10.0);

impl View {
    /// That of the robot's camera; none for a laser, which has no blind zone to speak of, and for a lens too narrow to look by.
    pub(super) fn of(config: &RobotConfig) -> Result<Option<Self>, Invalid> {
        let base_from_camera = config.mount.validated()?.base_from_camera();
        let scanner = DepthScanner::new(config.camera, base_from_camera, config.scan.clone())?;
        let half_angle = (config.camera.width() as f64 / 2.0 / config.camera.fx()).atan() - RIM.0;
        let (at, axis) = (base_from_camera.translation, base_from_camera.rotate(Vector3::z()));
        let base_from_sector = Pose2::new(at.x, at.y, axis.y.atan2(axis.x));
        let view = Self { base_from_sector, half_angle, nearest: scanner.blind_range() + RIM.1 };
        Ok((config.sight == Sight::DepthCamera && half_angle > 0.0).then_some(view))
    }

    /// Where the way first leads the disc of `radius` onto floor that was never seen and is not seen on the way either.
    fn first_unseen(self, way: &Trajectory, grid: &OccupancyGrid, radius: f64) -> Option<Vector2> {
        let mut passed: Vec<Pose2> = Vec::new();
        let mut judged = HashSet::new();
        let least = SLIVER / grid.geometry().resolution.powi(2);
        for pose in way.points().iter().map(|point| point.pose) {
            if passed.last().is_some_and(|last| is_near(*last, pose)) {
                continue;
            }
            let under: Vec<_> =
                unknown_under(grid, pose.position(), radius).filter(|cell| !judged.contains(cell)).collect();
            if under.len() as f64 >= least {
                let middle = under.iter().map(|cell| grid.geometry().center(*cell)).sum::<Vector2>()
                    / under.len() as f64;
                if !passed.iter().any(|from| self.shows(grid, *from, middle)) {
                    return Some(middle);
                }
                judged.extend(under);
            }
            passed.push(pose);
        }
        None
    }

    /// Whether the camera at `from` looks at a point, and nothing on the map stands between.
    fn shows(self, grid: &OccupancyGrid, from: Pose2, at: Vector2) -> bool {
        let sector = from * self.base_from_sector;
        let to = sector.inverse().transform(at);
        (self.nearest..FARTHEST).contains(&to.norm())
            && to.y.atan2(to.x).abs() < self.half_angle
            && is_clear(grid, sector.position(), at)
    }
}

impl Navigator {
    /// A plan that shows the camera what it leads onto, where there is one that is worth it; else the best plan there is.
    pub(super) fn plan_in_view(
        &mut self,
        s: &Surroundings<'_>,
        (from, twist): (Pose2, Twist2),
        goal: Pose2,
    ) -> Plan {
        let best = self.planner.plan_among(s.floor(), s.traffic.movers, from, twist, goal);
        let Plan::Found(first) = &best else { return best };
        let Some(mut unseen) = self.unseen_on(&first.trajectory, s.floor()) else { return best };
        let mut floor = s.floor().clone();
        for _ in 0..MOST_WALLS {
            wall_off(&mut floor, unseen, [from, goal].map(|pose| pose.position()), self.radius);
            let Plan::Found(plan) = self.planner.plan_among(&floor, s.traffic.movers, from, twist, goal)
            else {
                return best;
            };
            match self.unseen_on(&plan.trajectory, s.floor()) {
                Some(next) => unseen = next,
                None if is_worth(&plan, first, &floor) => return Plan::Found(plan),
                None => return best,
            }
        }
        best
    }

    /// Where a way leads onto what the camera will not have seen.
    pub(super) fn unseen_on(&self, way: &Trajectory, floor: &OccupancyGrid) -> Option<Vector2> {
        self.view?.first_unseen(way, floor, self.radius)
    }
}

/// Whether a way takes hardly longer than the best, goes on from where the robot is as smoothly, and stays on the map.
fn is_worth(plan: &PlanResult, best: &PlanResult, floor: &OccupancyGrid) -> bool {
    let stays =
        plan.trajectory.points().iter().all(|p| floor.geometry().cell_at(p.pose.position()).is_some());
    stays
        && (plan.is_continuous || !best.is_continuous)
        && plan.trajectory.duration() < WORTH.0 * best.trajectory.duration() + WORTH.1
}

fn is_near(a: Pose2, b: Pose2) -> bool {
    let step = a.inverse() * b;
    step.position().norm() < STEP.0 && step.theta.abs() < STEP.1
}

/// The cells within `radius` of a point that nothing is known of.
fn unknown_under(grid: &OccupancyGrid, at: Vector2, radius: f64) -> impl Iterator<Item = CellIndex> {
    let unknown = |cell: &CellIndex| grid.get(*cell) == Cell::Unknown;
    cells_about(grid, at, radius).filter(unknown).filter(|cell| grid.geometry().center(*cell).norm() > HOME)
}

/// The cells whose centres lie within `radius` of a point.
fn cells_about(grid: &OccupancyGrid, at: Vector2, radius: f64) -> impl Iterator<Item = CellIndex> {
    let geometry = *grid.geometry();
    let reach = (radius / geometry.resolution).ceil() as usize;
    let middle = geometry.cell_at(at);
    let around = move |at: usize, size: usize| at.saturating_sub(reach)..(at + reach + 1).min(size);
    middle
        .into_iter()
        .flat_map(move |CellIndex { col, row }| {
            around(row, geometry.height)
                .flat_map(move |row| around(col, geometry.width).map(move |col| CellIndex { col, row }))
        })
        .filter(move |cell| (geometry.center(*cell) - at).norm() < radius)
}

/// No way leads over the unknown cells about a point, but for those under the ends of the way.
fn wall_off(floor: &mut OccupancyGrid, at: Vector2, ends: [Vector2; 2], radius: f64) {
    let geometry = *floor.geometry();
    let is_off_the_ends = |cell: &CellIndex| {
        ends.iter().all(|end| (geometry.center(*cell) - end).norm() > radius + geometry.resolution)
    };
    let cells: Vec<_> = unknown_under(floor, at, WALL).filter(is_off_the_ends).collect();
    for cell in cells {
        floor.set(cell, Cell::Occupied);
    }
}

fn is_clear(grid: &OccupancyGrid, from: Vector2, to: Vector2) -> bool {
    let (way, step) = (to - from, grid.geometry().resolution / 2.0);
    let count = (way.norm() / step) as usize;
    let mut points = (0..count).map(|i| from + way * (i as f64 / count as f64));
    !points.any(|point| grid.at(point) == Cell::Occupied)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::navigator::Traffic;
    use trundle_core::{PoseEstimate, Stamp, TrajectoryPoint};

    const VIEW: View = View { base_from_sector: Pose2::IDENTITY, half_angle: 0.5, nearest: 0.6 };

    /// Known floor, 6 x 4 m about (3, 2), with unknown floor where `hidden` says so.
    fn floor(hidden: impl Fn(Vector2) -> bool) -> OccupancyGrid {
        let mut grid = OccupancyGrid::from_ascii(0.05, &vec![".".repeat(120); 80].join("\n")).unwrap();
        let geometry = *grid.geometry();
        for k in 0..geometry.len() {
            let cell = geometry.cell(k);
            if hidden(geometry.center(cell)) {
                grid.set(cell, Cell::Unknown);
            }
        }
        grid
    }

    fn way(poses: impl Iterator<Item = Pose2>) -> Trajectory {
        let point =
            |(i, pose): (usize, Pose2)| TrajectoryPoint { time: 0.1 * i as f64, pose, twist: Twist2::ZERO };
        Trajectory::new(poses.enumerate().map(point).collect()).unwrap()
    }

    #[test]
    fn what_lies_ahead_is_seen_before_it_is_driven_on() {
        let ahead = floor(|at| at.x > 4.0);
        let straight = way((0..60).map(|i| Pose2::new(2.0 + 0.05 * f64::from(i), 2.0, 0.0)));
        assert_eq!(VIEW.first_unseen(&straight, &ahead, 0.2), None);
    }

    #[test]
    fn what_lies_round_a_tight_bend_is_not() {
        let beside = floor(|at| at.y > 2.3);
        // Along the edge of what is known, then a turn on the spot, and on.
        let along = (0..8).map(|i| Pose2::new(3.6 + 0.05 * f64::from(i), 2.0, 0.0));
        let turn = (0..16).map(|i| Pose2::new(3.95, 2.0, 0.1 * f64::from(i)));
        let on = (0..20).map(|i| Pose2::new(3.95, 2.0 + 0.05 * f64::from(i), 1.57));
        let at = VIEW.first_unseen(&way(along.chain(turn).chain(on)), &beside, 0.2).unwrap();
        assert!((at - Vector2::new(3.95, 2.35)).norm() < 0.1, "{at}");
        // The same over known floor, and over a sliver of unknown floor.
        for grid in [floor(|_| false), floor(|at| (at.y - 2.4).abs() < 0.03 && at.x < 3.9)] {
            let turn = (0..16).map(|i| Pose2::new(3.95, 2.0, 0.1 * f64::from(i)));
            let on = (0..20).map(|i| Pose2::new(3.95, 2.0 + 0.05 * f64::from(i), 1.57));
            assert_eq!(VIEW.first_unseen(&way(turn.chain(on)), &grid, 0.2), None);
        }
    }

    #[test]
    fn walls_are_put_on_the_unknown_alone() {
        let mut grid = floor(|at| at.y > 2.3);
        wall_off(&mut grid, Vector2::new(4.0, 2.4), [Vector2::new(3.9, 2.6), Vector2::zeros()], 0.1);
        assert_eq!(grid.at(Vector2::new(3.9, 2.6)), Cell::Unknown, "an end of the way");
        assert_eq!(grid.at(Vector2::new(4.0, 2.45)), Cell::Occupied);
        assert_eq!(grid.at(Vector2::new(4.0, 2.2)), Cell::Free);
        assert_eq!(grid.at(Vector2::new(5.0, 2.4)), Cell::Unknown);
    }

    /// A robot beside a bed whose far side was never seen, and a goal behind it.
    fn beside_a_bed() -> OccupancyGrid {
        let mut grid = floor(|at| (1.5..4.0).contains(&at.x) && (1.2..2.0).contains(&at.y));
        let geometry = *grid.geometry();
        for k in 0..geometry.len() {
            let at = geometry.center(geometry.cell(k));
            let is_side = (at.x - 4.025).abs() < 0.03 && (1.6..2.0).contains(&at.y);
            if is_side || (1.5..4.0).contains(&at.x) && (at.y - 2.025).abs() < 0.03 {
                grid.set(geometry.cell(k), Cell::Occupied);
            }
        }
        grid
    }

    fn navigator() -> Navigator {
        let config = RobotConfig::default();
        let footprint = config.footprint().unwrap();
        Navigator::new(&config, &footprint).unwrap()
    }

    #[test]
    fn a_way_is_taken_that_shows_what_it_leads_onto_or_else_the_best() {
        let (grid, mut navigator) = (beside_a_bed(), navigator());
        let (from, goal) = (Pose2::new(4.45, 1.75, -1.57), Pose2::new(2.75, 0.7, 3.1));
        let now = Stamp::default();
        let covariance = nalgebra::Matrix3::from_diagonal_element(1e-6);
        let s = Surroundings {
            now,
            estimate: PoseEstimate { stamp: now, pose: from, twist: Twist2::ZERO, covariance },
            grid: &grid,
            scan: None,
            seen: None,
            unplaced: 0.0,
            traffic: Traffic::default(),
        };
        let found = |plan: Plan| match plan {
            Plan::Found(plan) => plan.trajectory,
            other => panic!("{other:?}"),
        };
        let best = found(navigator.planner.plan(&grid, from, Twist2::ZERO, goal));
        assert!(navigator.unseen_on(&best, &grid).is_some(), "the best way cuts the unseen corner");
        let shown = found(navigator.plan_in_view(&s, (from, Twist2::ZERO), goal));
        assert_eq!(navigator.unseen_on(&shown, &grid), None);
        assert!(shown.duration() < WORTH.0 * best.duration() + WORTH.1);
        navigator.view = None;
        assert_eq!(found(navigator.plan_in_view(&s, (from, Twist2::ZERO), goal)), best);
    }
}
