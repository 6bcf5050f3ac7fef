//! What to do from a pose measured at rest.

use super::nearly::nearly;
use super::search::Search;
use super::{Positioner, PositionerInput, Reason};
use crate::config::Method;
use crate::manoeuvre::{Manoeuvre, Motion};
use crate::margin::margin_of;
use crate::space::Space;
use trundle_core::Pose2;

/// The last centimetres and degrees: within so many tolerances of the goal.
const LAST: f64 = 5.0;

/// What comes next.
#[derive(Debug)]
pub(super) enum Next {
    /// This motion.
    Motion(Motion),
    /// The search for one.
    Search(Search),
}

impl Positioner {
    /// The next motion, or a search for it.
    pub(super) fn next_motion(&mut self, input: &PositionerInput<'_>, pose: &Pose2) -> Result<Next, Reason> {
        let method = self.docker.config().method;
        let known = match method {
            Method::Optimal => self.nearly_there(input, pose).map(|nearly| self.taken(nearly)),
            // By the paper's method the straight follows the turn, whatever was measured between.
            Method::Paper => self.pending.take(),
        };
        if let Some(motion) = known {
            return Ok(Next::Motion(motion));
        }
        let (margin, footprint, scene) = (self.margin(input), &self.footprint, input.scene);
        let search = match method {
            Method::Optimal => {
                self.docker.begin(margin, footprint, scene, *pose, self.goal).map(Search::Manoeuvre)
            }
            Method::Paper => {
                let ends = (*pose, self.goal);
                self.docker
                    .begin_decision(margin, footprint, scene, ends, self.recoveries)
                    .map(Search::Decision)
            }
        };
        search.map(Next::Search).map_err(Reason::Refused)
    }

    /// What to keep from obstacles with a pose known so well, m.
    fn margin(&self, input: &PositionerInput<'_>) -> f64 {
        let asked = margin_of(&input.covariance, &self.footprint, self.config.sigmas);
        asked.min(self.config.most_margin).max(self.docker.config().margin)
    }

    /// The first motion of a manoeuvre that is taken up. Nothing to do is a motion of nothing: it ends at once, and the pose is
    /// measured again.
    pub(super) fn taken(&mut self, manoeuvre: Manoeuvre) -> Motion {
        let first = manoeuvre.steps().first().map(|step| step.motion);
        self.plan = Some(manoeuvre);
        first.unwrap_or(Motion::Turn(0.0))
    }

    /// One or two motions that end close enough, with the margin kept; for the last centimetres, where the noise of the pose
    /// is as large as what is left, touching nothing is enough.
    fn nearly_there(&self, input: &PositionerInput<'_>, pose: &Pose2) -> Option<Manoeuvre> {
        let limits = self.docker.config().limits;
        let (tolerance, part) = (self.tolerance(), self.config.aim);
        let within = |margin: f64| {
            let mut space = Space::new(&self.footprint, margin, input.scene);
            nearly(&mut space, &limits, pose, &self.goal, &tolerance, part)
        };
        let is_last = tolerance.holds(&(self.goal.inverse() * *pose), LAST);
        let motions = within(self.margin(input))
            .or_else(|| if is_last { within(-self.config.overlap / 2.0) } else { None })?;
        Some(Manoeuvre::new(*pose, &motions, limits))
    }
}
