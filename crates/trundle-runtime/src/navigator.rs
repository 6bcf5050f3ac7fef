use crate::{
    config::RobotConfig,
    last_stage::{LastStage, Progress},
    look::{LookAround, face, turn_to},
    progress::ProgressWatch,
    schedule::Ticker,
    stage::{Stage, StageTimes},
    state::DriveState,
    supervisor_config::SupervisorConfig,
};
use trundle_control::{
    FollowPhase, FollowReport, Follower, SafetyAction, SafetyInput, SafetyMemory, SafetyMonitor, SafetyScan,
};
use trundle_core::{
    Cell, CellIndex, Footprint, Invalid, OccupancyGrid, Pose2, PoseEstimate, Stamp, Twist2, Vector2,
};
use trundle_planning::{Plan, PlanResult, Planner};

/// What the robot knows of its surroundings when it decides.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Surroundings<'a> {
    pub(crate) now: Stamp,
    pub(crate) estimate: PoseEstimate,
    pub(crate) grid: &'a OccupancyGrid,
    /// The newest scan, carried by odometry.
    pub(crate) scan: Option<SafetyScan<'a>>,
    /// Stamp of the newest scan that shows something.
    pub(crate) seen: Option<Stamp>,
}

/// What it decides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Decision {
    pub(crate) twist: Twist2,
    pub(crate) replanned: bool,
}

/// What the robot is asked for, map frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Goal {
    /// Stand exactly here.
    Exact(Pose2),
    /// Come here to see something: a hand's breadth off is as good, and what is blocked is not waited for.
    View(Pose2),
    /// Turn on the spot once.
    Look,
    /// Stand where you are.
    Stay,
}

impl Goal {
    fn pose(self) -> Option<Pose2> {
        match self {
            Self::Exact(pose) | Self::View(pose) => Some(pose),
            Self::Look | Self::Stay => None,
        }
    }
}

/// From a goal and the surroundings to a safe twist: plans when it must, follows, settles, looks around when no way is
/// known, waits, and asks the safety monitor last. Where it is tight, turns and straight moves settle instead.
#[derive(Debug)]
pub(crate) struct Navigator {
    config: SupervisorConfig,
    planner: Planner,
    follower: Follower,
    last_stage: LastStage,
    safety: SafetyMonitor,
    check_due: Ticker,
    improve_due: Ticker,
    goal: Goal,
    plan: Option<Box<PlanResult>>,
    state: DriveState,
    touched: bool,
    over_edge: bool,
    started: Option<Stamp>,
    held_since: Option<Stamp>,
    look: LookAround,
    /// Where the way to the goal ends, when there is none.
    blocked_at: Option<Vector2>,
    /// A disc can always turn away.
    is_polygon: bool,
    /// The outline stands too near to something to turn: it backs out, as far as safety lets it.
    is_wedged: bool,
    /// Whether the robot is too far from its reference to go on from it.
    is_off_track: bool,
    progress: ProgressWatch,
    /// Of the safety monitor, s.
    image_timeout: f64,
    /// Of the disc about the robot, m.
    radius: f64,
}

/// Held by safety for so long, it plans anew from where it stands, s.
const PAUSE: f64 = 1.0;
/// Speed of leaving what presses on the bumper, m/s, and how far behind must be free, m.
const BACK_OUT: f64 = 0.05;
const BACK_OUT_WAY: f64 = 0.15;
/// What is left of a way is driven as planned when it takes less, s.
const WORTH_IMPROVING: f64 = 0.5;
/// A new way replaces a good one when it arrives so much sooner, s.
const SOONER: f64 = 0.05;
/// Without sight for so long, it turns to find some, s.
const BLIND_PAUSE: f64 = 3.0;
/// Slower than this the robot stands, m/s.
const STANDING: f64 = 0.02;
/// So fast it backs out where it has no room to turn, m/s.
const BACKING_OUT: f64 = 0.1;
/// So many turns see everything around twice.
const TURNS: f64 = 2.0;
/// One turn, and a little more, sees it once.
const ONE_TURN: f64 = 1.02;

impl Navigator {
    pub(crate) fn new(config: &RobotConfig, footprint: &Footprint) -> Result<Self, Invalid> {
        Ok(Self {
            config: config.supervisor.validated()?,
            planner: Planner::new(config.planning, footprint, config.limits, config.drive)?,
            follower: Follower::new(config.control.clone(), config.drive, config.limits)?,
            last_stage: LastStage::new(&config.docking, footprint)?,
            safety: SafetyMonitor::new(config.safety.clone(), footprint)?,
            check_due: Ticker::new(config.schedule.validated()?.check_hz),
            improve_due: Ticker::new(config.schedule.improve_hz),
            goal: Goal::Stay,
            plan: None,
            state: DriveState::Idle,
            touched: false,
            over_edge: false,
            started: None,
            held_since: None,
            look: LookAround::default(),
            blocked_at: None,
            is_polygon: matches!(footprint, Footprint::Polygon { .. }),
            is_wedged: false,
            is_off_track: false,
            progress: ProgressWatch::default(),
            image_timeout: config.safety.image_timeout,
            radius: footprint.circumscribed_radius(),
        })
    }

    /// Takes up a goal. From a trajectory that is being driven it goes over to the next one without a stop.
    pub(crate) fn take_up(&mut self, goal: Goal) {
        let rolls_on = self.state == DriveState::Driving && goal.pose().is_some();
        self.goal = goal;
        self.plan = None;
        self.held_since = None;
        self.blocked_at = None;
        self.is_off_track = false;
        self.look = LookAround::default();
        self.last_stage.reset();
        self.progress.restart();
        self.check_due.hurry();
        if !rolls_on {
            self.follower.halt();
        }
        self.state = match goal {
            Goal::Stay => DriveState::Idle,
            Goal::Exact(_) | Goal::View(_) if rolls_on => DriveState::Driving,
            _ => DriveState::Mapping,
        };
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
        self.open(s);
        self.watch(s);
        let goal = self.goal.pose().filter(|_| self.wants_plan(s));
        let replanned = goal.is_some_and(|goal| times.measure(Stage::Planning, || self.replan(goal, s)));
        let replanned = replanned || self.improved(s, times);
        let follow = times.measure(Stage::Control, || self.follower.step(&s.estimate, s.now));
        self.note_progress(&follow, s, times);
        let wanted = self.wanted(&follow, s, times);
        let twist = times.measure(Stage::Safety, || self.guard(wanted, s));
        self.follower.sent(twist);
        Decision { twist, replanned }
    }

    /// The opening: nothing moves before there is a first view.
    fn open(&mut self, s: &Surroundings<'_>) {
        let started = *self.started.get_or_insert(s.now);
        let is_open = s.scan.is_some() && s.now - started >= self.config.opening;
        if self.state == DriveState::Mapping && is_open && self.goal.pose().is_some() {
            self.state = DriveState::Planning;
        }
    }

    /// Whether the robot knows where it is, and whether it gets on.
    fn watch(&mut self, s: &Surroundings<'_>) {
        if self.state.is_over() {
            return;
        }
        let sigma = position_sigma(&s.estimate);
        let is_lost = matches!(self.state, DriveState::Lost { .. });
        if sigma > self.config.lost_sigma && !is_lost {
            self.follower.halt();
            self.last_stage.reset();
            self.plan = None;
            let reason = format!("the position is only known to {sigma:.2} m");
            self.state = DriveState::Lost { reason };
        } else if is_lost && sigma < 0.5 * self.config.lost_sigma {
            self.state = DriveState::Mapping;
        }
        let turns_count = matches!(self.state, DriveState::Settling | DriveState::Docking)
            || self.state == DriveState::Driving
            || self.goal == Goal::Look && self.state == DriveState::Mapping;
        let stood = self.progress.standing_for(s.now, s.estimate.pose, turns_count);
        if stood > self.config.patience {
            self.give_up(stood);
        }
    }

    fn give_up(&mut self, stood: f64) {
        let why = self.state.reason().map_or_else(|| self.state.name().to_owned(), str::to_owned);
        self.follower.halt();
        self.last_stage.reset();
        self.state = DriveState::Stopped { reason: format!("no progress for {stood:.0} s: {why}") };
    }

    /// Whether it is time to plan: at the beginning, or when a check finds the old plan wanting.
    fn wants_plan(&mut self, s: &Surroundings<'_>) -> bool {
        match &self.state {
            DriveState::Idle | DriveState::Arrived | DriveState::Stopped { .. } => false,
            DriveState::Mapping | DriveState::Settling | DriveState::Docking | DriveState::Lost { .. } => {
                false
            }
            DriveState::Planning | DriveState::Recovering { .. } => self.check_due.due(s.now),
            DriveState::Waiting { .. } if self.touched || self.over_edge || self.is_blind(s) => false,
            DriveState::Waiting { .. } if self.held_since.is_some_and(|since| s.now - since < PAUSE) => false,
            DriveState::Waiting { .. } => self.check_due.due(s.now),
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
        if matches!(self.state, DriveState::Waiting { .. }) && self.turned_to_docking(goal, s) {
            return false;
        }
        let from = match (&self.state, self.follower.reference()) {
            (DriveState::Driving, Some(_)) if self.is_off_track => (s.estimate.pose, s.estimate.twist),
            (DriveState::Driving, Some(reference)) => (reference.pose, reference.twist),
            _ => (s.estimate.pose, Twist2::ZERO),
        };
        match self.planner.plan(s.grid, from.0, from.1, goal) {
            Plan::Found(plan) if plan.is_continuous || s.estimate.twist.v.abs() < STANDING => {
                self.follower.follow(plan.trajectory.clone(), goal);
                self.plan = Some(plan);
                self.state = DriveState::Driving;
                self.held_since = None;
                self.blocked_at = None;
                self.is_off_track = false;
                self.look = LookAround::default();
                true
            }
            Plan::Found(_) => {
                self.hold("stopping to plan anew", s.now);
                false
            }
            refused => {
                if !self.turned_to_docking(goal, s) {
                    self.no_way(&refused);
                }
                false
            }
        }
    }

    /// While it drives: a new plan that goes on from the reference and arrives sooner replaces the old one.
    fn improved(&mut self, s: &Surroundings<'_>, times: &mut StageTimes) -> bool {
        let (Some(goal), DriveState::Driving) = (self.goal.pose(), &self.state) else { return false };
        let (Some(old), Some(reference)) = (&self.plan, self.follower.reference()) else { return false };
        let left = old.trajectory.duration() - reference.time;
        if left < WORTH_IMPROVING || !self.improve_due.due(s.now) {
            return false;
        }
        let planner = &mut self.planner;
        let plan =
            times.measure(Stage::Planning, || planner.plan(s.grid, reference.pose, reference.twist, goal));
        match plan {
            Plan::Found(plan) if plan.is_continuous && plan.trajectory.duration() < left - SOONER => {
                self.follower.follow(plan.trajectory.clone(), goal);
                self.plan = Some(plan);
                true
            }
            _ => false,
        }
    }

    /// No way is known: stop, turn on the spot until everything around has been seen, then wait, looking at where it ends.
    fn no_way(&mut self, refused: &Plan) {
        let reason = why(refused);
        self.is_wedged = self.is_polygon && matches!(refused, Plan::StartInObstacle { .. });
        self.follower.halt();
        self.plan = None;
        self.blocked_at = match refused {
            Plan::Blocked { nearest } => Some(*nearest),
            _ => self.goal.pose().map(|goal| goal.position()),
        };
        self.state = match self.goal {
            Goal::View(_) => DriveState::Stopped { reason },
            _ if self.look.has_turned(TURNS) && !self.is_wedged => DriveState::Waiting { reason },
            _ => DriveState::Recovering { reason },
        };
    }

    /// Near the goal, where no path is found or safety holds the robot: by turns and straight moves, if there are such.
    fn turned_to_docking(&mut self, goal: Pose2, s: &Surroundings<'_>) -> bool {
        let stands = s.estimate.twist.v.abs() < STANDING;
        let is_exact = matches!(self.goal, Goal::Exact(_));
        let turned = is_exact && stands && !self.is_blind(s) && self.last_stage.begin_if_possible(s, goal);
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

    /// The command before safety's word on it.
    fn wanted(&mut self, follow: &FollowReport, s: &Surroundings<'_>, times: &mut StageTimes) -> Twist2 {
        let pose = s.estimate.pose;
        match &self.state {
            DriveState::Mapping if self.goal == Goal::Look => self.look_once(s),
            DriveState::Recovering { .. } if self.is_wedged => Twist2::new(-BACKING_OUT, 0.0),
            DriveState::Recovering { .. } | DriveState::Lost { .. } => self.look.twist(pose),
            DriveState::Waiting { .. } if self.backs_out(s) => Twist2::new(-BACK_OUT, 0.0),
            DriveState::Waiting { .. } if self.is_blind(s) => self.look_for_sight(s),
            DriveState::Waiting { .. } => match self.blocked_at.filter(|_| self.plan.is_none()) {
                Some(at) => face(pose, at),
                None => follow.twist,
            },
            DriveState::Settling if matches!(self.goal, Goal::View(_)) => self.turn_to_view(s),
            DriveState::Docking if self.is_blind(s) => Twist2::ZERO,
            DriveState::Docking => times.measure(Stage::Control, || self.dock(s)),
            _ => follow.twist,
        }
    }

    /// At a viewpoint only the heading is taken up, and roughly: the view is wide.
    fn turn_to_view(&mut self, s: &Surroundings<'_>) -> Twist2 {
        let Goal::View(view) = self.goal else { return Twist2::ZERO };
        let twist = turn_to(s.estimate.pose, view.theta);
        if twist == Twist2::ZERO {
            self.state = DriveState::Arrived;
        }
        twist
    }

    /// Whether it is time to leave what presses on the bumper, or an edge, backward, and the map has nothing there.
    fn backs_out(&self, s: &Surroundings<'_>) -> bool {
        let waited = self.held_since.is_some_and(|since| s.now - since > PAUSE);
        (self.touched || self.over_edge) && waited && is_free_behind(s, self.radius)
    }

    /// Whether no image has shown anything for a while.
    fn is_blind(&self, s: &Surroundings<'_>) -> bool {
        s.seen.is_none_or(|seen| s.now - seen > self.image_timeout)
    }

    /// A camera too near to a wall sees nothing: after a while one turn on the spot shows whether that is it.
    fn look_for_sight(&mut self, s: &Surroundings<'_>) -> Twist2 {
        let waited = self.held_since.map_or(0.0, |since| s.now - since);
        if waited < BLIND_PAUSE || self.look.has_turned(ONE_TURN) {
            return Twist2::ZERO;
        }
        self.look.twist(s.estimate.pose)
    }

    /// A turn on the spot, and what is around has been seen.
    fn look_once(&mut self, s: &Surroundings<'_>) -> Twist2 {
        let is_open = self.started.is_some_and(|started| s.now - started >= self.config.opening);
        if !is_open || s.scan.is_none() {
            return Twist2::ZERO;
        }
        if self.look.has_turned(ONE_TURN) {
            self.state = DriveState::Arrived;
            return Twist2::ZERO;
        }
        self.look.twist(s.estimate.pose)
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
        self.state = DriveState::Waiting { reason: reason.to_owned() };
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
            image: s.seen,
            wheels: Some(s.now),
        });
        match (report.action, &self.state) {
            (
                SafetyAction::Stop(reason),
                DriveState::Driving | DriveState::Settling | DriveState::Waiting { .. },
            ) => {
                self.held_since.get_or_insert(s.now);
                self.state = DriveState::Waiting { reason: reason.to_string() };
            }
            (SafetyAction::Stop(_), DriveState::Docking) if twist != Twist2::ZERO && !self.is_blind(s) => {
                self.last_stage.interrupted(s);
            }
            (SafetyAction::Pass | SafetyAction::Slow(_), DriveState::Waiting { .. })
                if self.follower.end().is_some() && !(self.touched || self.over_edge) =>
            {
                self.held_since = None;
                self.state = DriveState::Driving;
            }
            _ => {}
        }
        report.twist
    }

    /// At the end of the trajectory: an arc, or turns and straight moves; or it is near enough.
    fn begin_to_settle(&mut self, s: &Surroundings<'_>) {
        self.state = DriveState::Settling;
        let Goal::Exact(goal) = self.goal else {
            self.follower.halt();
            return;
        };
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
            FollowPhase::Tracking if follow.off_track => {
                self.is_off_track = true;
                self.plan = None;
            }
            FollowPhase::Tracking | FollowPhase::Idle => {}
        }
    }
}

/// Whether the map has nothing occupied where a disc of `radius` goes that backs out.
fn is_free_behind(s: &Surroundings<'_>, radius: f64) -> bool {
    let geometry = s.grid.geometry();
    let ahead = s.estimate.pose.inverse();
    let is_in_the_way = |at: Vector2| {
        let at = ahead.transform(at);
        // What is beside or before the robot it has come past, or touches.
        at.x < -0.5 * radius && (at - Vector2::new(at.x.max(-BACK_OUT_WAY), 0.0)).norm() < radius
    };
    let reach = ((radius + BACK_OUT_WAY) / geometry.resolution).ceil() as usize;
    let Some(CellIndex { col, row }) = geometry.cell_at(s.estimate.pose.position()) else { return false };
    let around = |at: usize, size: usize| at.saturating_sub(reach)..(at + reach + 1).min(size);
    let mut cells = around(row, geometry.height)
        .flat_map(|row| around(col, geometry.width).map(move |col| CellIndex { col, row }));
    !cells.any(|cell| s.grid.get(cell) == Cell::Occupied && is_in_the_way(geometry.center(cell)))
}

/// The larger standard deviation of the position, m.
fn position_sigma(estimate: &PoseEstimate) -> f64 {
    let block = estimate.covariance.fixed_view::<2, 2>(0, 0);
    let (mean, half) = ((block[(0, 0)] + block[(1, 1)]) / 2.0, (block[(0, 0)] - block[(1, 1)]) / 2.0);
    (mean + half.hypot(block[(0, 1)])).max(0.0).sqrt()
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
