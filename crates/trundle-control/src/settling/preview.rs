use super::{SettleState, Stabilizer};
use trundle_core::{Pose2, PoseEstimate, Stamp};

/// How settling would go on a base that does what it is told.
#[derive(Debug, Clone, PartialEq)]
pub struct SettlePreview {
    /// Until the robot stands on the goal, s; `None` when it does not within the time looked at.
    pub time: Option<f64>,
    /// `map_from_base` on the way, every [`SettlePreview::STEP`] seconds, both ends with it.
    pub poses: Vec<Pose2>,
}

impl SettlePreview {
    /// The time between two poses, s.
    pub const STEP: f64 = 0.02;
    /// So far it looks ahead, s.
    const LONGEST: f64 = 20.0;
}

impl Stabilizer {
    /// Runs the law from `from` to `goal`, both in one frame, beginning anew; the stabilizer itself stays as it is.
    pub fn preview(&self, from: Pose2, goal: Pose2) -> SettlePreview {
        let mut law = self.clone();
        law.restart();
        let (mut poses, mut twist) = (vec![from], law.limiter.last());
        let steps = (SettlePreview::LONGEST / SettlePreview::STEP) as usize;
        for i in 0..steps {
            let pose = poses[poses.len() - 1];
            let covariance = nalgebra::Matrix3::zeros();
            let estimate = PoseEstimate { stamp: Stamp::default(), pose, twist, covariance };
            let report = law.step(&estimate, goal, SettlePreview::STEP);
            if report.state == SettleState::Settled {
                return SettlePreview { time: Some(i as f64 * SettlePreview::STEP), poses };
            }
            twist = report.twist;
            poses.push(pose.advance(twist, SettlePreview::STEP));
        }
        SettlePreview { time: None, poses }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SettleConfig;
    use trundle_core::{DifferentialDrive, DriveLimits};

    #[test]
    fn a_preview_ends_on_the_goal_and_changes_nothing() {
        let law =
            Stabilizer::new(SettleConfig::default(), DifferentialDrive::KOBUKI, DriveLimits::KOBUKI).unwrap();
        let goal = Pose2::new(0.3, 0.05, 0.2);
        let preview = law.preview(Pose2::IDENTITY, goal);
        let end = preview.poses[preview.poses.len() - 1];
        assert!(end.distance(&goal) < 0.01 && (end.theta - goal.theta).abs() < 0.01);
        assert!(preview.time.unwrap() > 1.0 && preview.time.unwrap() < 8.0, "{:?}", preview.time);
        assert_eq!(law.preview(Pose2::IDENTITY, goal), preview);
    }
}
