//! The choice between an arc and a manoeuvre, computed in slices while the robot follows the arc.

use crate::world_state::WorldState;
use trundle_control::StabilizerPreview;
use trundle_core::{Footprint, Pose2};
use trundle_docking::{DockingJob, DockingPlan, DockingPlanner, ObstacleScene};

/// Number of poses of an arc checked per control step. Source: ours.
const POSES_PER_STEP: usize = 100;

/// State of the comparison of the two approaches.
#[derive(Debug)]
pub(super) struct ApproachSelection {
    goal: Pose2,
    from: Pose2,
    /// The arc, and the number of its checked poses. `None` without a usable arc.
    arc: Option<(StabilizerPreview, usize)>,
    /// Obstacles around the arc.
    scene: Option<ObstacleScene>,
    planning: Option<DockingJob>,
}

/// Result of a part of the comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verdict {
    /// Undecided.
    Open,
    /// The arc.
    Arc,
    /// Turns and straight moves.
    Manoeuvre,
}

/// Inputs of both checks.
pub(super) struct ApproachContext<'a> {
    pub docker: &'a DockingPlanner,
    pub footprint: &'a Footprint,
    /// Clearance of an arc from obstacles, m.
    pub arc_margin: f64,
    /// Time at rest before the first motion and after the last, s.
    pub standing: f64,
    /// Work of planning per step, in counted steps.
    pub work: u64,
}

impl ApproachSelection {
    /// A selection between an optional arc and turns and straight moves from `from`.
    pub(super) fn new(from: Pose2, goal: Pose2, arc: Option<StabilizerPreview>) -> Self {
        Self { goal, from, arc: arc.map(|arc| (arc, 0)), scene: None, planning: None }
    }

    /// Whether the selection is for this goal and a start near this pose.
    pub(super) fn is_about(&self, pose: &Pose2, goal: &Pose2) -> bool {
        const HERE: f64 = 0.02;
        self.goal == *goal && self.from.distance(pose) < HERE
    }

    /// Whether the arc is in contact, or does not reach the goal.
    pub(super) fn is_arc_lost(&self) -> bool {
        self.arc.as_ref().is_none_or(|(arc, _)| arc.time.is_none())
    }

    /// Computes a part of the comparison. `drawn` gives the obstacles around the manoeuvre and is called once.
    pub(super) fn step(
        &mut self,
        s: &WorldState<'_>,
        means: &ApproachContext<'_>,
        scene: impl Fn() -> ObstacleScene,
    ) -> Verdict {
        if !self.is_arc_looked_at(s, means) {
            return Verdict::Open;
        }
        let planning = match self.planning.take() {
            Some(planning) => Ok(planning),
            None => {
                let margin = means.docker.config().margin;
                means.docker.begin(margin, means.footprint, &scene(), self.from, self.goal)
            }
        };
        let Ok(mut planning) = planning else { return Verdict::Arc };
        let Some(plan) = planning.advance(means.work) else {
            self.planning = Some(planning);
            return Verdict::Open;
        };
        let manoeuvre = match plan {
            DockingPlan::Found(found) => Some(found.manoeuvre.duration() + means.standing),
            DockingPlan::Impossible(_) => None,
        };
        let arc = self.arc.as_ref().and_then(|(arc, _)| arc.time);
        if arc_wins(arc, manoeuvre) { Verdict::Arc } else { Verdict::Manoeuvre }
    }

    /// Checks a part of the arc; returns whether the check is complete. An arc in contact has no duration.
    fn is_arc_looked_at(&mut self, s: &WorldState<'_>, means: &ApproachContext<'_>) -> bool {
        let Some((arc, looked)) = &mut self.arc else { return true };
        if arc.time.is_none() || *looked == arc.poses.len() {
            return true;
        }
        let scene = self.scene.get_or_insert_with(|| about(s, arc, means));
        let end = (*looked + POSES_PER_STEP).min(arc.poses.len());
        let clear = |pose: &Pose2| scene.clearance(means.footprint, pose, means.arc_margin).is_none();
        if !arc.poses[*looked..end].iter().all(clear) {
            arc.time = None;
        }
        *looked = end;
        false
    }
}

/// Obstacles of the map around an arc.
fn about(s: &WorldState<'_>, arc: &StabilizerPreview, means: &ApproachContext<'_>) -> ObstacleScene {
    let here = s.estimate.pose;
    let reach = arc.poses.iter().map(|p| p.distance(&here)).fold(0.0, f64::max);
    let half = reach + means.footprint.circumscribed_radius() + means.arc_margin + 0.1;
    ObstacleScene::from_grid(s.permitted_grid(), here.position(), half, false)
}

/// The rule: the arc wins if it is free and no manoeuvre is faster. `arc` and `manoeuvre` are durations, s; `None` if not free or not
/// found.
pub(super) fn arc_wins(arc: Option<f64>, manoeuvre: Option<f64>) -> bool {
    match (arc, manoeuvre) {
        (Some(arc), Some(manoeuvre)) => arc <= manoeuvre,
        // Without a free arc and a manoeuvre, the arc is tried under the safety monitor.
        (_, None) => true,
        (None, Some(_)) => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_faster_of_two_free_ways_is_taken() {
        assert!(arc_wins(Some(3.0), Some(5.0)));
        assert!(!arc_wins(Some(6.0), Some(5.0)));
        assert!(!arc_wins(None, Some(5.0)), "an arc that touches something");
        assert!(arc_wins(None, None) && arc_wins(Some(1.0), None));
    }
}
