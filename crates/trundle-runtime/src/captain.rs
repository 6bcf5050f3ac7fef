use crate::{
    config::RobotConfig,
    helm::Helm,
    mission::MissionState,
    navigator::{Decision, Goal, Navigator, Surroundings, Traffic},
    stage::{Stage, StageTimes},
    state::DriveState,
    supervisor::Supervisor,
};
use trundle_control::{MotionSense, SafetyScan};
use trundle_core::{Footprint, Invalid, OccupancyGrid, Pose2, PoseEstimate, Scan, Stamp, Vector2};
use trundle_planning::MovingObstacle;

/// Whoever decides: the mission's goals, plans, and the twist towards them.
#[derive(Debug)]
pub(crate) struct Captain {
    pub(crate) navigator: Navigator,
    pub(crate) supervisor: Supervisor,
}

/// Exploring, the robot keeps so much more from things than its footprint needs, m: a view is not worth a squeeze.
const EXPLORING: f64 = 0.03;

impl Captain {
    pub(crate) fn new(config: &RobotConfig, footprint: &Footprint) -> Result<Self, Invalid> {
        Ok(Self {
            navigator: Navigator::new(config, footprint)?,
            supervisor: Supervisor::new(&config.supervisor, footprint.circumscribed_radius() + EXPLORING)?,
        })
    }

    pub(crate) fn begin(&mut self, mission: &MissionState) {
        self.supervisor.begin(mission);
        if mission.left.tasks().is_empty() {
            self.navigator.take_up(Goal::Stay);
        }
    }

    /// One decision.
    pub(crate) fn step(&mut self, s: &Surroundings<'_>, times: &mut StageTimes) -> Decision {
        let (supervisor, navigator) = (&mut self.supervisor, &mut self.navigator);
        if let Some(goal) = times.measure(Stage::Supervision, || supervisor.step(s, navigator.state())) {
            navigator.take_up(goal);
        }
        navigator.step(s, times)
    }

    /// Whether the next decision may take longer than a control step has time: a plan, a look for frontiers, a search for turns
    /// and straight moves. One that is believed long and is short costs little.
    pub(crate) fn may_take_long(&self, s: &Surroundings<'_>) -> bool {
        self.supervisor.may_take_long(s, self.navigator.state()) || self.navigator.may_take_long(s)
    }

    /// What goes on as was decided last.
    pub(crate) fn helm(&self) -> Helm {
        self.navigator.helm()
    }

    /// What the robot is doing, and whether its mission is over: then the state is that of the whole mission.
    pub(crate) fn state(&self) -> (DriveState, bool) {
        let finished = self.supervisor.is_idle() && !self.supervisor.records().is_empty();
        let state = match self.supervisor.failure() {
            Some(reason) if finished => DriveState::Stopped { reason },
            None if finished => DriveState::Arrived,
            _ => self.navigator.state().clone(),
        };
        (state, finished)
    }
}

/// [`Surroundings`] that can be taken elsewhere.
#[derive(Debug)]
pub(crate) struct Around {
    now: Stamp,
    estimate: PoseEstimate,
    grid: OccupancyGrid,
    /// With `odom_from_base` when it was taken, and now.
    scan: Option<(Scan, Pose2, Pose2)>,
    seen: Option<Stamp>,
    unplaced: f64,
    motion: MotionSense,
    movers: Vec<MovingObstacle>,
    lately: Vec<Vector2>,
    still: Option<OccupancyGrid>,
}

impl From<&Surroundings<'_>> for Around {
    fn from(s: &Surroundings<'_>) -> Self {
        Self {
            now: s.now,
            estimate: s.estimate,
            grid: s.grid.clone(),
            scan: s.scan.map(|seen| (seen.scan.clone(), seen.odom_at_scan, seen.odom_now)),
            seen: s.seen,
            unplaced: s.unplaced,
            motion: s.motion,
            movers: s.traffic.movers.to_vec(),
            lately: s.traffic.lately.to_vec(),
            still: s.traffic.still.cloned(),
        }
    }
}

impl Around {
    pub(crate) fn now(&self) -> Stamp {
        self.now
    }

    pub(crate) fn surroundings(&self) -> Surroundings<'_> {
        let scan = self.scan.as_ref();
        Surroundings {
            now: self.now,
            estimate: self.estimate,
            grid: &self.grid,
            scan: scan.map(|(scan, odom_at_scan, odom_now)| SafetyScan {
                scan,
                odom_at_scan: *odom_at_scan,
                odom_now: *odom_now,
            }),
            seen: self.seen,
            unplaced: self.unplaced,
            motion: self.motion,
            traffic: Traffic { movers: &self.movers, lately: &self.lately, still: self.still.as_ref() },
        }
    }
}
