use crate::{
    config::RobotConfig,
    last_stage::{LastStage, Progress},
    look::LookAround,
    schedule::Ticker,
    stage::{Stage, StageTimes},
    state::DriveState,
};
use trundle_control::{
    FollowPhase, FollowReport, Follower, SafetyAction, SafetyInput, SafetyMemory, SafetyMonitor, SafetyScan,
};
use trundle_core::{Footprint, Invalid, OccupancyGrid, Pose2, PoseEstimate, Stamp, Twist2};
use trundle_planning::{Plan, PlanResult, Planner};

/// What the robot knows of its surroundings when it decides.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Surroundings<'a> {
    pub(crate) now: Stamp,
    pub(crate) estimate: PoseEstimate,
    pub(crate) grid: &'a OccupancyGrid,
    /// The newest scan, carried by odometry.
    pub(crate) scan: Option<SafetyScan<'a>>,
}

/// What it decides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Decision {
    pub(crate) twist: Twist2,
    pub(crate) replanned: bool,
}

/// From a goal and the surroundings to a safe twist: plans when it must, follows, settles, looks around when no way is
/// known, and asks the safety monitor last. Where it is tight, turns and straight moves settle instead.
#[derive(Debug)]
pub(crate) struct Navigator {
    planner: Planner,
    follower: Follower,
    last_stage: LastStage,
    safety: SafetyMonitor,
    check_due: Ticker,
    goal: Option<Pose2>,
    plan: Option<Box<PlanResult>>,
    state: DriveState,
    touched: bool,
    over_edge: bool,
    started: Option<Stamp>,
    held_since: Option<Stamp>,
    look: LookAround,
}

/// The robot stands so long before its first plan: the gyro's bias is measured and the first map drawn, s.
const OPENING: f64 = 1.5;
/// Held by safety for so long, it plans anew from where it stands, s.
const PATIENCE: f64 = 1.0;
/// Slower than this the robot stands, m/s.
const STANDING: f64 = 0.02;

impl Navigator {
    pub(crate) fn new(config: &RobotConfig, footprint: &Footprint) -> Result<Self, Invalid> {
        Ok(Self {
            planner: Planner::new(config.planning, footprint, config.limits, config.drive)?,
            follower: Follower::new(config.control.clone(), config.drive, config.limits)?,
            last_stage: LastStage::new(&config.docking, footprint)?,
            safety: SafetyMonitor::new(config.safety.clone(), footprint)?,
            check_due: Ticker::new(config.schedule.validated()?.check_hz),
            goal: None,
            plan: None,
            state: DriveState::Idle,
            touched: false,
            over_edge: false,
            started: None,
            held_since: None,
            look: LookAround::default(),
        })
    }

    pub(crate) fn drive_to(&mut self, goal: Pose2) {
        self.goal = Some(goal);
        self.state = DriveState::Opening;
        self.follower.halt();
        self.last_stage.reset();
        self.look = LookAround::default();
    }

    /// What the bumper says.
    pub(crate) fn touch(&mut self, pressed: bool) {
        self.touched = pressed;
    }

    /// What the cliff sensors say.
    pub(crate) fn cliff(&mut self, over_edge: bool) {
        self.over_edge = over_edge;
    }

    pub(crate) fn state(&self) -> &DriveState {
        &self.state
    }

    pub(crate) fn plan(&self) -> Option<&PlanResult> {
        self.plan.as_deref()
    }

    /// One control step: maybe a new plan, then a command, then safety's word on it.
    pub(crate) fn step(&mut self, s: &Surroundings<'_>, times: &mut StageTimes) -> Decision {
        let goal = self.goal.filter(|_| self.wants_plan(s));
        let replanned = goal.is_some_and(|goal| times.measure(Stage::Planning, || self.replan(goal, s)));
        let follow = times.measure(Stage::Control, || self.follower.step(&s.estimate, s.now));
        self.note_progress(&follow, s, times);
        let wanted = match &self.state {
            DriveState::Looking { .. } => self.look.twist(s.estimate.pose),
            DriveState::Docking => times.measure(Stage::Control, || self.dock(s)),
            _ => follow.twist,
        };
        let twist = times.measure(Stage::Safety, || self.guard(wanted, s));
        self.follower.sent(twist);
        Decision { twist, replanned }
    }

    /// Whether it is time to plan: at the end of the opening, or when a check finds the old plan wanting.
    fn wants_plan(&mut self, s: &Surroundings<'_>) -> bool {
        let started = *self.started.get_or_insert(s.now);
        match &self.state {
            DriveState::Idle | DriveState::Arrived | DriveState::Stopped { .. } => false,
            DriveState::Settling | DriveState::Docking => false,
            DriveState::Opening => s.scan.is_some() && s.now - started >= OPENING,
            DriveState::Looking { .. } => self.check_due.due(s.now),
            DriveState::Held { .. } if self.held_since.is_some_and(|since| s.now - since < PATIENCE) => false,
            DriveState::Held { .. } => self.check_due.due(s.now),
            DriveState::Driving => self.check_due.due(s.now) && !self.plan_holds(s.grid),
        }
    }

    /// Whether the rest of the trajectory is still free on the newest map.
    fn plan_holds(&self, grid: &OccupancyGrid) -> bool {
        match (&self.plan, self.follower.reference()) {
            (Some(plan), Some(reference)) => {
                self.planner.still_free(grid, &plan.trajectory, reference.time).is_ok()
            }
            (Some(_), None) => true,
            (None, _) => false,
        }
    }

    /// Plans from the reference where the robot is on it, else from where it stands; true when there is a new plan.
    fn replan(&mut self, goal: Pose2, s: &Surroundings<'_>) -> bool {
        if matches!(self.state, DriveState::Held { .. }) && self.turned_to_docking(goal, s) {
            return false;
        }
        let from = match (&self.state, self.follower.reference()) {
            (DriveState::Driving, Some(reference)) => (reference.pose, reference.twist),
            _ => (s.estimate.pose, Twist2::ZERO),
        };
        match self.planner.plan(s.grid, from.0, from.1, goal) {
            Plan::Found(plan) if plan.is_continuous || s.estimate.twist.v.abs() < STANDING => {
                self.follower.follow(plan.trajectory.clone(), goal);
                self.plan = Some(plan);
                self.state = DriveState::Driving;
                self.held_since = None;
                true
            }
            Plan::Found(_) => {
                self.hold("stopping to plan anew", s.now);
                false
            }
            refused => {
                if !self.turned_to_docking(goal, s) {
                    self.look_around(why(&refused), s);
                }
                false
            }
        }
    }

    /// No way is known: stop, then turn on the spot until one is, or everything around has been seen.
    fn look_around(&mut self, reason: String, s: &Surroundings<'_>) {
        self.follower.halt();
        self.state = if self.look.is_over(s.estimate.pose) {
            DriveState::Stopped { reason }
        } else {
            DriveState::Looking { reason }
        };
    }

    /// Near the goal, where no path is found or safety holds the robot: by turns and straight moves, if there are such.
    fn turned_to_docking(&mut self, goal: Pose2, s: &Surroundings<'_>) -> bool {
        let stands = s.estimate.twist.v.abs() < STANDING;
        let turned = stands && self.last_stage.begin_if_possible(s, goal);
        if turned {
            self.start_docking();
        }
        turned
    }

    fn start_docking(&mut self) {
        self.follower.halt();
        self.held_since = None;
        self.state = DriveState::Docking;
    }

    /// One step of turns and straight moves.
    fn dock(&mut self, s: &Surroundings<'_>) -> Twist2 {
        match self.last_stage.step(s) {
            Progress::Moving(twist) => return twist,
            Progress::Settled => self.state = DriveState::Arrived,
            Progress::GivenUp(reason) => self.state = DriveState::Stopped { reason },
        }
        Twist2::ZERO
    }

    fn hold(&mut self, reason: &str, now: Stamp) {
        self.follower.halt();
        self.held_since.get_or_insert(now);
        self.state = DriveState::Held { reason: reason.to_owned() };
    }

    /// Safety's word on a command.
    fn guard(&mut self, twist: Twist2, s: &Surroundings<'_>) -> Twist2 {
        let report = self.safety.check(&SafetyInput {
            now: s.now,
            twist,
            scan: s.scan,
            memory: Some(SafetyMemory { grid: s.grid, map_from_base: s.estimate.pose }),
            touched: self.touched,
            over_edge: self.over_edge,
            image: s.scan.map(|scan| scan.scan.stamp()),
            wheels: Some(s.now),
        });
        match (report.action, &self.state) {
            (
                SafetyAction::Stop(reason),
                DriveState::Driving | DriveState::Settling | DriveState::Held { .. },
            ) => {
                self.held_since.get_or_insert(s.now);
                self.state = DriveState::Held { reason: reason.to_string() };
            }
            (SafetyAction::Stop(_), DriveState::Docking) if twist != Twist2::ZERO => {
                self.last_stage.interrupted(s);
            }
            (SafetyAction::Pass | SafetyAction::Slow(_), DriveState::Held { .. })
                if self.follower.end().is_some() =>
            {
                self.held_since = None;
                self.state = DriveState::Driving;
            }
            _ => {}
        }
        report.twist
    }

    /// At the end of the trajectory: an arc, or turns and straight moves.
    fn begin_to_settle(&mut self, s: &Surroundings<'_>) {
        self.state = DriveState::Settling;
        let Some(goal) = self.goal else { return };
        let preview = self.follower.preview_settling(s.estimate.pose, goal);
        if self.last_stage.takes_over(s, goal, &preview) {
            self.start_docking();
        }
    }

    /// What the follower's phase means for the state.
    fn note_progress(&mut self, follow: &FollowReport, s: &Surroundings<'_>, times: &mut StageTimes) {
        let moving = matches!(self.state, DriveState::Driving | DriveState::Settling);
        match follow.phase {
            _ if !moving => {}
            FollowPhase::Settled => self.state = DriveState::Arrived,
            FollowPhase::Approaching | FollowPhase::Turning if self.state == DriveState::Driving => {
                times.measure(Stage::Planning, || self.begin_to_settle(s));
            }
            FollowPhase::Approaching | FollowPhase::Turning => self.state = DriveState::Settling,
            FollowPhase::Tracking if follow.off_track => self.plan = None,
            FollowPhase::Tracking | FollowPhase::Idle => {}
        }
    }
}

/// Why there is no plan, for a person.
fn why(plan: &Plan) -> String {
    match plan {
        Plan::Found(_) => "there is a way".to_owned(),
        Plan::Blocked { nearest } => {
            format!("no way to the goal is free; the nearest point is ({:.2}, {:.2}) m", nearest.x, nearest.y)
        }
        Plan::StartInObstacle { clearance } => format!("{:.3} m too little room here", -clearance),
        Plan::GoalInObstacle { clearance } => format!("{:.3} m too little room at the goal", -clearance),
        Plan::StartOutside => "the robot is off the map".to_owned(),
        Plan::GoalOutside => "the goal is off the map".to_owned(),
        Plan::Refused(invalid) => invalid.to_string(),
    }
}
