//! What to do from a pose measured at rest.

use super::nearly::nearly;
use super::{Positioner, PositionerInput, Reason};
use crate::config::Method;
use crate::manoeuvre::{Manoeuvre, Motion};
use crate::margin::margin_of;
use crate::paper::{Decision, PaperMethod};
use crate::planner::Plan;
use crate::space::Space;
use trundle_core::Pose2;

/// The last centimetres and degrees: within so many tolerances of the goal.
const LAST: f64 = 5.0;

impl Positioner {
    /// The next motion; none when nothing is left to do.
    pub(super) fn next_motion(
        &mut self,
        input: &PositionerInput<'_>,
        pose: &Pose2,
    ) -> Result<Option<Motion>, Reason> {
        match self.docker.config().method {
            Method::Optimal => self.next_of_plan(input, pose).map(Some),
            Method::Paper => self.next_of_paper(input, pose),
        }
    }

    /// What to keep from obstacles with a pose known so well, m.
    fn margin(&self, input: &PositionerInput<'_>) -> f64 {
        let asked = margin_of(&input.covariance, &self.footprint, self.config.sigmas);
        asked.min(self.config.most_margin).max(self.docker.config().margin)
    }

    fn next_of_plan(&mut self, input: &PositionerInput<'_>, pose: &Pose2) -> Result<Motion, Reason> {
        let limits = self.docker.config().limits;
        let margin = self.margin(input);
        let motions = match self.nearly_there(input, pose, margin) {
            Some(motions) => Manoeuvre::new(*pose, &motions, limits),
            None => {
                let plan = self.docker.plan_keeping(margin, &self.footprint, input.scene, *pose, self.goal);
                match plan.map_err(Reason::Refused)? {
                    Plan::Found(solution) => solution.manoeuvre,
                    Plan::Impossible(impossible) => return Err(Reason::NoWay(impossible.by)),
                }
            }
        };
        let first = motions.steps().first().map(|step| step.motion);
        self.plan = Some(motions);
        // Nothing to do is a motion of nothing: it ends at once, and the pose is measured again.
        Ok(first.unwrap_or(Motion::Turn(0.0)))
    }

    /// One or two motions that end close enough, with the margin kept; for the last centimetres, where the noise of the pose
    /// is as large as what is left, touching nothing is enough.
    fn nearly_there(&self, input: &PositionerInput<'_>, pose: &Pose2, margin: f64) -> Option<Vec<Motion>> {
        let limits = self.docker.config().limits;
        let (tolerance, part) = (self.tolerance(), self.config.aim);
        let within = |margin: f64| {
            let mut space = Space::new(&self.footprint, margin, input.scene);
            nearly(&mut space, &limits, pose, &self.goal, &tolerance, part)
        };
        let is_last = tolerance.holds(&(self.goal.inverse() * *pose), LAST);
        within(margin).or_else(|| if is_last { within(-self.config.overlap / 2.0) } else { None })
    }

    /// One pair at a time, as the paper has it: the turn, then the straight, then a new decision.
    fn next_of_paper(&mut self, input: &PositionerInput<'_>, pose: &Pose2) -> Result<Option<Motion>, Reason> {
        if let Some(motion) = self.pending.take() {
            return Ok(Some(motion));
        }
        let config = self.docker.config();
        let margin = self
            .docker
            .checked(self.margin(input), &self.footprint, input.scene, pose, &self.goal)
            .map_err(Reason::Refused)?;
        let space = Space::new(&self.footprint, margin, input.scene);
        let method = PaperMethod { space: &space, limits: config.limits, config: &config.paper };
        let motions = match method.decide(pose, &self.goal, self.recoveries) {
            Decision::Settled => return Ok(None),
            Decision::Stuck => return Err(Reason::NoWay(None)),
            Decision::Recover(motion) => {
                self.recoveries += 1;
                vec![motion]
            }
            Decision::Move(motions) => motions,
        };
        let pair = Manoeuvre::new(*pose, &motions, config.limits);
        let mut steps = pair.steps().iter().map(|step| step.motion);
        let first = steps.next();
        self.pending = steps.next();
        self.plan = Some(pair);
        Ok(Some(first.unwrap_or(Motion::Turn(0.0))))
    }
}
