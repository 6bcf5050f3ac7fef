//! The final approach: an arc, or turns and straight moves.
//!
//! In free space an arc is faster. In narrow space turns on the spot and straight moves reach the goal, exact for the footprint. Rule: the
//! arc is chosen if the simulated arc is free and no slower than the manoeuvre. Both are computed completely before the choice, in slices
//! of a control step.

mod end;
mod report;
mod selection;

use crate::schedule::Ticker;
use crate::world_state::WorldState;
pub use end::{ApproachEnd, ApproachFailure};
pub use report::GoalApproachReport;
use report::Notes;
use selection::{ApproachContext, ApproachSelection, Verdict};
use serde::{Deserialize, Serialize};
use trundle_control::StabilizerPreview;
use trundle_core::{Footprint, Invalid, Pose2, Stamp, Twist2, require_in};
use trundle_docking::{
    DockingConfig, DockingPlanner, ObstacleScene, Positioner, PositionerConfig, PositionerInput,
};

/// Settings of the final approach.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct GoalApproachConfig {
    /// Whether turns and straight moves may replace the path near the goal. Default true (ours): a goal between obstacles may have no other
    /// path.
    pub enabled: bool,
    /// Distance from the goal within which turns and straight moves may replace a path that is missing or held by the safety monitor, m,
    /// 0.05 to 5. Default 0.6 (ours).
    pub near: f64,
    /// Clearance of a free arc from obstacles of the map, m, 0 to 0.5. A larger value prefers turns and straight moves. Default 0.02
    /// (ours).
    pub arc_margin: f64,
    /// Time limit of turns and straight moves onto one goal, s, 1 to 3600. The goal is then given up. Default 120 (ours: the longest of 500
    /// corridor problems took half of it).
    pub time_limit: f64,
    /// Number of successive stops or waits without a completed motion after which the goal is given up, 1 to 1000. Default 10 (ours: at a
    /// second each, a passing person has left).
    pub max_stops: u32,
    /// Planning of turns and straight moves. Two defaults differ from the planner's. The margin is 0.05, since the safety monitor stops the
    /// robot 0.04 m before an obstacle. The work is a tenth, since the robot waits: at most 2 * 10^7 counted steps per plan, 7 s at 50 Hz.
    pub planner: DockingConfig,
    /// Execution of turns and straight moves. One default differs: 60,000 counted steps of planning per control step, 0.6 to 1 ms.
    pub positioner: PositionerConfig,
}

impl Default for GoalApproachConfig {
    fn default() -> Self {
        let mut planner = DockingConfig::default();
        planner.margin = 0.05;
        planner.max_work = 5_000_000;
        planner.plan_work = 20_000_000;
        let mut positioner = PositionerConfig::default();
        positioner.step_work = 60_000;
        Self {
            enabled: true,
            near: 0.6,
            arc_margin: 0.02,
            time_limit: 120.0,
            max_stops: 10,
            planner,
            positioner,
        }
    }
}

/// Rate at which the obstacle scene is rebuilt \[1/s\]. Source: ours.
const SCENE_RATE_HZ: f64 = 10.0;
/// Speed below which the robot counts as at rest \[m/s\]. Source: ours.
const STANDING_SPEED_M_S: f64 = 0.02;
/// Turn rate below which the robot counts as at rest \[rad/s\]. Source: ours.
const STANDING_TURN_RATE_RAD_S: f64 = 0.05;

/// Chooses between an arc and a manoeuvre, and executes the manoeuvre. The work of a step is about
/// [`PositionerConfig::step_work`], and at most twice that.
#[derive(Debug)]
pub(crate) struct GoalApproach {
    config: GoalApproachConfig,
    docker: DockingPlanner,
    footprint: Footprint,
    choice: Option<ApproachSelection>,
    positioner: Option<Positioner>,
    scene: Option<ObstacleScene>,
    scene_due: Ticker,
    began: Option<Stamp>,
    goal: Option<Pose2>,
    notes: Notes,
}

/// Progress of the manoeuvre after a step.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Progress {
    Moving(Twist2),
    Settled,
    GivenUp(ApproachFailure),
}

impl GoalApproach {
    pub(crate) fn new(config: &GoalApproachConfig, footprint: &Footprint) -> Result<Self, Invalid> {
        require_in("docking.near", config.near, "m", 0.05, 5.0)?;
        require_in("docking.arc_margin", config.arc_margin, "m", 0.0, 0.5)?;
        require_in("docking.time_limit", config.time_limit, "s", 1.0, 3600.0)?;
        require_in("docking.max_stops", f64::from(config.max_stops), "", 1.0, 1000.0)?;
        // This call checks the settings once; later positioners use the same settings.
        Positioner::new(config.planner.clone(), config.positioner, footprint.clone(), Pose2::IDENTITY)?;
        Ok(Self {
            docker: DockingPlanner::new(config.positioner.planner(config.planner.clone()))?,
            config: config.clone(),
            footprint: footprint.clone(),
            choice: None,
            positioner: None,
            scene: None,
            scene_due: Ticker::new(SCENE_RATE_HZ),
            began: None,
            goal: None,
            notes: Notes::default(),
        })
    }

    /// Report of turns and straight moves for the present goal, or for the last goal with such a request.
    pub(crate) fn report(&self) -> &GoalApproachReport {
        &self.notes.report
    }

    /// Drops the goal; the report stays available.
    pub(crate) fn reset(&mut self) {
        if self.positioner.take().is_some() {
            self.notes.report.ended.get_or_insert(ApproachEnd::BrokenOff);
        }
        self.choice = None;
    }

    /// Whether a goal is so near that turns and straight moves may replace a path.
    pub(crate) fn is_near(&self, pose: &Pose2, goal: &Pose2) -> bool {
        self.config.enabled && pose.distance(goal) <= self.config.near
    }

    /// At the end of the trajectory: begins to compare turns and straight moves with the arc of `preview`. [`GoalApproach::takes_over`]
    /// gives the result.
    pub(crate) fn consider(&mut self, s: &WorldState<'_>, goal: Pose2, preview: StabilizerPreview) {
        self.choice = None;
        if self.config.enabled {
            self.look_into(ApproachSelection::new(s.estimate.pose, goal, Some(preview)), goal);
        }
    }

    /// Whether the robot should remain at rest until the choice is made: the arc is not free.
    pub(crate) fn holds(&self) -> bool {
        self.choice.as_ref().is_some_and(ApproachSelection::is_arc_lost)
    }

    /// Computes a part of the choice begun by [`GoalApproach::consider`]; returns whether turns and straight moves are chosen.
    /// [`GoalApproach::step`] first stops a moving robot and measures its pose at rest.
    pub(crate) fn takes_over(&mut self, s: &WorldState<'_>) -> bool {
        self.verdict(s) == Verdict::Manoeuvre && self.begin()
    }

    /// Begins turns and straight moves in place of a missing path, if a manoeuvre exists. The search may take several calls.
    pub(crate) fn begin_if_possible(&mut self, s: &WorldState<'_>, goal: Pose2) -> bool {
        let pose = s.estimate.pose;
        if !self.is_near(&pose, &goal) {
            return false;
        }
        if !self.choice.as_ref().is_some_and(|choice| choice.is_about(&pose, &goal)) {
            self.look_into(ApproachSelection::new(pose, goal, None), goal);
        }
        self.takes_over(s)
    }

    /// Begins turns and straight moves onto a goal without a comparison with an arc. Returns whether the start succeeded.
    pub(crate) fn begin_at(&mut self, goal: Pose2) -> bool {
        if self.goal != Some(goal) {
            (self.goal, self.notes) = (Some(goal), Notes::default());
        }
        self.notes.report.plans += 1;
        self.begin()
    }

    fn look_into(&mut self, choice: ApproachSelection, goal: Pose2) {
        if self.goal != Some(goal) {
            (self.goal, self.notes) = (Some(goal), Notes::default());
        }
        self.notes.report.plans += 1;
        self.choice = Some(choice);
    }

    fn verdict(&mut self, s: &WorldState<'_>) -> Verdict {
        let (Some(mut choice), Some(goal)) = (self.choice.take(), self.goal) else { return Verdict::Arc };
        let means = ApproachContext {
            docker: &self.docker,
            footprint: &self.footprint,
            arc_margin: self.config.arc_margin,
            // The pose is measured before the first motion and after the last one.
            standing: 2.0 * self.config.positioner.measure_time,
            work: self.config.positioner.step_work,
        };
        let verdict = choice.step(s, &means, || self.scene_around(s, &goal));
        if verdict == Verdict::Open {
            self.choice = Some(choice);
        }
        verdict
    }

    fn begin(&mut self) -> bool {
        let Some(goal) = self.goal else { return false };
        let (planner, config) = (self.config.planner.clone(), self.config.positioner);
        self.positioner = Positioner::new(planner, config, self.footprint.clone(), goal).ok();
        (self.choice, self.began, self.scene) = (None, None, None);
        self.notes.restart();
        self.positioner.is_some()
    }

    /// Obstacles and unknown floor around the robot. Unknown floor counts because no camera covers the area behind the robot.
    fn scene_around(&self, s: &WorldState<'_>, goal: &Pose2) -> ObstacleScene {
        let (center, half) = self.config.planner.view(&self.footprint, &s.estimate.pose, goal);
        ObstacleScene::from_grid(s.permitted_grid(), center, half, true)
    }

    /// One control step of the manoeuvre.
    pub(crate) fn step(&mut self, s: &WorldState<'_>) -> Progress {
        let Some(goal) = self.positioner.as_ref().map(Positioner::goal) else {
            return Progress::GivenUp(ApproachFailure::NoGoal);
        };
        let began = *self.began.get_or_insert(s.now);
        self.notes.report.time = s.now - began;
        if self.notes.report.time > self.config.time_limit {
            return self.given_up(ApproachFailure::Timeout { limit: self.config.time_limit });
        }
        if self.notes.report.motions == 0 && !stands(s.estimate.twist) {
            return Progress::Moving(Twist2::ZERO);
        }
        if self.scene_due.due(s.now) || self.scene.is_none() {
            self.scene = Some(self.scene_around(s, &goal));
        }
        let (Some(positioner), Some(scene)) = (&mut self.positioner, &self.scene) else {
            return Progress::Moving(Twist2::ZERO);
        };
        let (pose, covariance) = (s.estimate.pose, s.estimate.covariance);
        let report = positioner.step(&PositionerInput { stamp: s.now, pose, covariance, scene });
        self.notes.note(&report);
        if positioner.is_settled() {
            self.notes.report.ended = Some(ApproachEnd::Settled);
            return Progress::Settled;
        }
        if self.notes.stops > self.config.max_stops {
            return self.given_up(ApproachFailure::Positioner(report.reason));
        }
        Progress::Moving(report.twist)
    }

    fn given_up(&mut self, failure: ApproachFailure) -> Progress {
        self.positioner = None;
        self.notes.report.ended = Some(ApproachEnd::GivenUp(failure.clone()));
        Progress::GivenUp(failure)
    }

    /// Records that the safety monitor stopped the robot.
    pub(crate) fn interrupted(&mut self, s: &WorldState<'_>) {
        if let Some(positioner) = &mut self.positioner {
            positioner.interrupted(s.now);
            self.notes.interrupted();
        }
    }
}

fn stands(twist: Twist2) -> bool {
    twist.v.abs() < STANDING_SPEED_M_S && twist.omega.abs() < STANDING_TURN_RATE_RAD_S
}

#[cfg(test)]
mod tests;
