//! The command of each state, checked by the safety monitor.

use super::{Goal, Navigator, SAFETY_HOLD_BEFORE_REPLAN_S, known_floor::cells_about, viewpoint::Viewpoint};
use crate::world_state::WorldState;
use crate::{
    behaviour::drive_state::DriveState,
    behaviour::relative_motion::RelativeMotion,
    behaviour::spin::{SPIN_TURNS, face, turn_to},
    behaviour::station_drive::{StationGoal, StationProgress},
    goal_approach::Progress,
    reason::{Reason, TransitionReason},
    stage::{Stage, StageTimes},
};
use trundle_control::{FollowReport, MotionSense, SafetyAction, SafetyInput, SafetyMemory};
use trundle_core::{Cell, Twist2, Vector2};

/// Speed of backing out of a bumper contact \[m/s\]. Source: ours.
const BACK_OUT_SPEED_M_S: f64 = 0.05;
/// Free distance behind the robot that backing out needs \[m\]. Source: ours.
const BACK_OUT_CLEARANCE_M: f64 = 0.15;
/// Longest time of backing out \[s\]: twice the clearance. A bumper still pressed then is broken, or pushed. Source: ours.
const BACK_OUT_DURATION_S: f64 = 6.0;
/// Time without a usable scan \[s\] after which the robot turns to regain one. Source: ours.
const BLIND_PAUSE_S: f64 = 3.0;
/// Speed of backing out of a place with no room to turn \[m/s\]. Source: ours.
const REVERSE_SPEED_M_S: f64 = 0.1;

impl Navigator {
    /// The command before the check of the safety monitor.
    pub(super) fn wanted(
        &mut self,
        follow: &FollowReport,
        s: &WorldState<'_>,
        times: &mut StageTimes,
    ) -> Twist2 {
        let pose = s.estimate.pose;
        match self.state() {
            DriveState::Initializing if self.goal == Goal::Spin => self.spin_once(s),
            DriveState::Recovering { .. } if self.is_wedged => Twist2::new(-REVERSE_SPEED_M_S, 0.0),
            DriveState::Recovering { .. } if matches!(self.viewpoint, Viewpoint::Going(..)) => follow.twist,
            DriveState::Recovering { .. } if self.observes_at_rest() => Twist2::ZERO,
            // The gyro's bias is measured at rest.
            DriveState::Lost { .. } if !self.is_initialized(s) => Twist2::ZERO,
            DriveState::Recovering { .. } | DriveState::Lost { .. } => self.spin.twist(pose),
            DriveState::Waiting { .. } if self.backs_out(s) => Twist2::new(-BACK_OUT_SPEED_M_S, 0.0),
            DriveState::Waiting { .. } if self.is_blind(s) => self.recover_sight(s),
            DriveState::Waiting { .. } => match self.blocked_at.filter(|_| self.plan.is_none()) {
                Some(at) => face(pose, at),
                None => follow.twist,
            },
            DriveState::FinalApproach if matches!(self.goal, Goal::Viewpoint(_)) => self.turn_to_view(s),
            DriveState::FinalApproach if self.goal_approach.holds() => Twist2::ZERO,
            DriveState::Maneuvering if self.station_goal().is_some() => self.drive_at_station(s),
            DriveState::Maneuvering if self.relative_motion().is_some() => self.drive_relative(s),
            DriveState::Maneuvering if self.is_blind(s) => self.recover_sight(s),
            DriveState::Maneuvering => times.measure(Stage::Control, || self.maneuver(s)),
            _ => follow.twist,
        }
    }

    /// Turns roughly to the heading of a viewpoint; the field of view is wide.
    fn turn_to_view(&mut self, s: &WorldState<'_>) -> Twist2 {
        let Goal::Viewpoint(view) = self.goal else { return Twist2::ZERO };
        let twist = turn_to(s.estimate.pose, view.theta);
        if twist == Twist2::ZERO {
            self.machine.change(DriveState::Arrived, TransitionReason::GoalReached);
        }
        twist
    }

    /// Whether the robot should now back away from a pressed bumper or an edge, over floor that the map has free.
    fn backs_out(&self, s: &WorldState<'_>) -> bool {
        let backs = SAFETY_HOLD_BEFORE_REPLAN_S..SAFETY_HOLD_BEFORE_REPLAN_S + BACK_OUT_DURATION_S;
        let waited = self.held_since.is_some_and(|since| backs.contains(&(s.now - since)));
        (self.touched || self.over_edge) && waited && is_free_behind(s, self.radius)
    }

    /// Whether no image has had content within the safety monitor's timeout, or neither wheels nor images measure the motion.
    pub(super) fn is_blind(&self, s: &WorldState<'_>) -> bool {
        s.motion == MotionSense::Nothing || s.seen.is_none_or(|seen| s.now - seen > self.image_timeout)
    }

    /// A camera too near to a wall gives no depth. After a pause, one turn on the spot separates this from a broken camera.
    fn recover_sight(&mut self, s: &WorldState<'_>) -> Twist2 {
        // Images with content that do not measure the motion do not count.
        let seen = s.seen.filter(|_| s.motion != MotionSense::Nothing);
        let since = self.held_since.max(seen);
        let is_long = since.is_some_and(|since| s.now - since >= BLIND_PAUSE_S);
        if is_long { self.sight_recovery.turn(s.estimate.pose) } else { Twist2::ZERO }
    }

    /// A command of the full turn that observes the surroundings.
    fn spin_once(&mut self, s: &WorldState<'_>) -> Twist2 {
        if !self.is_initialized(s) {
            return Twist2::ZERO;
        }
        if self.spin.has_turned(SPIN_TURNS) {
            self.machine.change(DriveState::Arrived, TransitionReason::GoalReached);
            return Twist2::ZERO;
        }
        self.spin.twist(s.estimate.pose)
    }

    /// One step of turns and straight moves.
    fn maneuver(&mut self, s: &WorldState<'_>) -> Twist2 {
        match self.goal_approach.step(s) {
            Progress::Moving(twist) => {
                self.sight_recovery.held(twist);
                return twist;
            }
            Progress::Settled => self.machine.change(DriveState::Arrived, TransitionReason::GoalReached),
            Progress::GivenUp(failure) => {
                let reason = Reason::FinalApproach(failure);
                self.machine.change(DriveState::Stopped { reason }, TransitionReason::MotionFailed);
            }
        }
        Twist2::ZERO
    }

    fn relative_motion(&self) -> Option<RelativeMotion> {
        match self.goal {
            Goal::Relative(motion) if *self.state() == DriveState::Maneuvering => Some(motion),
            _ => None,
        }
    }

    /// One control step of a relative motion.
    fn drive_relative(&mut self, s: &WorldState<'_>) -> Twist2 {
        let Some(motion) = self.relative_motion().filter(|_| self.is_rested(s)) else { return Twist2::ZERO };
        let twist = self.relative_drive.step(motion, s.estimate.pose);
        if twist.is_none() {
            self.machine.change(DriveState::Arrived, TransitionReason::GoalReached);
        }
        twist.unwrap_or_default()
    }

    /// Whether the robot has been at rest since power-on for long enough to measure the gyro's bias.
    fn is_rested(&self, s: &WorldState<'_>) -> bool {
        self.started.is_some_and(|started| s.now - started >= self.config.opening)
    }

    fn station_goal(&self) -> Option<StationGoal> {
        match self.goal {
            Goal::Station(goal) if *self.state() == DriveState::Maneuvering => Some(goal),
            _ => None,
        }
    }

    /// One control step of a motion at a charging station.
    fn drive_at_station(&mut self, s: &WorldState<'_>) -> Twist2 {
        let Some(goal) = self.station_goal().filter(|_| self.is_rested(s)) else { return Twist2::ZERO };
        match self.station_drive.step(&goal, s, self.touched, self.reach) {
            StationProgress::Moving(twist) => return twist,
            StationProgress::Done => self.machine.change(DriveState::Arrived, TransitionReason::GoalReached),
            StationProgress::Failed(failure) => {
                let reason = Reason::Docking(failure);
                self.machine.change(DriveState::Stopped { reason }, TransitionReason::MotionFailed);
            }
        }
        Twist2::ZERO
    }

    /// Safety's word on a command.
    pub(super) fn guard(&mut self, twist: Twist2, s: &WorldState<'_>) -> Twist2 {
        let goal = self.station_goal();
        let station = goal.and_then(|goal| self.station_drive.permission(&goal, s.estimate.pose));
        let input = SafetyInput { station, ..safety_input(s, twist, self.touched, self.over_edge) };
        let report = self.safety.check(&input);
        if self.relative_motion().is_some() {
            let stop = match report.action {
                SafetyAction::Stop(reason) if s.hold.is_none() => Some(reason),
                _ => None,
            };
            if self.relative_drive.is_blocked(stop.is_some(), s.now) {
                let to = stop.map_or(DriveState::Arrived, |reason| DriveState::Stopped {
                    reason: Reason::Safety(reason),
                });
                self.machine.change(to, TransitionReason::MotionFailed);
            }
            return report.twist;
        }
        match (report.action, self.state()) {
            (
                SafetyAction::Stop(reason),
                DriveState::Driving | DriveState::FinalApproach | DriveState::Waiting { .. },
            ) => {
                if !matches!(self.state(), DriveState::Waiting { .. }) {
                    self.sight_recovery.held(twist);
                }
                self.held_since.get_or_insert(s.now);
                let reason = Reason::Safety(reason);
                self.machine.change(DriveState::Waiting { reason }, TransitionReason::SafetyStop);
            }
            (SafetyAction::Stop(reason), DriveState::Recovering { .. })
                if matches!(self.viewpoint, Viewpoint::Going(..)) =>
            {
                self.viewpoint = Viewpoint::Settled;
                self.follower.halt();
                self.held_since.get_or_insert(s.now);
                let reason = Reason::Safety(reason);
                self.machine.change(DriveState::Waiting { reason }, TransitionReason::SafetyStop);
            }
            (SafetyAction::Stop(_), DriveState::Maneuvering)
                if twist != Twist2::ZERO && !self.is_blind(s) =>
            {
                self.goal_approach.interrupted(s);
            }
            (SafetyAction::Pass | SafetyAction::Slow(_), DriveState::Waiting { .. })
                if self.follower.end().is_some() && !(self.touched || self.over_edge) =>
            {
                self.held_since = None;
                self.machine.change(DriveState::Driving, TransitionReason::SafetyPass);
            }
            _ => {}
        }
        report.twist
    }
}

/// Input of the safety monitor for a twist.
pub(crate) fn safety_input<'a>(
    s: &WorldState<'a>,
    twist: Twist2,
    touched: bool,
    over_edge: bool,
) -> SafetyInput<'a> {
    SafetyInput {
        now: s.now,
        twist,
        scan: s.scan,
        memory: Some(SafetyMemory {
            grid: s.grid,
            unconfirmed: s.dynamic_obstacles.unconfirmed,
            map_from_base: s.estimate.pose,
        }),
        touched,
        over_edge,
        hold: s.hold,
        image: s.seen,
        wheels: s.wheels,
        motion: s.motion,
        station: None,
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

#[cfg(test)]
mod tests {
    use super::super::testing::{at_rest, floor, navigator};
    use super::*;
    use trundle_control::StopReason;
    use trundle_core::{OccupancyGrid, Pose2, Stamp};

    /// Time without sight, s; a control step, s.
    const BLIND: f64 = 5.0;
    const STEP: f64 = 0.02;

    /// Makes the robot wait without a usable scan, turn, and regain a scan; returns the stamp of that scan.
    fn lose_sight_and_find_it(navigator: &mut Navigator, grid: &OccupancyGrid, from: Stamp) -> Stamp {
        let mut times = StageTimes::default();
        let mut pose = Pose2::new(3.0, 2.0, 0.0);
        let reason = Reason::Safety(StopReason::StaleImage { age: 1.0 });
        navigator.machine.place(DriveState::Waiting { reason });
        navigator.held_since = Some(from);
        for i in 1..=(BLIND / STEP) as i32 {
            let now = from.after(STEP * f64::from(i));
            let s = WorldState { seen: Some(from.after(-1.0)), ..at_rest(grid, now, pose) };
            let twist = navigator.step(&s, &mut times).twist;
            pose = pose.advance(twist, STEP);
        }
        assert!(pose.theta > 0.5, "it turns to find its sight: {}", pose.theta);
        let sees = |after: f64| from.after(BLIND + after);
        for now in (1..50).map(|i| sees(STEP * f64::from(i))) {
            if !navigator.state().is_over() {
                navigator.machine.place(DriveState::Waiting { reason: Reason::PathOutOfView });
            }
            navigator.step(&WorldState { seen: Some(now), ..at_rest(grid, now, pose) }, &mut times);
        }
        sees(1.0)
    }

    #[test]
    fn it_turns_only_after_it_has_seen_nothing_for_a_while_however_long_it_was_held() {
        let (grid, mut navigator, pose) = (floor(|_| false), navigator(), Pose2::new(3.0, 2.0, 0.0));
        navigator.set_goal(Goal::Viewpoint(Pose2::new(4.0, 2.0, 0.0)));
        let (held, mut times) = (Stamp::default().after(10.0), StageTimes::default());
        let seen = held.after(20.0);
        for (blind, turns) in [(1.0, false), (2.9, false), (3.1, true)] {
            navigator.machine.place(DriveState::Waiting { reason: Reason::MovingObstacle });
            navigator.held_since = Some(held);
            let s = WorldState { seen: Some(seen), ..at_rest(&grid, seen.after(blind), pose) };
            let twist = navigator.step(&s, &mut times).twist;
            assert_eq!(twist.omega != 0.0, turns, "blind for {blind} s: {twist:?}");
        }
    }

    #[test]
    fn a_viewpoint_is_given_up_when_the_camera_goes_blind_twice_on_its_path_and_a_goal_is_not() {
        let (grid, ahead) = (floor(|_| false), Pose2::new(4.0, 2.0, 0.0));
        for (goal, given_up) in [(Goal::Viewpoint(ahead), true), (Goal::Exact(ahead), false)] {
            let mut navigator = navigator();
            navigator.set_goal(goal);
            let once = lose_sight_and_find_it(&mut navigator, &grid, Stamp::default().after(10.0));
            assert!(!navigator.state().is_over(), "the camera may have failed: {:?}", navigator.state());
            let twice = lose_sight_and_find_it(&mut navigator, &grid, once);
            assert_eq!(navigator.state().is_over(), given_up, "{goal:?}: {:?}", navigator.state());
            // A new goal restarts the count.
            navigator.set_goal(goal);
            lose_sight_and_find_it(&mut navigator, &grid, twice);
            assert!(!navigator.state().is_over(), "{:?}", navigator.state());
        }
    }
}
