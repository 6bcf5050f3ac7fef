use crate::LocalizerConfig;
use trundle_core::{Pose2, Stamp};

/// Watches visual poses that are not believed, to tell a visual frame that jumped from wheels that went astray.
#[derive(Debug, Clone, Default)]
pub(crate) struct Recovery {
    refused: usize,
    jumped: bool,
    last: Option<(Stamp, Pose2, Pose2)>,
}

/// What to do about a visual pose outside the gate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// Nothing yet.
    Wait,
    /// The visual frame jumped: lay it anew.
    Reanchor,
    /// The wheels went astray: believe the visual pose.
    Believe,
}

/// After this long without visual poses, s, nobody knows whether they jumped: they may have.
const BLACKOUT: f64 = 1.0;

impl Recovery {
    /// Notes a visual pose of the base and the odometry's at the same moment.
    pub(crate) fn watch(&mut self, config: &LocalizerConfig, stamp: Stamp, visual: Pose2, odometer: Pose2) {
        if let Some((since, last_visual, last_odometer)) = self.last {
            let by_eye = last_visual.inverse() * visual;
            let by_wheel = last_odometer.inverse() * odometer;
            let apart = by_wheel.inverse() * by_eye;
            self.jumped |= apart.position().norm() > config.jump_distance
                || apart.theta.abs() > config.jump_turn_deg.to_radians()
                || (stamp - since).abs() > BLACKOUT;
        }
        self.last = Some((stamp, visual, odometer));
    }

    /// A visual pose was believed.
    pub(crate) fn believed(&mut self) {
        self.refused = 0;
        self.jumped = false;
    }

    /// A visual pose was outside the gate.
    pub(crate) fn refused(&mut self, config: &LocalizerConfig) -> Verdict {
        self.refused += 1;
        if self.refused < config.recover_after {
            return Verdict::Wait;
        }
        let verdict = if self.jumped { Verdict::Reanchor } else { Verdict::Believe };
        self.believed();
        verdict
    }
}
