mod commands;
mod deferring;
mod floor;
mod plans;
mod unseen;
mod vantage;
mod view;

pub(crate) use commands::safety_input;

use crate::{
    config::RobotConfig,
    last_stage::{LastStage, LastStageReport},
    look::LookAround,
    lookout::UNPLACED,
    progress::ProgressWatch,
    schedule::Ticker,
    sight_watch::SightWatch,
    stage::{Stage, StageTimes},
    state::DriveState,
    supervisor_config::SupervisorConfig,
};
use trundle_control::{FollowPhase, FollowReport, Follower, MotionSense, SafetyMonitor, SafetyScan};
use trundle_core::{Footprint, Invalid, OccupancyGrid, Pose2, PoseEstimate, Stamp, Twist2, Vector2};
use trundle_planning::{MovingObstacle, PlanResult, Planner};
use unseen::Unseen;
use vantage::Vantage;
use view::View;

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
    /// For how long images that show enough have not been located, s.
    pub(crate) unplaced: f64,
    /// What tells how the robot moves.
    pub(crate) motion: MotionSense,
    pub(crate) traffic: Traffic<'a>,
}

/// What moves near by.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Traffic<'a> {
    pub(crate) movers: &'a [MovingObstacle],
    /// Hits of what came near by lately and has not been seen to go, map frame, m.
    pub(crate) lately: &'a [Vector2],
    /// The map without them; none where nothing moves.
    pub(crate) still: Option<&'a OccupancyGrid>,
}

impl<'a> Surroundings<'a> {
    /// The map that plans are made on: what moves is not part of it.
    pub(crate) fn floor(&self) -> &'a OccupancyGrid {
        self.traffic.still.unwrap_or(self.grid)
    }
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
    /// What a camera sees; none where a laser sees all.
    view: Option<View>,
    follower: Follower,
    last_stage: LastStage,
    safety: SafetyMonitor,
    check_due: Ticker,
    improve_due: Ticker,
    goal: Goal,
    plan: Option<Box<PlanResult>>,
    state: DriveState,
    touched: bool,
    /// Since the goal was taken up.
    touches: u32,
    over_edge: bool,
    started: Option<Stamp>,
    held_since: Option<Stamp>,
    look: LookAround,
    sight_watch: SightWatch,
    /// Where the way to the goal ends, when there is none.
    blocked_at: Option<Vector2>,
    vantage: Vantage,
    unseen: Unseen,
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
    /// What was wanted in the last step, before safety's word on it.
    wanted: Twist2,
}

/// A goal is given up after so many touches.
const MOST_TOUCHES: u32 = 3;
/// A position that is known no better is not known at all, m.
const ANYWHERE: f64 = 50.0;
/// Held by safety for so long, it plans anew from where it stands, s.
const PAUSE: f64 = 1.0;

impl Navigator {
    pub(crate) fn new(config: &RobotConfig, footprint: &Footprint) -> Result<Self, Invalid> {
        Ok(Self {
            config: config.supervisor.validated()?,
            planner: Planner::new(config.planning, footprint, config.limits, config.drive)?,
            view: View::of(config)?,
            follower: Follower::new(config.control.clone(), config.drive, config.limits)?,
            last_stage: LastStage::new(&config.docking, footprint)?,
            safety: SafetyMonitor::new(config.safety.clone(), footprint)?,
            check_due: Ticker::new(config.schedule.validated()?.check_hz),
            improve_due: Ticker::new(config.schedule.improve_hz),
            goal: Goal::Stay,
            plan: None,
            state: DriveState::Idle,
            touched: false,
            touches: 0,
            over_edge: false,
            started: None,
            held_since: None,
            look: LookAround::default(),
            sight_watch: SightWatch::default(),
            blocked_at: None,
            vantage: Vantage::Unknown,
            unseen: Unseen::default(),
            is_polygon: matches!(footprint, Footprint::Polygon { .. }),
            is_wedged: false,
            is_off_track: false,
            progress: ProgressWatch::default(),
            image_timeout: config.safety.image_timeout,
            radius: footprint.circumscribed_radius(),
            wanted: Twist2::ZERO,
        })
    }

    /// Takes up a goal. From a trajectory that is being driven it goes over to the next one without a stop.
    pub(crate) fn take_up(&mut self, goal: Goal) {
        let rolls_on = self.state == DriveState::Driving && goal.pose().is_some();
        self.goal = goal;
        self.plan = None;
        self.held_since = None;
        self.blocked_at = None;
        self.vantage = Vantage::Unknown;
        self.unseen.restart();
        self.is_off_track = false;
        self.touches = 0;
        self.sight_watch = SightWatch::default();
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
        self.touches += u32::from(pressed && !self.touched);
        self.touched = pressed;
        if self.touches >= MOST_TOUCHES && !self.state.is_over() {
            // What is touched again and again the map does not show, or not where it is.
            self.follower.halt();
            self.last_stage.reset();
            let reason = format!("touched something {} times on the way", self.touches);
            self.state = DriveState::Stopped { reason };
        }
    }

    /// What the cliff sensors say.
    pub(crate) fn cliff(&mut self, over_edge: bool) {
        self.over_edge = over_edge;
    }

    pub(crate) fn state(&self) -> &DriveState {
        &self.state
    }

    /// What turns and straight moves did for the goal.
    pub(crate) fn docking(&self) -> &LastStageReport {
        self.last_stage.report()
    }

    pub(crate) fn plan(&self) -> Option<&PlanResult> {
        self.plan.as_deref()
    }

    /// One control step: maybe a new plan, then a command, then safety's word on it.
    pub(crate) fn step(&mut self, s: &Surroundings<'_>, times: &mut StageTimes) -> Decision {
        self.open(s);
        self.watch(s);
        self.watch_sight(s);
        let goal = self.goal.pose().filter(|_| self.wants_plan(s));
        let replanned = goal.is_some_and(|goal| times.measure(Stage::Planning, || self.replan(goal, s)));
        let replanned = replanned || self.improved(s, times);
        let follow = times.measure(Stage::Control, || self.follower.step(&s.estimate, s.now));
        self.note_progress(&follow, s, times);
        self.wanted = self.wanted(&follow, s, times);
        let twist = times.measure(Stage::Safety, || self.guard(self.wanted, s));
        self.follower.sent(twist);
        Decision { twist, replanned }
    }

    /// The opening: nothing moves before there is a first view.
    fn open(&mut self, s: &Surroundings<'_>) {
        self.started.get_or_insert(s.now);
        if self.state == DriveState::Mapping && self.is_open(s) && self.goal.pose().is_some() {
            self.unseen.home.get_or_insert(s.estimate.pose.position());
            self.state = DriveState::Planning;
        }
    }

    /// Whether the opening is over: the robot has stood for long enough, and there is a view.
    fn is_open(&self, s: &Surroundings<'_>) -> bool {
        s.scan.is_some() && self.started.is_some_and(|started| s.now - started >= self.config.opening)
    }

    /// Whether the robot knows where it is, and whether it gets on.
    fn watch(&mut self, s: &Surroundings<'_>) {
        if self.state.is_over() {
            return;
        }
        let is_lost = matches!(self.state, DriveState::Lost { .. });
        match self.why_lost(s) {
            Some(reason) if !is_lost => {
                self.follower.halt();
                self.last_stage.reset();
                self.plan = None;
                self.state = DriveState::Lost { reason };
            }
            None if is_lost && position_sigma(&s.estimate) < 0.5 * self.config.lost_sigma => {
                self.look = LookAround::default();
                // It may have been carried here.
                self.unseen.home = None;
                self.state = DriveState::Mapping;
            }
            _ => {}
        }
        let turns_count = matches!(self.state, DriveState::Settling | DriveState::Docking)
            || self.state == DriveState::Driving
            || self.goal == Goal::Look && self.state == DriveState::Mapping;
        let stood = self.progress.standing_for(s.now, s.estimate.pose, turns_count);
        if stood > self.config.patience {
            self.give_up(stood);
        }
    }

    /// Whether the robot sees again, which saw nothing. Where a turn on the spot brings its sight back twice at one place on the way to a
    /// viewpoint, the way leads so near to something that the camera is blind there: no place to look from.
    fn watch_sight(&mut self, s: &Surroundings<'_>) {
        if self.is_blind(s) {
            return;
        }
        let is_in_vain = self.sight_watch.sees(s.estimate.pose.position());
        let waits = matches!(self.state, DriveState::Waiting { .. });
        if is_in_vain && waits && matches!(self.goal, Goal::View(_)) {
            self.follower.halt();
            self.state =
                DriveState::Stopped { reason: "the camera sees nothing on the way there".to_owned() };
        }
    }

    /// Why the robot does not know where it is, when it does not.
    fn why_lost(&self, s: &Surroundings<'_>) -> Option<String> {
        let sigma = position_sigma(&s.estimate);
        if sigma > ANYWHERE {
            let reason =
                "nothing tells where the robot is: it was carried away, or the map is of another place";
            return Some(reason.to_owned());
        }
        if sigma > self.config.lost_sigma {
            let why = if s.motion != MotionSense::Wheels {
                ": the wheels are told to roll and count nothing"
            } else {
                ""
            };
            return Some(format!("the position is only known to {sigma:.2} m{why}"));
        }
        (s.unplaced > UNPLACED).then(|| "what the camera sees is not what is there on the map".to_owned())
    }

    fn give_up(&mut self, stood: f64) {
        let why = self.state.reason().map_or_else(|| self.state.name().to_owned(), str::to_owned);
        self.follower.halt();
        self.last_stage.reset();
        self.state = DriveState::Stopped { reason: format!("no progress for {stood:.0} s: {why}") };
    }

    /// At the end of the trajectory: an arc, or turns and straight moves; or it is near enough.
    fn begin_to_settle(&mut self, s: &Surroundings<'_>) {
        self.state = DriveState::Settling;
        let Goal::Exact(goal) = self.goal else {
            self.follower.halt();
            return;
        };
        let preview = self.follower.preview_stabilization(s.estimate.pose, goal);
        self.last_stage.consider(s, goal, preview);
        self.choose(s);
    }

    /// A part of choosing how to settle.
    fn choose(&mut self, s: &Surroundings<'_>) {
        if self.last_stage.takes_over(s) {
            self.start_docking();
        }
    }

    /// What the follower's phase means for the state.
    fn note_progress(&mut self, follow: &FollowReport, s: &Surroundings<'_>, times: &mut StageTimes) {
        self.note_vantage(follow, s.now);
        let moving = matches!(self.state, DriveState::Driving | DriveState::Settling);
        match follow.phase {
            _ if !moving => {}
            FollowPhase::Settled => self.state = DriveState::Arrived,
            FollowPhase::Approaching | FollowPhase::Turning if self.state == DriveState::Driving => {
                times.measure(Stage::Planning, || self.begin_to_settle(s));
            }
            FollowPhase::Approaching | FollowPhase::Turning => {
                self.state = DriveState::Settling;
                times.measure(Stage::Planning, || self.choose(s));
            }
            FollowPhase::Tracking if follow.off_track => {
                self.is_off_track = true;
                self.plan = None;
            }
            FollowPhase::Tracking | FollowPhase::Idle => {}
        }
    }
}

/// The larger standard deviation of the position, m.
pub(crate) fn position_sigma(estimate: &PoseEstimate) -> f64 {
    let block = estimate.covariance.fixed_view::<2, 2>(0, 0);
    let (mean, half) = ((block[(0, 0)] + block[(1, 1)]) / 2.0, (block[(0, 0)] - block[(1, 1)]) / 2.0);
    (mean + half.hypot(block[(0, 1)])).max(0.0).sqrt()
}
