//! The navigator: from a goal and the world state to a safe twist.

mod long_decision;
#[cfg(test)]
pub(crate) mod testing;
#[cfg(test)]
mod tests;

use crate::world_state::WorldState;
use crate::{
    behaviour::contacts::Contacts,
    behaviour::drive_state::DriveState,
    behaviour::goal::Goal,
    behaviour::machine::StateMachine,
    behaviour::path_search::viewpoint::Viewpoint,
    behaviour::progress_checker::guard::Remaining,
    behaviour::progress_checker::rest::rest,
    behaviour::spin::Spin,
    behaviour::state::{Drive, Relative, State, Station},
    behaviour::tools::Tools,
    config::RobotConfig,
    goal_approach::GoalApproachReport,
    mission::GoalOptions,
    operator::RunSetting,
    pose_status::PoseCertainty,
    reason::{NoPath, Reason, ReasonKind, TransitionReason},
    stage::{Stage, StageTimes},
};
use trundle_control::{MotionSense, SafetyInput, SafetyMemory, SafetyMonitor};
use trundle_core::{Footprint, Invalid, Twist2};
use trundle_planning::PlanResult;

/// Decision of a control step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Decision {
    pub(crate) twist: Twist2,
    pub(crate) replanned: bool,
}

/// Computes a safe twist from a goal and the world state: plans, follows the trajectory, approaches the goal, and waits. Without a path the
/// robot turns on the spot and observes. The safety monitor checks each twist last. In narrow space docking makes the approach.
#[derive(Debug)]
pub(crate) struct Navigator {
    machine: StateMachine,
    tools: Tools,
    safety: SafetyMonitor,
    /// Twist of the last step before the safety monitor.
    wanted: Twist2,
}

impl Navigator {
    pub(crate) fn new(config: &RobotConfig, footprint: &Footprint) -> Result<Self, Invalid> {
        config.mission_executor.validated()?;
        Ok(Self {
            machine: StateMachine::default(),
            tools: Tools::new(config, footprint)?,
            safety: SafetyMonitor::new(config.safety.clone(), footprint)?,
            wanted: Twist2::ZERO,
        })
    }

    /// Whether goals that no path leads to end, in place of a wait for a path.
    pub(crate) fn end_without_path(&mut self, ends: bool) {
        self.tools.ends_without_path = ends;
    }

    /// Changes a setting. Limits of speed and turn rate count from the next plan on.
    pub(crate) fn change(&mut self, setting: RunSetting) {
        match setting {
            RunSetting::Speed(speed) => self.tools.planner.planner.limit_speed(speed),
            RunSetting::TurnRate(omega) => self.tools.planner.planner.limit_turn_rate(omega),
            RunSetting::Patience(patience) => self.tools.set_patience(patience),
            RunSetting::ArrivalBound(distance) => self.tools.arrival.bound.distance = distance,
            RunSetting::ArrivalHeadingBound(deg) => self.tools.arrival.bound.heading = deg.to_radians(),
        }
    }

    /// Sets a goal with the options of the robot file.
    pub(crate) fn set_goal(&mut self, goal: Goal) {
        self.set_goal_with(goal, GoalOptions::default());
    }

    /// Sets the goal. A robot that follows a trajectory continues to the new goal without a stop.
    pub(crate) fn set_goal_with(&mut self, goal: Goal, options: GoalOptions) {
        let rolls_on = matches!(self.machine.state(), State::Drive(_)) && goal.is_driven_to();
        self.tools.restart(goal, options, rolls_on);
        let state = match goal {
            Goal::Stay => State::Idle,
            Goal::Exact(_) | Goal::Viewpoint(_) if rolls_on => State::Drive(Drive::default()),
            Goal::Align(pose) if self.tools.goal_approach.begin_at(pose) => State::Maneuver,
            Goal::Station(goal) => State::Station(Station::new(goal)),
            Goal::Relative(motion) => State::Relative(Relative::new(motion)),
            Goal::Spin => State::Spin(Spin::default()),
            Goal::Exact(_) | Goal::Viewpoint(_) | Goal::Align(_) => State::Initialize,
        };
        let is_dropped = goal == Goal::Stay;
        let why = if is_dropped { TransitionReason::GoalDropped } else { TransitionReason::GoalGiven };
        self.machine.change(state.because(why));
    }

    /// A change of the bumper.
    pub(crate) fn touch(&mut self, pressed: bool) {
        self.tools.contacts.touch(pressed);
        if self.tools.contacts.are_too_many() && !self.machine.state().kind().is_over() {
            self.tools.halt();
            let reason = Reason::RepeatedContact { contacts: self.tools.contacts.count };
            self.machine.stop(reason, TransitionReason::RepeatedContact);
        }
    }

    /// A change of the cliff sensors.
    pub(crate) fn cliff(&mut self, over_edge: bool) {
        self.tools.contacts.over_edge = over_edge;
    }

    /// The state as front ends show it.
    pub(crate) fn state(&self) -> DriveState {
        self.machine.state().published()
    }

    /// Reason for the last change of state; `None` before the first one.
    pub(crate) fn transition(&self) -> Option<TransitionReason> {
        self.machine.reason()
    }

    /// Report of turns and straight moves for the goal.
    pub(crate) fn docking(&self) -> &GoalApproachReport {
        self.tools.goal_approach.report()
    }

    pub(crate) fn plan(&self) -> Option<&PlanResult> {
        self.tools.plan.as_ref().map(|plan| &*plan.result)
    }

    /// Executes one control step: an optional new plan, a command, and the check by the safety monitor.
    pub(crate) fn step(&mut self, s: &WorldState<'_>, times: &mut StageTimes) -> Decision {
        let replanned = times.measure_rest(Stage::Behaviour, |times| self.choose(s, times));
        let twist = times.measure(Stage::Safety, || self.guard(s));
        self.tools.follower.sent(twist);
        Decision { twist, replanned }
    }

    /// Chooses state and command; returns whether there is a new plan.
    fn choose(&mut self, s: &WorldState<'_>, times: &mut StageTimes) -> bool {
        self.prepare(s);
        let (machine, tools) = (&mut self.machine, &mut self.tools);
        let replanned = machine.plan(tools, s, times);
        let follow = times.measure(Stage::Control, || tools.follower.step(&s.estimate, s.now));
        machine.follow(tools, &follow, s, times);
        self.wanted = machine.tick(tools, &follow, s, times);
        replanned
    }

    /// Updates the data that all states share: zones, the opening, and the checks of pose, progress and view.
    fn prepare(&mut self, s: &WorldState<'_>) {
        if self.tools.planner.take_zones(s) {
            self.tools.schedule.check_due.make_due();
        }
        self.tools.opening.start(s.now);
        self.machine.prepare(&mut self.tools, s);
        if !self.machine.state().kind().is_over() {
            self.monitor_pose(s);
            self.monitor_progress(s);
        }
        self.monitor_view(s);
    }

    /// Checks that the pose is known.
    fn monitor_pose(&mut self, s: &WorldState<'_>) {
        let is_lost = matches!(self.machine.state(), State::Relocalize { .. });
        match lost_reason(s) {
            Some(reason) if !is_lost => {
                self.tools.halt();
                self.tools.plan = None;
                let state = State::Relocalize { reason };
                self.machine.change(state.because(TransitionReason::PoseLost));
            }
            None if is_lost && s.pose_status.certainty == PoseCertainty::Known => {
                // The robot may have been carried here.
                self.tools.planner.visibility.home = None;
                self.tools.guard.carried(s.now, self.tools.planner.visibility.results());
                let spins = self.tools.goal == Goal::Spin;
                let state = if spins { State::Spin(Spin::default()) } else { State::Initialize };
                self.machine.change(state.because(TransitionReason::PoseFound));
            }
            _ => {}
        }
    }

    /// Checks that the robot makes progress.
    fn monitor_progress(&mut self, s: &WorldState<'_>) {
        if let Some(reference) = self.tools.follower.reference().filter(|_| self.tools.plan.is_some()) {
            self.tools.guard.note(reference.time, s.floor());
        }
        let rest = rest(self.machine.state(), &self.tools, s);
        // The opening and a hold by the body are not faults of the goal.
        let is_asked = self.tools.opening.is_rested(s) && s.hold.is_none() && !self.waits_by_request();
        let rest = rest.filter(|_| is_asked);
        let Some(rest) = rest else { return self.tools.guard.pause(s.now) };
        // The final approach belongs to the drive before it.
        let is_driving = matches!(self.machine.state(), State::Drive(_) | State::Approach | State::Face(_));
        let remaining = Remaining { rest, results: self.tools.planner.visibility.results(), is_driving };
        let time = self.tools.guard.time_without_progress(s.now, &remaining);
        let is_over = self.tools.options.patience.is_some_and(|patience| time > patience);
        if is_over && !self.observes_once_more(s) {
            let state = self.state();
            // Near a closed door the camera is blind for a moment: that is not the cause.
            let is_blind = self.reason_kind() == Some(ReasonKind::ImageMissing);
            let observation = self.tools.guard.final_observation();
            let observation = observation.filter(|_| is_blind || self.searches_over_unseen_floor());
            let blocked = observation.map(|observation| {
                self.tools.planner.no_path(NoPath::Blocked { nearest: observation.nearest })
            });
            let cause = blocked.or_else(|| state.reason().cloned());
            let (state, cause) = (state.name(), cause.map(Box::new));
            self.tools.halt();
            self.machine.stop(Reason::NoProgress { time, state, cause }, TransitionReason::NoProgress);
        }
    }

    /// Whether the robot observes once more the reachable point nearest to the goal. A search over unseen floor may have led away from it.
    fn observes_once_more(&mut self, s: &WorldState<'_>) -> bool {
        if let Some(observation) = self.tools.guard.final_observation() {
            return observation.continues(s.now);
        }
        if !self.searches_over_unseen_floor() {
            return false;
        }
        let (Some(search), Some(goal)) = (self.machine.search(), self.tools.goal.pose()) else {
            return false;
        };
        if search.rest_over_unseen_floor.is_none() {
            return false;
        }
        let Some(nearest) = self.tools.planner.nearest_seen_point(s, goal) else { return false };
        self.tools.guard.begin_final_observation(s.now, nearest);
        search.viewpoint = Viewpoint::default();
        self.tools.follower.halt();
        true
    }

    /// Whether obstacles and unseen floor are all that keeps the robot from its goal: not a sensor, and not the base.
    fn searches_over_unseen_floor(&self) -> bool {
        self.reason_kind().is_some_and(|kind| kind.is_unseen_path() || kind.is_blockage())
    }

    /// Whether the robot waits for a blocked path, as the goal asks.
    fn waits_by_request(&self) -> bool {
        self.tools.waits_when_blocked() && self.reason_kind().is_some_and(ReasonKind::is_blockage)
    }

    /// Kind of the reason of the present state; `None` in a state without a reason.
    fn reason_kind(&self) -> Option<ReasonKind> {
        self.state().reason().map(Reason::kind)
    }

    /// If a turn restored the view twice at one place, the path to the viewpoint leads into the camera's blind range, and the navigator
    /// gives up the viewpoint.
    fn monitor_view(&mut self, s: &WorldState<'_>) {
        let is_in_vain = self.tools.view_monitor.is_restored_in_vain(s);
        let waits = matches!(self.machine.state(), State::Wait(_));
        if is_in_vain && waits && self.tools.goal.is_viewpoint() {
            self.tools.follower.halt();
            self.machine.stop(Reason::NoSightOnPath, TransitionReason::NoSightOnPath);
        }
    }

    /// Safety's word on the wanted twist.
    fn guard(&mut self, s: &WorldState<'_>) -> Twist2 {
        let Contacts { touched, over_edge, .. } = self.tools.contacts;
        let input = safety_input(s, self.wanted, touched, over_edge);
        let report = self.safety.check(&SafetyInput { station: self.machine.permission(s), ..input });
        self.machine.on_safety(&mut self.tools, self.wanted, report.action, s);
        report.twist
    }
}

/// Returns the reason for a lost pose; `None` for a known pose.
fn lost_reason(s: &WorldState<'_>) -> Option<Reason> {
    match s.pose_status.certainty {
        PoseCertainty::Known | PoseCertainty::Weak => None,
        PoseCertainty::Uncertain { sigma } if s.motion != MotionSense::Wheels => {
            Some(Reason::WheelsUnresponsive { sigma })
        }
        PoseCertainty::Uncertain { sigma } => Some(Reason::PoseUncertain { sigma }),
        PoseCertainty::Unknown => Some(Reason::PoseUnknown),
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
