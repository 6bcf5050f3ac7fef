//! What to do from a pose measured at rest.

use super::nearly::nearly;
use super::{Positioner, PositionerInput, Reason};
use crate::config::Method;
use crate::manoeuvre::{Manoeuvre, Motion};
use crate::margin::margin_of;
use crate::pace::Planning;
use crate::paper::{Decision, PaperMethod};
use crate::planner::Plan;
use crate::space::Space;
use trundle_core::Pose2;

/// The last centimetres and degrees: within so many tolerances of the goal.
const LAST: f64 = 5.0;

/// What comes next.
#[derive(Debug)]
pub(super) enum Next {
    /// This motion.
    Motion(Motion),
    /// The search for a manoeuvre.
    Search(Planning),
    /// Nothing is left to do.
    Nothing,
}

impl Positioner {
    /// The next motion, or a search for it.
    pub(super) fn next_motion(&mut self, input: &PositionerInput<'_>, pose: &Pose2) -> Result<Next, Reason> {
        match self.docker.config().method {
            Method::Optimal => self.next_of_plan(input, pose),
            Method::Paper => self.next_of_paper(input, pose),
        }
    }

    /// What to keep from obstacles with a pose known so well, m.
    fn margin(&self, input: &PositionerInput<'_>) -> f64 {
        let asked = margin_of(&input.covariance, &self.footprint, self.config.sigmas);
        asked.min(self.config.most_margin).max(self.docker.config().margin)
    }

    fn next_of_plan(&mut self, input: &PositionerInput<'_>, pose: &Pose2) -> Result<Next, Reason> {
        let margin = self.margin(input);
        if let Some(motions) = self.nearly_there(input, pose, margin) {
            let nearly = Manoeuvre::new(*pose, &motions, self.docker.config().limits);
            return Ok(Next::Motion(self.taken(nearly)));
        }
        let search = self.docker.begin(margin, &self.footprint, input.scene, *pose, self.goal);
        search.map(Next::Search).map_err(Reason::Refused)
    }

    /// The first motion of a plan.
    pub(super) fn first_of(&mut self, plan: Plan) -> Result<Motion, Reason> {
        match plan {
            Plan::Found(solution) => Ok(self.taken(solution.manoeuvre)),
            Plan::Impossible(impossible) => Err(Reason::NoWay(impossible.by)),
        }
    }

    /// The first motion of a manoeuvre that is taken up. Nothing to do is a motion of nothing: it ends at once, and the pose is
    /// measured again.
    fn taken(&mut self, manoeuvre: Manoeuvre) -> Motion {
        let first = manoeuvre.steps().first().map(|step| step.motion);
        self.plan = Some(manoeuvre);
        first.unwrap_or(Motion::Turn(0.0))
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
    fn next_of_paper(&mut self, input: &PositionerInput<'_>, pose: &Pose2) -> Result<Next, Reason> {
        if let Some(motion) = self.pending.take() {
            return Ok(Next::Motion(motion));
        }
        let config = self.docker.config();
        let margin = self
            .docker
            .checked(self.margin(input), &self.footprint, input.scene, pose, &self.goal)
            .map_err(Reason::Refused)?;
        let space = Space::new(&self.footprint, margin, input.scene);
        let method = PaperMethod { space: &space, limits: config.limits, config: &config.paper };
        let motions = match method.decide(pose, &self.goal, self.recoveries) {
            Decision::Settled => return Ok(Next::Nothing),
            Decision::Stuck => return Err(Reason::NoWay(None)),
            Decision::Recover(motion) => {
                self.recoveries += 1;
                vec![motion]
            }
            Decision::Move(motions) => motions,
        };
        let pair = Manoeuvre::new(*pose, &motions, config.limits);
        self.pending = pair.steps().get(1).map(|step| step.motion);
        Ok(Next::Motion(self.taken(pair)))
    }
}
