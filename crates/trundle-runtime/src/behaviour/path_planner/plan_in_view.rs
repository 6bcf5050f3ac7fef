//! Plans paths along which the camera observes the floor ahead in time.

use super::PathPlanner;
use super::camera_fov::unknown_about;
use super::visibility_constraint::{MAX_VIRTUAL_OBSTACLES, VIRTUAL_OBSTACLE_RADIUS_M};
use crate::behaviour::progress_checker::rest::length;
use crate::world_state::WorldState;
use trundle_core::{Cell, CellIndex, OccupancyGrid, Pose2, Trajectory, TrajectoryPoint, Twist2, Vector2};
use trundle_planning::{Obstruction, Plan, PlanResult};

/// Result of the search for a path within the camera's view.
#[derive(Debug)]
pub(crate) enum InView {
    /// A path to drive, or none.
    Plan(Plan),
    /// The best path enters unseen floor.
    Unseen(UnseenPath),
    /// Another query is needed in the next step.
    Asking,
}

/// A path that enters unseen floor.
#[derive(Debug)]
pub(crate) struct UnseenPath {
    /// Place at which the path enters unseen floor, map frame \[m\].
    pub(crate) at: Vector2,
    /// Length of the path, a turn as the way of a point on the robot's outline \[m\].
    pub(crate) length: f64,
    /// A longer path without unseen floor, if one was found.
    pub(crate) seen: Option<Box<PlanResult>>,
}

/// Largest duration of a path over seen floor alone, as a multiple of the fastest path's. Source: ours.
const MAX_SEEN_PATH_RATIO: f64 = 1.5;
/// Duration that is allowed in addition \[s\]. Source: ours.
const MAX_SEEN_PATH_EXTRA_S: f64 = 10.0;

impl PathPlanner {
    /// A plan along which the camera observes the floor ahead, if such a plan is not much longer. Uses two queries at most.
    pub(crate) fn plan_in_view(
        &mut self,
        s: &WorldState<'_>,
        (from, twist): (Pose2, Twist2),
        goal: Pose2,
    ) -> InView {
        self.visibility.note_seen(s.floor());
        self.visibility.forget(s.now);
        let ends = [from, goal].map(|pose| pose.position());
        let bars = self.visibility.bars();
        let best = {
            let floor = self.with_virtual_obstacles(s.permitted_floor(), &bars, ends);
            let floor = floor.as_ref().unwrap_or(s.permitted_floor());
            self.planner.plan_among_moving(floor, s.dynamic_obstacles.movers, from, twist, goal)
        };
        let Plan::Found(best) = best else { return self.ended(InView::Plan(best)) };
        let Some(unseen) = self.first_unseen(best.trajectory.points(), s.floor()) else {
            return self.ended(InView::Plan(Plan::Found(best)));
        };
        if self.visibility.virtual_obstacles.is_empty() {
            self.visibility.virtual_obstacles.push(unseen);
        }
        let walls = [bars, self.visibility.virtual_obstacles.clone()].concat();
        let Some(floor) = self.with_virtual_obstacles(s.permitted_floor(), &walls, ends) else {
            return self.unseen_path(unseen, &best, None);
        };
        let Plan::Found(plan) =
            self.planner.plan_among_moving(&floor, s.dynamic_obstacles.movers, from, twist, goal)
        else {
            return self.unseen_path(unseen, &best, None);
        };
        match self.first_unseen(plan.trajectory.points(), s.floor()) {
            Some(next) if self.visibility.virtual_obstacles.len() < MAX_VIRTUAL_OBSTACLES => {
                self.visibility.virtual_obstacles.push(next);
                InView::Asking
            }
            Some(_) => self.unseen_path(unseen, &best, None),
            None if !continues(&plan, &best, &floor) => self.unseen_path(unseen, &best, None),
            None if is_worth(&plan, &best) => self.ended(InView::Plan(Plan::Found(plan))),
            None => self.unseen_path(unseen, &best, Some(plan)),
        }
    }

    /// The end of a search whose best path enters unseen floor at a place.
    fn unseen_path(&mut self, at: Vector2, best: &PlanResult, seen: Option<Box<PlanResult>>) -> InView {
        let length = length(&best.trajectory, 0.0, self.radius);
        self.ended(InView::Unseen(UnseenPath { at, length, seen }))
    }

    /// The end of a search.
    fn ended(&mut self, result: InView) -> InView {
        self.visibility.virtual_obstacles.clear();
        result
    }

    /// First place at which a path enters floor that the camera does not observe in time.
    pub(crate) fn first_unseen(&self, way: &[TrajectoryPoint], floor: &OccupancyGrid) -> Option<Vector2> {
        self.camera_fov?.first_unseen(way, floor, self.radius, &self.visibility)
    }

    /// Whether the rest of a path, from `time` \[s\] on, is free on the newest map, and its floor was or will be observed.
    pub(crate) fn is_still_good(&self, way: &Trajectory, time: f64, s: &WorldState<'_>) -> bool {
        let rest = &way.points()[way.points().partition_point(|point| point.time < time)..];
        self.obstacle_on(way, time, s).is_none() && self.first_unseen(rest, s.floor()).is_none()
    }

    /// The first contact on the rest of a path, from `time` \[s\] on; `None` if the rest is free.
    pub(crate) fn obstacle_on(&self, way: &Trajectory, time: f64, s: &WorldState<'_>) -> Option<Obstruction> {
        self.planner.validate_trajectory(s.permitted_floor(), way, time).err()
    }

    /// The floor with the unknown cells about these places blocked, except under the ends of the path; none without places.
    fn with_virtual_obstacles(
        &self,
        floor: &OccupancyGrid,
        places: &[Vector2],
        ends: [Vector2; 2],
    ) -> Option<OccupancyGrid> {
        let mut with_virtual_obstacles = (!places.is_empty()).then(|| floor.clone())?;
        for at in places {
            wall_off(&mut with_virtual_obstacles, *at, ends, self.radius, self.visibility.home);
        }
        Some(with_virtual_obstacles)
    }
}

/// Whether a path continues the present motion as smoothly as the best path, and remains on the map.
fn continues(plan: &PlanResult, best: &PlanResult, floor: &OccupancyGrid) -> bool {
    let stays =
        plan.trajectory.points().iter().all(|p| floor.geometry().cell_at(p.pose.position()).is_some());
    stays && (plan.is_continuous || !best.is_continuous)
}

/// Whether a path takes little longer than the best one.
fn is_worth(plan: &PlanResult, best: &PlanResult) -> bool {
    plan.trajectory.duration() < MAX_SEEN_PATH_RATIO * best.trajectory.duration() + MAX_SEEN_PATH_EXTRA_S
}

fn wall_off(floor: &mut OccupancyGrid, at: Vector2, ends: [Vector2; 2], radius: f64, home: Option<Vector2>) {
    let geometry = *floor.geometry();
    let is_off_the_ends = |cell: &CellIndex| {
        ends.iter().all(|end| (geometry.center(*cell) - end).norm() > radius + geometry.resolution)
    };
    let cells: Vec<_> =
        unknown_about(floor, at, VIRTUAL_OBSTACLE_RADIUS_M, home).filter(is_off_the_ends).collect();
    for cell in cells {
        floor.set(cell, Cell::Occupied);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::behaviour::navigator::testing::{at_rest, floor};
    use crate::config::RobotConfig;
    use trundle_core::Stamp;

    #[test]
    fn walls_are_put_on_the_unknown_alone() {
        let mut grid = floor(|at| at.y > 2.3);
        wall_off(&mut grid, Vector2::new(4.0, 2.4), [Vector2::new(3.9, 2.6), Vector2::zeros()], 0.1, None);
        assert_eq!(grid.at(Vector2::new(3.9, 2.6)), Cell::Unknown, "an end of the way");
        assert_eq!(grid.at(Vector2::new(4.0, 2.45)), Cell::Occupied);
        assert_eq!(grid.at(Vector2::new(4.0, 2.2)), Cell::Free);
        assert_eq!(grid.at(Vector2::new(5.0, 2.4)), Cell::Unknown);
    }

    /// A robot next to a bed with an unseen far side, and a goal behind the bed.
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

    fn planner() -> PathPlanner {
        let config = RobotConfig::default();
        PathPlanner::new(&config, &config.footprint().unwrap()).unwrap()
    }

    fn asked(planner: &mut PathPlanner, s: &WorldState<'_>, goal: Pose2) -> InView {
        let ask = |_| planner.plan_in_view(s, (s.estimate.pose, Twist2::ZERO), goal);
        (0..=MAX_VIRTUAL_OBSTACLES).map(ask).find(|found| !matches!(found, InView::Asking)).unwrap()
    }

    #[test]
    fn a_path_is_chosen_that_shows_the_floor_it_leads_onto() {
        let (grid, mut planner) = (beside_a_bed(), planner());
        let (from, goal) = (Pose2::new(4.45, 1.75, -1.57), Pose2::new(2.75, 0.7, 3.1));
        let s = at_rest(&grid, Stamp::default(), from);
        let found = |plan: Plan| match plan {
            Plan::Found(plan) => plan.trajectory,
            other => panic!("{other:?}"),
        };
        let best = found(planner.planner.plan(&grid, from, Twist2::ZERO, goal));
        assert!(planner.first_unseen(best.points(), &grid).is_some(), "the best way cuts the unseen corner");
        let InView::Plan(shown) = asked(&mut planner, &s, goal) else { panic!("there is one in view") };
        let shown = found(shown);
        assert_eq!(planner.first_unseen(shown.points(), &grid), None);
        assert!(shown.duration() < MAX_SEEN_PATH_RATIO * best.duration() + MAX_SEEN_PATH_EXTRA_S);
        planner.camera_fov = None;
        let InView::Plan(any) = asked(&mut planner, &s, goal) else { panic!("a laser sees all") };
        assert_eq!(found(any), best);
    }
}
