//! Report of a goal approach.

use super::end::ApproachEnd;
use serde::Serialize;
use trundle_core::Pose2;
use trundle_docking::{PositionerReason, PositionerReport};

/// What turns and straight moves came to at the end of a mission.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct GoalApproachReport {
    /// How often a manoeuvre was planned, the looks beforehand included.
    pub plans: u32,
    /// Motions begun.
    pub motions: u32,
    /// Motions broken off: by an obstacle, or by the safety monitor.
    pub restarts: u32,
    /// Waits because no way was known, or the pose was no number.
    pub waits: u32,
    /// Since they took over, s.
    pub time: f64,
    /// `goal_from_base` when last looked at: longitudinal and lateral deviation (m), and of heading (rad).
    pub deviation: Option<Pose2>,
    /// How it ended; `None` while it goes on.
    pub ended: Option<ApproachEnd>,
}

/// What the positioner did in the last step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Doing {
    #[default]
    Standing,
    Planning,
    Moving,
    Waiting,
}

/// The report of a goal in the making.
#[derive(Debug, Default)]
pub(super) struct Notes {
    pub report: GoalApproachReport,
    /// In a row: none of these motions came to its end.
    pub stops: u32,
    last: Doing,
}

impl Notes {
    /// Turns and straight moves take over: what was planned before counts.
    pub fn restart(&mut self) {
        let plans = self.report.plans;
        *self =
            Self { report: GoalApproachReport { plans, ..GoalApproachReport::default() }, ..Self::default() };
    }

    /// The safety monitor stopped the robot.
    pub fn interrupted(&mut self) {
        self.stops += 1;
        self.report.restarts += 1;
        self.last = Doing::Standing;
    }

    /// Counts what a step did.
    pub fn note(&mut self, step: &PositionerReport) {
        let doing = match step.reason {
            PositionerReason::Moving(_) => Doing::Moving,
            PositionerReason::Planning => Doing::Planning,
            PositionerReason::NoWay(_) | PositionerReason::Refused(_) | PositionerReason::BadPose => {
                Doing::Waiting
            }
            PositionerReason::Measuring | PositionerReason::Obstacle(_) | PositionerReason::Settled => {
                Doing::Standing
            }
        };
        let began = |what| doing == what && self.last != what;
        let (plans, moves, waits) = (began(Doing::Planning), began(Doing::Moving), began(Doing::Waiting));
        // A plan that was ready in the step that began it shows in what came of it.
        let at_once =
            (moves || (waits && step.reason != PositionerReason::BadPose)) && self.last != Doing::Planning;
        self.report.plans += u32::from(plans || at_once);
        self.report.motions += u32::from(moves);
        self.report.waits += u32::from(waits);
        self.stops += u32::from(waits);
        match (&step.reason, self.last) {
            (PositionerReason::Obstacle(_), _) => {
                self.report.restarts += 1;
                self.stops += 1;
            }
            // It came to its end.
            (PositionerReason::Measuring, Doing::Moving) => self.stops = 0,
            _ => {}
        }
        self.last = doing;
        if step.reason != PositionerReason::BadPose {
            self.report.deviation = Some(step.error);
        }
    }
}
