//! Simulates point stabilisation before the drive.

use crate::stabilization::stabilizer::{Stabilizer, StabilizerPhase};
use trundle_core::{Pose2, PoseEstimate, Stamp};

/// Point stabilisation simulated on a base that follows every command exactly.
#[derive(Debug, Clone, PartialEq)]
pub struct StabilizerPreview {
    /// Time until the robot rests on the goal, s; `None` if it does not within the horizon.
    pub time: Option<f64>,
    /// `map_from_base` every [`StabilizerPreview::STEP_S`] seconds, including both ends.
    pub poses: Vec<Pose2>,
}

impl StabilizerPreview {
    /// Time between two poses, s. Larger: a coarser preview. Source: the control period.
    pub const STEP_S: f64 = 0.02;
    /// Longest time that is simulated, s. Larger: slower motions are shown whole, at more cost. Source: ours.
    const HORIZON_S: f64 = 20.0;
}

impl Stabilizer {
    /// Runs the law from `from` to `goal`, both in one frame, from a restart; the stabilizer itself does not change.
    pub fn preview(&self, from: Pose2, goal: Pose2) -> StabilizerPreview {
        let mut law = self.clone();
        law.restart();
        let (mut poses, mut twist) = (vec![from], law.limiter.last());
        let steps = (StabilizerPreview::HORIZON_S / StabilizerPreview::STEP_S) as usize;
        for i in 0..steps {
            let pose = poses[poses.len() - 1];
            let covariance = nalgebra::Matrix3::zeros();
            let estimate = PoseEstimate { stamp: Stamp::default(), pose, twist, covariance };
            let report = law.step(&estimate, goal, StabilizerPreview::STEP_S);
            if report.phase == StabilizerPhase::Settled {
                return StabilizerPreview { time: Some(i as f64 * StabilizerPreview::STEP_S), poses };
            }
            twist = report.twist;
            poses.push(pose.advance(twist, StabilizerPreview::STEP_S));
        }
        StabilizerPreview { time: None, poses }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stabilization::stabilizer_config::StabilizerConfig;
    use trundle_core::{DifferentialDrive, DriveLimits};

    #[test]
    fn a_preview_ends_on_the_goal_and_leaves_the_stabilizer_as_it_is() {
        let law =
            Stabilizer::new(StabilizerConfig::default(), DifferentialDrive::KOBUKI, DriveLimits::KOBUKI)
                .unwrap();
        let goal = Pose2::new(0.3, 0.05, 0.2);
        let preview = law.preview(Pose2::IDENTITY, goal);
        let end = preview.poses[preview.poses.len() - 1];
        assert!(end.distance(&goal) < 0.01 && (end.theta - goal.theta).abs() < 0.01);
        assert!(preview.time.unwrap() > 1.0 && preview.time.unwrap() < 8.0, "{:?}", preview.time);
        assert_eq!(law.preview(Pose2::IDENTITY, goal), preview);
    }
}
