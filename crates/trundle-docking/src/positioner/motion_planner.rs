//! The next motion from a pose measured at rest, and the search for it over several control steps.

use crate::contact_space::ContactSpace;
use crate::docking_config::Method;
use crate::docking_plan::DockingPlan;
use crate::hong24::decide::Decision;
use crate::motion::manoeuvre::{Manoeuvre, Motion};
use crate::planner::{DockingJob, DockingPlanner};
use crate::pose_margin::margin_of;
use crate::positioner::config::PositionerConfig;
use crate::positioner::near_goal::{Tolerance, nearly};
use crate::positioner::report::{PositionerInput, PositionerReason};
use crate::work_budget::PlanningJob;
use trundle_core::{Footprint, Pose2, wrap_angle};

/// Number of tolerances around the goal within which motions need no margin. Source: ours.
const NO_MARGIN_TOLERANCES: f64 = 5.0;

/// The next action.
#[derive(Debug)]
pub(super) enum Next {
    /// A motion.
    Motion(Motion),
    /// The search for a motion.
    Search(MotionSearch),
}

/// The search in parts.
#[derive(Debug)]
pub(super) enum MotionSearch {
    /// For a whole manoeuvre.
    Manoeuvre(DockingJob),
    /// For the next pair of motions of \[Hong24\].
    Decision(PlanningJob<Decision>),
}

/// Plans the next motion onto one goal.
#[derive(Debug)]
pub(super) struct MotionPlanner {
    pub(super) planner: DockingPlanner,
    pub(super) config: PositionerConfig,
    pub(super) footprint: Footprint,
    pub(super) goal: Pose2,
    /// The last manoeuvre.
    pub(super) plan: Option<Manoeuvre>,
    /// \[Hong24\]: the straight move that follows the turn.
    pub(super) pending: Option<Motion>,
    /// \[Hong24\]: the number of recovery moves.
    pub(super) recoveries: usize,
}

impl MotionPlanner {
    pub(super) fn tolerance(&self) -> Tolerance {
        let config = self.planner.config();
        Tolerance { position: config.position_tolerance, heading: config.heading_tolerance }
    }

    /// The next motion, or a search for it.
    pub(super) fn next_motion(
        &mut self,
        input: &PositionerInput<'_>,
        pose: &Pose2,
    ) -> Result<Next, PositionerReason> {
        let method = self.planner.config().method;
        let known = match method {
            Method::Optimal => self.nearly_there(input, pose).map(|nearly| self.taken(nearly)),
            // \[Hong24\]: the straight move follows the turn without a new decision.
            Method::Hong24 => self.pending.take(),
        };
        if let Some(motion) = known {
            return Ok(Next::Motion(motion));
        }
        let (margin, footprint, scene) = (self.margin(input), &self.footprint, input.scene);
        let search = match method {
            Method::Optimal => {
                self.planner.begin(margin, footprint, scene, *pose, self.goal).map(MotionSearch::Manoeuvre)
            }
            Method::Hong24 => {
                let ends = (*pose, self.goal);
                self.planner
                    .start_decision(margin, footprint, scene, ends, self.recoveries)
                    .map(MotionSearch::Decision)
            }
        };
        search.map(Next::Search).map_err(PositionerReason::Refused)
    }

    /// The margin for a pose of this uncertainty, m.
    fn margin(&self, input: &PositionerInput<'_>) -> f64 {
        let asked = margin_of(&input.covariance, &self.footprint, self.config.sigmas);
        asked.min(self.config.max_margin).max(self.planner.config().margin)
    }

    /// The first motion of an accepted manoeuvre. An empty manoeuvre gives an empty motion: it ends immediately, and the pose is measured
    /// again.
    pub(super) fn taken(&mut self, manoeuvre: Manoeuvre) -> Motion {
        let first = manoeuvre.steps().first().map(|step| step.motion);
        self.plan = Some(manoeuvre);
        first.unwrap_or(Motion::Turn(0.0))
    }

    /// One or two motions that end close enough, with the margin; without a margin near the goal, because the noise of the pose is as large
    /// as the error there.
    fn nearly_there(&self, input: &PositionerInput<'_>, pose: &Pose2) -> Option<Manoeuvre> {
        let limits = self.planner.config().limits;
        let (tolerance, part) = (self.tolerance(), self.config.aim);
        let within = |margin: f64| {
            let mut space = ContactSpace::new(&self.footprint, margin, input.scene);
            nearly(&mut space, &limits, pose, &self.goal, &tolerance, part)
        };
        let is_last = tolerance.holds(&(self.goal.inverse() * *pose), NO_MARGIN_TOLERANCES);
        let motions = within(self.margin(input))
            .or_else(|| if is_last { within(-self.config.overlap / 2.0) } else { None })?;
        Some(Manoeuvre::new(*pose, &motions, limits))
    }

    /// Whether the robot was pushed since its search began at `from`: the motion of a footprint point exceeds the tolerances and the noise
    /// of the pose.
    pub(super) fn is_pushed(&self, input: &PositionerInput<'_>, from: &Pose2) -> bool {
        let (tolerance, arm) = (self.tolerance(), self.footprint.circumscribed_radius());
        let noise = margin_of(&input.covariance, &self.footprint, self.config.sigmas);
        let off = from.distance(&input.pose) + arm * wrap_angle(input.pose.theta - from.theta).abs();
        off > tolerance.position + arm * tolerance.heading + noise
    }

    /// Continues a search from `pose`. Once complete, returns the first motion, `None` at the goal, or the reason for a missing manoeuvre.
    pub(super) fn search_on(
        &mut self,
        search: &mut MotionSearch,
        input: &PositionerInput<'_>,
        pose: &Pose2,
    ) -> Option<Result<Option<Motion>, PositionerReason>> {
        let work = self.config.step_work;
        Some(match search {
            MotionSearch::Manoeuvre(planning) => self.first_of_plan(planning.advance(work)?, input),
            MotionSearch::Decision(planning) => self.first_of_pair(planning.advance(work)?, input, pose),
        })
    }

    fn first_of_plan(
        &mut self,
        plan: DockingPlan,
        input: &PositionerInput<'_>,
    ) -> Result<Option<Motion>, PositionerReason> {
        match plan {
            DockingPlan::Found(solution) => self.first_of(solution.manoeuvre, input).map(Some),
            DockingPlan::Impossible(impossible) => Err(PositionerReason::NoWay(impossible.by)),
        }
    }

    /// One pair per decision, as in \[Hong24\]: the turn, then the straight move.
    fn first_of_pair(
        &mut self,
        decision: Decision,
        input: &PositionerInput<'_>,
        pose: &Pose2,
    ) -> Result<Option<Motion>, PositionerReason> {
        let motions = match decision {
            Decision::Settled => return Ok(None),
            Decision::Stuck => return Err(PositionerReason::NoWay(None)),
            Decision::Recover(motion) => {
                self.recoveries += 1;
                vec![motion]
            }
            Decision::Move(motions) => motions,
        };
        let pair = Manoeuvre::new(*pose, &motions, self.planner.config().limits);
        let straight = pair.steps().get(1).map(|step| step.motion);
        let first = self.first_of(pair, input)?;
        self.pending = straight;
        Ok(Some(first))
    }

    /// The first motion of a manoeuvre, if the whole manoeuvre is free: obstacles may have moved since its search began.
    fn first_of(
        &mut self,
        manoeuvre: Manoeuvre,
        input: &PositionerInput<'_>,
    ) -> Result<Motion, PositionerReason> {
        let mut space = ContactSpace::new(&self.footprint, -self.config.overlap, input.scene);
        let by = manoeuvre.steps().iter().find_map(|step| space.blocker_of(&step.from, step.motion));
        match by {
            Some(by) => Err(PositionerReason::Obstacle(input.scene.named(by))),
            None => Ok(self.taken(manoeuvre)),
        }
    }
}
