//! A search that takes several control steps, while the world goes on.

use super::{Positioner, PositionerInput, Reason};
use crate::manoeuvre::{Manoeuvre, Motion};
use crate::margin::margin_of;
use crate::pace::Planning;
use crate::paper::Decision;
use crate::plan::Plan;
use crate::space::Space;
use trundle_core::{Pose2, wrap_angle};

/// What is searched for, in parts.
#[derive(Debug)]
pub(super) enum Search {
    /// A whole manoeuvre.
    Manoeuvre(Planning),
    /// The paper's next pair of motions.
    Decision(Planning<Decision>),
}

impl Positioner {
    /// Whether the robot stands elsewhere than at `from`, where its search began: a point of its outline is farther off than the
    /// tolerances and the noise of its pose explain.
    pub(super) fn is_pushed(&self, input: &PositionerInput<'_>, from: &Pose2) -> bool {
        let (tolerance, arm) = (self.tolerance(), self.footprint.circumscribed_radius());
        let noise = margin_of(&input.covariance, &self.footprint, self.config.sigmas);
        let off = from.distance(&input.pose) + arm * wrap_angle(input.pose.theta - from.theta).abs();
        off > tolerance.position + arm * tolerance.heading + noise
    }

    /// A part of a search from `pose`; once it is complete the first motion, `None` when there is nothing to do, or why there is
    /// none.
    pub(super) fn search_on(
        &mut self,
        search: &mut Search,
        input: &PositionerInput<'_>,
        pose: &Pose2,
    ) -> Option<Result<Option<Motion>, Reason>> {
        let work = self.config.step_work;
        Some(match search {
            Search::Manoeuvre(planning) => self.first_of_plan(planning.go_on(work)?, input),
            Search::Decision(planning) => self.first_of_pair(planning.go_on(work)?, input, pose),
        })
    }

    fn first_of_plan(&mut self, plan: Plan, input: &PositionerInput<'_>) -> Result<Option<Motion>, Reason> {
        match plan {
            Plan::Found(solution) => self.first_of(solution.manoeuvre, input).map(Some),
            Plan::Impossible(impossible) => Err(Reason::NoWay(impossible.by)),
        }
    }

    /// One pair at a time, as the paper has it: the turn, then the straight, then a new decision.
    fn first_of_pair(
        &mut self,
        decision: Decision,
        input: &PositionerInput<'_>,
        pose: &Pose2,
    ) -> Result<Option<Motion>, Reason> {
        let motions = match decision {
            Decision::Settled => return Ok(None),
            Decision::Stuck => return Err(Reason::NoWay(None)),
            Decision::Recover(motion) => {
                self.recoveries += 1;
                vec![motion]
            }
            Decision::Move(motions) => motions,
        };
        let pair = Manoeuvre::new(*pose, &motions, self.docker.config().limits);
        let straight = pair.steps().get(1).map(|step| step.motion);
        let first = self.first_of(pair, input)?;
        self.pending = straight;
        Ok(Some(first))
    }

    /// The first motion of a manoeuvre, if all of it is still free: what stands around may have changed since its search began.
    fn first_of(&mut self, manoeuvre: Manoeuvre, input: &PositionerInput<'_>) -> Result<Motion, Reason> {
        let mut space = Space::new(&self.footprint, -self.config.overlap, input.scene);
        let by = manoeuvre.steps().iter().find_map(|step| space.in_the_way(&step.from, step.motion));
        match by {
            Some(by) => Err(Reason::Obstacle(input.scene.named(by))),
            None => Ok(self.taken(manoeuvre)),
        }
    }
}
