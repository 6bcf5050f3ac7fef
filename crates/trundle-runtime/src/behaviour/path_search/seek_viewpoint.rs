//! The search for a viewpoint, the path to it, and the observation there.

use super::PathSearch;
use super::viewpoint::{ViewTarget, Viewpoint, best_last, facing, free_viewpoints, new_viewpoints};
use crate::behaviour::path_planner::PathPlanner;
use crate::behaviour::path_planner::known_floor::is_in_sight;
use crate::world_state::WorldState;
use trundle_control::{FollowPhase, FollowReport, Follower};
use trundle_core::{Cell, Pose2, Stamp, Twist2, Vector2, difference_of_angles};
use trundle_planning::Plan;

/// Distances from which a blockage is seen whole and well \[m\]. Source: ours.
const VIEWING_RANGE_M: std::ops::RangeInclusive<f64> = 0.8..=2.5;
/// Depth of a blockage \[m\]: the blockage hides points inside it, not points in front of it. Source: ours.
const BLOCKAGE_DEPTH_M: f64 = 0.35;
/// Difference of the heading from a blockage within which the camera shows the blockage \[rad\]: 17 deg, half of a narrow field of view.
/// Source: ours.
const MAX_VIEWING_ANGLE_RAD: f64 = 0.3;
/// Duration of a view \[s\]: several scans are integrated. Source: ours.
const VIEWING_DURATION_S: f64 = 1.0;

impl PathSearch {
    /// Whether the robot drives to a viewpoint.
    pub(crate) fn is_going(&self) -> bool {
        matches!(self.viewpoint, Viewpoint::Going(..))
    }

    /// Starts the drive to a viewpoint of the blocked place; returns false if the robot is at such a viewpoint.
    pub(crate) fn seeks_viewpoint(
        &mut self,
        planner: &mut PathPlanner,
        follower: &mut Follower,
        s: &WorldState<'_>,
    ) -> bool {
        let Some(at) = self.blocked_at else { return false };
        if !matches!(
            self.viewpoint,
            Viewpoint::Choosing(ViewTarget::Blockage, _) | Viewpoint::Going(..) | Viewpoint::Settled
        ) {
            let here = s.estimate.pose;
            let own_size = if s.grid.at(at) == Cell::Free { 0.0 } else { BLOCKAGE_DEPTH_M };
            let stands_well = VIEWING_RANGE_M.contains(&(at - here.position()).norm())
                && is_in_sight(s.grid, here.position(), at, own_size);
            let view = planner.camera_fov;
            let places = match (stands_well, facing(here.position(), at, view)) {
                (true, turned) if view.is_none() || is_faced(here, turned) => Vec::new(),
                (true, turned) => vec![turned],
                (false, _) => free_viewpoints(s.grid, here, at, own_size, view),
            };
            self.viewpoint = Viewpoint::Choosing(ViewTarget::Blockage, best_last(places));
        }
        self.plan_to_viewpoint(planner, follower, s)
    }

    /// Starts the drive to a viewpoint of the unseen floor at `at`, on the path to the goal. Returns false without a viewpoint, and after
    /// observations of this floor without result.
    pub(crate) fn seeks_view_of(
        &mut self,
        at: Vector2,
        planner: &mut PathPlanner,
        follower: &mut Follower,
        s: &WorldState<'_>,
    ) -> bool {
        match &self.viewpoint {
            Viewpoint::Going(..) => return true,
            Viewpoint::Looking(until) if s.now < *until => return true,
            Viewpoint::Choosing(ViewTarget::UnknownFloor, _) => {}
            _ => {
                self.blocked_at = Some(at);
                self.viewpoint =
                    Viewpoint::Choosing(ViewTarget::UnknownFloor, best_last(views_of(at, planner, s)));
            }
        }
        self.plan_to_viewpoint(planner, follower, s)
    }

    /// Plans to one of the candidate viewpoints. Returns whether a path exists or another candidate is left.
    fn plan_to_viewpoint(
        &mut self,
        planner: &mut PathPlanner,
        follower: &mut Follower,
        s: &WorldState<'_>,
    ) -> bool {
        let Viewpoint::Choosing(aim, places) = &mut self.viewpoint else {
            return self.is_at_viewpoint_or_going();
        };
        let aim = *aim;
        let Some(place) = places.pop() else {
            self.viewpoint = Viewpoint::Settled;
            return false;
        };
        if let Plan::Found(plan) =
            planner.planner.plan(s.permitted_floor(), s.estimate.pose, Twist2::ZERO, place)
            && planner.first_unseen(plan.trajectory.points(), s.floor()).is_none()
        {
            if let (ViewTarget::UnknownFloor, Some(at)) = (aim, self.blocked_at) {
                planner.visibility.record_observation(at, place.position(), s.now);
            }
            follower.follow(plan.trajectory.clone(), place);
            self.viewpoint = Viewpoint::Going(aim, plan.trajectory);
        }
        true
    }

    /// Whether the robot drives to a viewpoint or observes from one.
    fn is_at_viewpoint_or_going(&self) -> bool {
        matches!(self.viewpoint, Viewpoint::Going(..) | Viewpoint::Looking(_))
    }

    /// Whether a plan to the goal is due during the drive to a viewpoint: an obstacle may have left, or unseen floor may have been
    /// observed.
    pub(crate) fn needs_new_plan(&self, s: &WorldState<'_>) -> bool {
        match &self.viewpoint {
            Viewpoint::Going(ViewTarget::UnknownFloor, _) => {
                self.blocked_at.is_none_or(|at| s.floor().at(at) != Cell::Unknown)
            }
            Viewpoint::Looking(until) => s.now >= *until,
            _ => true,
        }
    }

    /// At the end of the path to a viewpoint, or off this path, the robot observes.
    pub(crate) fn on_follow(
        &mut self,
        planner: &mut PathPlanner,
        follower: &mut Follower,
        follow: &FollowReport,
        now: Stamp,
    ) {
        let is_over = matches!(follow.phase, FollowPhase::Settled | FollowPhase::Idle);
        if self.is_going() && (is_over || follow.off_track) {
            self.observe_from_here(planner, follower, now);
        }
    }

    /// Ends the drive to a viewpoint that does not show its target on the newest map, or that is occupied. The robot then observes from its
    /// present place.
    pub(crate) fn watch_path_to_viewpoint(
        &mut self,
        planner: &mut PathPlanner,
        follower: &mut Follower,
        s: &WorldState<'_>,
    ) {
        let (Viewpoint::Going(_, way), Some(reference)) = (&self.viewpoint, follower.reference()) else {
            return;
        };
        if !planner.is_still_good(way, reference.time, s) {
            self.observe_from_here(planner, follower, s.now);
        }
    }

    /// Ends the drive to a viewpoint.
    fn observe_from_here(&mut self, planner: &mut PathPlanner, follower: &mut Follower, now: Stamp) {
        follower.halt();
        self.viewpoint = match self.viewpoint {
            Viewpoint::Going(ViewTarget::UnknownFloor, _) => {
                planner.visibility.note_arrival(now);
                Viewpoint::Looking(now.after(VIEWING_DURATION_S))
            }
            _ => Viewpoint::Settled,
        };
    }
}

/// Candidate viewpoints of unseen floor; none after its observations without result.
fn views_of(at: Vector2, planner: &PathPlanner, s: &WorldState<'_>) -> Vec<Pose2> {
    if planner.visibility.is_worth_observing(at) {
        new_viewpoints(s.floor(), s.estimate.pose, at, planner.camera_fov, &planner.visibility)
    } else {
        Vec::new()
    }
}

/// Whether the camera shows what it shows at the heading of `turned`.
fn is_faced(here: Pose2, turned: Pose2) -> bool {
    difference_of_angles(here.theta, turned.theta).abs() <= MAX_VIEWING_ANGLE_RAD
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::behaviour::navigator::testing::{at_rest, floor};
    use crate::config::RobotConfig;

    #[test]
    fn a_robot_near_a_blockage_turns_to_it_unless_it_faces_it() {
        let config = RobotConfig::default();
        let mut planner = PathPlanner::new(&config, &config.footprint().unwrap()).unwrap();
        let mut follower = Follower::new(config.control.clone(), config.drive, config.limits).unwrap();
        let (grid, at) = (floor(|_| false), Vector2::new(4.2, 2.0));
        for (heading, turns) in [(0.0, false), (0.2, false), (1.0, true), (-3.0, true)] {
            let mut search = PathSearch { blocked_at: Some(at), ..PathSearch::default() };
            let s = at_rest(&grid, Stamp::default(), Pose2::new(3.0, 2.0, heading));
            assert_eq!(search.seeks_viewpoint(&mut planner, &mut follower, &s), turns, "{heading}");
            let Viewpoint::Going(_, way) = &search.viewpoint else {
                assert!(!turns, "{heading}: {:?}", search.viewpoint);
                continue;
            };
            let end = way.end();
            assert!(end.theta.abs() < 0.02 && end.distance(&s.estimate.pose) < 0.01, "{heading}: {end:?}");
        }
    }
}
