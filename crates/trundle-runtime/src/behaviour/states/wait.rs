//! Wait: at rest until the way is free.

use super::maneuver;
use super::replan::{Planned, Query, no_go_zone, replan};
use crate::behaviour::path_planner::known_floor::cells_about;
use crate::behaviour::spin::face;
use crate::behaviour::state::{Next, State, Wait};
use crate::behaviour::tools::Tools;
use crate::reason::{Reason, TransitionReason};
use crate::stage::{Stage, StageTimes};
use crate::world_state::WorldState;
use trundle_control::{FollowReport, SafetyAction};
use trundle_core::{Cell, Pose2, Twist2, Vector2};

/// Speed of backing out of a bumper contact \[m/s\]. Source: ours.
const BACK_OUT_SPEED_M_S: f64 = 0.05;
/// Free distance behind the robot that backing out needs \[m\]. Source: ours.
const BACK_OUT_CLEARANCE_M: f64 = 0.15;
/// Longest time of backing out \[s\]: twice the clearance. A bumper still pressed then is broken, or pushed. Source: ours.
const BACK_OUT_DURATION_S: f64 = 6.0;
/// Duration of a safety stop before the navigator plans again from the present pose \[s\]. Source: ours.
const SAFETY_HOLD_BEFORE_REPLAN_S: f64 = 1.0;

impl Wait {
    /// Plans again after the stop has lasted for a while, without contact and with a view.
    pub(crate) fn plan(&mut self, tools: &mut Tools, s: &WorldState<'_>, times: &mut StageTimes) -> Planned {
        let is_short =
            self.search.held_since.is_some_and(|since| s.now - since < SAFETY_HOLD_BEFORE_REPLAN_S);
        let may = !tools.contacts.is_any() && !tools.view_monitor.is_blind(s) && !is_short;
        let Some(goal) = tools.goal.pose().filter(|_| may && tools.schedule.check_due.due(s.now)) else {
            return Planned::default();
        };
        times.measure(Stage::Planning, || self.plan_from_rest(tools, goal, s))
    }

    fn plan_from_rest(&mut self, tools: &mut Tools, goal: Pose2, s: &WorldState<'_>) -> Planned {
        if no_go_zone(goal, s).is_none()
            && let Some(change) = maneuver::begin_if_possible(tools, goal, s)
        {
            return Planned::to(Some(change));
        }
        let query = Query { goal, from: (s.estimate.pose, Twist2::ZERO), is_driving: false };
        replan(tools, &mut self.search, &query, s)
    }

    /// Observes at the end of the path to a viewpoint.
    pub(crate) fn on_follow(&mut self, tools: &mut Tools, follow: &FollowReport, s: &WorldState<'_>) -> Next {
        self.search.on_follow(&mut tools.planner, &mut tools.follower, follow, s.now);
        None
    }

    /// The command: away from a contact, around to regain the view, towards the blocked place, else at rest.
    pub(crate) fn tick(
        &mut self,
        tools: &mut Tools,
        follow: &FollowReport,
        s: &WorldState<'_>,
    ) -> (Twist2, Next) {
        let twist = if self.backs_out(tools, s) {
            Twist2::new(-BACK_OUT_SPEED_M_S, 0.0)
        } else if tools.view_monitor.is_blind(s) {
            tools.view_monitor.recover(self.search.held_since, s)
        } else {
            let blocked_at = self.search.blocked_at.filter(|_| tools.plan.is_none());
            blocked_at.map_or(follow.twist, |at| face(s.estimate.pose, at))
        };
        (twist, None)
    }

    /// Whether the robot should now back away from a pressed bumper or an edge, over floor that the map has free.
    fn backs_out(&self, tools: &Tools, s: &WorldState<'_>) -> bool {
        let backs = SAFETY_HOLD_BEFORE_REPLAN_S..SAFETY_HOLD_BEFORE_REPLAN_S + BACK_OUT_DURATION_S;
        let waited = self.search.held_since.is_some_and(|since| backs.contains(&(s.now - since)));
        tools.contacts.is_any() && waited && is_free_behind(s, tools.body.radius)
    }

    /// Stores the reason of a stop, or continues the drive once the safety monitor permits it.
    pub(crate) fn on_safety(&mut self, tools: &Tools, action: SafetyAction, s: &WorldState<'_>) -> Next {
        match action {
            SafetyAction::Stop(stop) => {
                self.search.held_since.get_or_insert(s.now);
                let search = std::mem::take(&mut self.search);
                let wait = Self { reason: Reason::Safety(stop), search, interrupted: self.interrupted };
                State::Wait(wait).because(TransitionReason::SafetyStop)
            }
            SafetyAction::Pass | SafetyAction::Slow(_) => {
                let drive = self.interrupted.filter(|_| !tools.contacts.is_any())?;
                State::Drive(drive).because(TransitionReason::SafetyPass)
            }
        }
    }
}

/// Whether the map is free in the area that a disc of `radius` covers when backing out.
fn is_free_behind(s: &WorldState<'_>, radius: f64) -> bool {
    let grid = s.permitted_grid();
    let geometry = grid.geometry();
    let (here, ahead) = (s.estimate.pose.position(), s.estimate.pose.inverse());
    let is_in_the_way = |at: Vector2| {
        let at = ahead.transform(at);
        // Obstacles to the side of or ahead of the robot do not block backing out.
        at.x < -0.5 * radius && (at - Vector2::new(at.x.max(-BACK_OUT_CLEARANCE_M), 0.0)).norm() < radius
    };
    let mut cells = cells_about(grid, here, radius + BACK_OUT_CLEARANCE_M);
    geometry.cell_at(here).is_some()
        && !cells.any(|cell| grid.get(cell) == Cell::Occupied && is_in_the_way(geometry.center(cell)))
}
