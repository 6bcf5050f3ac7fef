//! Report of a goal approach.

use super::end::ApproachEnd;
use serde::Serialize;
use trundle_core::Pose2;
use trundle_docking::{PositionerReason, PositionerReport};

/// Report of turns and straight moves in the final approach.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[non_exhaustive]
pub struct GoalApproachReport {
    /// Number of planned manoeuvres, including those for comparison with the arc.
    pub plans: u32,
    /// Number of begun motions.
    pub motions: u32,
    /// Number of motions interrupted by an obstacle or by the safety monitor.
    pub restarts: u32,
    /// Number of waits without a manoeuvre, or with a pose that is not finite.
    pub waits: u32,
    /// Time since the manoeuvre took over, s.
    pub time: f64,
    /// `goal_from_base` at the last check: longitudinal and lateral deviation \[m\], heading deviation \[rad\].
    pub deviation: Option<Pose2>,
    /// End of the approach; `None` while the approach runs.
    pub ended: Option<ApproachEnd>,
}

/// Activity of the positioner in the last step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum PositionerActivity {
    #[default]
    Standing,
    Planning,
    Moving,
    Waiting,
}

/// The unfinished report of a goal.
#[derive(Debug, Default)]
pub(super) struct Notes {
    pub report: GoalApproachReport,
    /// Number of successive stops without a completed motion.
    pub stops: u32,
    last: PositionerActivity,
}

impl Notes {
    /// Restarts the report when turns and straight moves begin; the plan of the comparison counts.
    pub fn restart(&mut self) {
        let plans = self.report.plans;
        *self =
            Self { report: GoalApproachReport { plans, ..GoalApproachReport::default() }, ..Self::default() };
    }

    /// Counts a stop by the safety monitor.
    pub fn interrupted(&mut self) {
        self.stops += 1;
        self.report.restarts += 1;
        self.last = PositionerActivity::Standing;
    }

    /// Counts the result of a step.
    pub fn note(&mut self, step: &PositionerReport) {
        let doing = match step.reason {
            PositionerReason::Moving(_) => PositionerActivity::Moving,
            PositionerReason::Planning => PositionerActivity::Planning,
            PositionerReason::NoWay(_) | PositionerReason::Refused(_) | PositionerReason::BadPose => {
                PositionerActivity::Waiting
            }
            _ => PositionerActivity::Standing,
        };
        let began = |what| doing == what && self.last != what;
        let (plans, moves, waits) = (
            began(PositionerActivity::Planning),
            began(PositionerActivity::Moving),
            began(PositionerActivity::Waiting),
        );
        // The result reveals a plan that was ready in the first step.
        let at_once = (moves || (waits && step.reason != PositionerReason::BadPose))
            && self.last != PositionerActivity::Planning;
        self.report.plans += u32::from(plans || at_once);
        self.report.motions += u32::from(moves);
        self.report.waits += u32::from(waits);
        self.stops += u32::from(waits);
        match (&step.reason, self.last) {
            (PositionerReason::Obstacle(_), _) => {
                self.report.restarts += 1;
                self.stops += 1;
            }
            // The motion is completed.
            (PositionerReason::Measuring, PositionerActivity::Moving) => self.stops = 0,
            _ => {}
        }
        self.last = doing;
        if step.reason != PositionerReason::BadPose {
            self.report.deviation = Some(step.error);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{Twist2, Vector2};
    use trundle_docking::{Blocker, BlockerKind, Motion};

    fn step(reason: PositionerReason) -> PositionerReport {
        PositionerReport { twist: Twist2::ZERO, reason, error: Pose2::new(0.1, 0.02, 0.0) }
    }

    fn noted(reasons: &[PositionerReason]) -> Notes {
        let mut notes = Notes::default();
        reasons.iter().for_each(|reason| notes.note(&step(reason.clone())));
        notes
    }

    fn moving() -> PositionerReason {
        PositionerReason::Moving(Motion::Turn(0.3))
    }

    fn obstacle() -> PositionerReason {
        PositionerReason::Obstacle(Blocker { thing: BlockerKind::Occupied, at: Vector2::new(1.0, 0.0) })
    }

    #[test]
    fn a_plan_and_its_motion_count_once_however_many_steps_they_take() {
        use PositionerReason::{Measuring, Planning, Settled};
        let notes = noted(&[Measuring, Planning, Planning, moving(), moving(), Measuring, Settled]);
        assert_eq!((notes.report.plans, notes.report.motions, notes.report.restarts), (1, 1, 0));
        assert_eq!((notes.report.waits, notes.stops), (0, 0));
        assert_eq!(notes.report.deviation, Some(Pose2::new(0.1, 0.02, 0.0)));
    }

    #[test]
    fn a_plan_that_is_ready_at_once_counts_as_well() {
        let notes = noted(&[PositionerReason::Measuring, moving(), PositionerReason::Measuring, moving()]);
        assert_eq!((notes.report.plans, notes.report.motions), (2, 2));
    }

    #[test]
    fn stops_in_a_row_end_with_a_motion_that_comes_to_its_end() {
        let mut notes = noted(&[moving(), obstacle(), moving(), obstacle()]);
        assert_eq!((notes.stops, notes.report.restarts), (2, 2));
        notes.interrupted();
        assert_eq!((notes.stops, notes.report.restarts), (3, 3));
        notes.note(&step(moving()));
        notes.note(&step(PositionerReason::Measuring));
        assert_eq!((notes.stops, notes.report.restarts), (0, 3), "the report keeps what happened");
    }

    #[test]
    fn a_wait_counts_once_and_a_pose_that_is_not_a_number_leaves_the_deviation() {
        let notes = noted(&[PositionerReason::NoWay(None), PositionerReason::NoWay(None)]);
        assert_eq!((notes.report.waits, notes.stops), (1, 1));
        let mut notes = noted(&[PositionerReason::Measuring]);
        let bad =
            PositionerReport { error: Pose2::new(f64::NAN, 0.0, 0.0), ..step(PositionerReason::BadPose) };
        notes.note(&bad);
        assert_eq!((notes.report.waits, notes.report.plans), (1, 0));
        assert_eq!(notes.report.deviation, Some(Pose2::new(0.1, 0.02, 0.0)));
    }

    #[test]
    fn a_second_approach_keeps_the_number_of_plans_alone() {
        let mut notes = noted(&[PositionerReason::Planning, moving(), obstacle()]);
        notes.restart();
        assert_eq!(notes.report, GoalApproachReport { plans: 1, ..GoalApproachReport::default() });
        assert_eq!(notes.stops, 0);
    }
}
