//! Ways that show the camera what they lead onto before the robot is too near to see it.

use super::{Navigator, Surroundings};
use crate::{config::RobotConfig, sight::Sight};
use std::collections::HashSet;
use trundle_core::{Cell, CellIndex, Invalid, OccupancyGrid, Pose2, Trajectory, Twist2, Vector2};
use trundle_mapping::DepthScanner;
use trundle_planning::Plan;

/// What a camera that looks ahead sees of the floor: a sector.
#[derive(Debug, Clone, Copy)]
pub(super) struct View {
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
const MOST_WALLS: usize = 4;

impl View {
    /// That of the robot's camera; none for a laser, which has no blind zone to speak of.
    pub(super) fn of(config: &RobotConfig) -> Result<Option<Self>, Invalid> {
        if config.sight == Sight::Laser {
            return Ok(None);
        }
        let base_from_camera = config.mount.validated()?.base_from_camera();
        let scanner = DepthScanner::new(config.camera, base_from_camera, config.scan.clone())?;
        let half_angle = (config.camera.width() as f64 / 2.0 / config.camera.fx()).atan() - RIM.0;
        Ok(Some(Self { half_angle, nearest: scanner.blind_range() + RIM.1 }))
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
        let to = from.inverse().transform(at);
        (self.nearest..FARTHEST).contains(&to.norm())
            && to.y.atan2(to.x).abs() < self.half_angle
            && is_clear(grid, from.position(), at)
    }
}

impl Navigator {
    /// A plan that shows the camera what it leads onto, where there is one; else the best plan there is.
    pub(super) fn plan_in_view(
        &mut self,
        s: &Surroundings<'_>,
        (from, twist): (Pose2, Twist2),
        goal: Pose2,
    ) -> Plan {
        let best = self.planner.plan_among(s.floor(), s.traffic.movers, from, twist, goal);
        let Some(mut unseen) = self.unseen_on(&best, s.floor()) else { return best };
        let mut floor = s.floor().clone();
        for _ in 0..MOST_WALLS {
            wall_off(&mut floor, unseen);
            let plan = self.planner.plan_among(&floor, s.traffic.movers, from, twist, goal);
            match (&plan, self.unseen_on(&plan, &floor)) {
                (Plan::Found(_), None) => return plan,
                (_, Some(next)) => unseen = next,
                (_, None) => break,
            }
        }
        best
    }

    fn unseen_on(&self, plan: &Plan, floor: &OccupancyGrid) -> Option<Vector2> {
        let Plan::Found(plan) = plan else { return None };
        self.view?.first_unseen(&plan.trajectory, floor, self.radius)
    }
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

/// No way leads over the unknown cells about a point.
fn wall_off(floor: &mut OccupancyGrid, at: Vector2) {
    let cells: Vec<_> = unknown_under(floor, at, WALL).collect();
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
    use trundle_core::TrajectoryPoint;

    const VIEW: View = View { half_angle: 0.5, nearest: 0.6 };

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
        wall_off(&mut grid, Vector2::new(4.0, 2.4));
        assert_eq!(grid.at(Vector2::new(4.0, 2.45)), Cell::Occupied);
        assert_eq!(grid.at(Vector2::new(4.0, 2.2)), Cell::Free);
        assert_eq!(grid.at(Vector2::new(5.0, 2.4)), Cell::Unknown);
    }
}
