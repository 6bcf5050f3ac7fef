//! Detection of a divergence between visual poses and odometry.

use crate::fusion::config::LocalizerConfig;
use trundle_core::{Pose2, Stamp};

/// Separates the two causes of rejected visual poses: a visual frame that jumped, or wheels that slipped.
#[derive(Debug, Clone, Default)]
pub(crate) struct DivergenceCheck {
    rejected_in_row: usize,
    has_jumped: bool,
    /// Stamp, visual pose and odometry pose of the last visual pose.
    last: Option<(Stamp, Pose2, Pose2)>,
}

/// Response to a visual pose outside the gate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DivergenceAction {
    /// Wait for more visual poses.
    Wait,
    /// The visual frame jumped: anchor it again.
    Reanchor,
    /// The odometry is wrong: accept the visual pose.
    AcceptVisual,
}

/// Longest gap between two visual poses across which a jump can be detected, s. A longer gap counts as a possible jump. Source: ours.
const MAX_VISUAL_GAP_S: f64 = 1.0;

impl DivergenceCheck {
    /// Adds a visual pose of the base and the odometry's pose at the same stamp.
    pub(crate) fn add(&mut self, config: &LocalizerConfig, stamp: Stamp, visual: Pose2, odometry: Pose2) {
        if let Some((since, last_visual, last_odometry)) = self.last {
            let by_camera = last_visual.inverse() * visual;
            let by_wheels = last_odometry.inverse() * odometry;
            let difference = by_wheels.inverse() * by_camera;
            self.has_jumped |= difference.position().norm() > config.jump_distance
                || difference.theta.abs() > config.jump_turn_deg.to_radians()
                || (stamp - since).abs() > MAX_VISUAL_GAP_S;
        }
        self.last = Some((stamp, visual, odometry));
    }

    /// Notes that a visual pose was accepted.
    pub(crate) fn on_accepted(&mut self) {
        self.rejected_in_row = 0;
        self.has_jumped = false;
    }

    /// Notes that a visual pose was outside the gate, and returns the response.
    pub(crate) fn on_rejected(&mut self, config: &LocalizerConfig) -> DivergenceAction {
        self.rejected_in_row += 1;
        if self.rejected_in_row < config.recover_after {
            return DivergenceAction::Wait;
        }
        let action =
            if self.has_jumped { DivergenceAction::Reanchor } else { DivergenceAction::AcceptVisual };
        self.on_accepted();
        action
    }
}
