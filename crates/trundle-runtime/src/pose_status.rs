//! Status of the pose: the one value that planning, mapping, the station and checkpoints read.

use trundle_core::PoseEstimate;

/// The robot's knowledge of its pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PoseStatus {
    pub(crate) certainty: PoseCertainty,
    /// Two scans contradict the odometry, and neither an image nor a scan has confirmed the pose since: the robot may have been carried
    /// away, or a person stepped in front of the camera. An arrival is not certain.
    pub(crate) is_contradicted: bool,
    /// The robot is lifted, or images do not confirm a contradicted pose: scans do not enter the map.
    pub(crate) is_doubtful: bool,
}

/// Certainty of the position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum PoseCertainty {
    /// Certain enough to drive.
    Known,
    /// Certain enough to continue a drive. A lost robot stays lost.
    Weak,
    /// Too uncertain to drive.
    Uncertain {
        /// Standard deviation of the position \[m\].
        sigma: f64,
    },
    /// Unknown everywhere on the map.
    Unknown,
}

/// Standard deviation of the position \[m\] above which the position is unknown. Source: ours.
pub(crate) const UNKNOWN_POSITION_SIGMA_M: f64 = 50.0;
/// Share of the limit of a lost pose below which the pose is known again. Source: ours.
const KNOWN_AGAIN_SHARE: f64 = 0.5;

impl PoseCertainty {
    /// The certainty of an estimate that is lost above the standard deviation `lost_sigma` of its position, m.
    pub(crate) fn of(estimate: &PoseEstimate, lost_sigma: f64) -> Self {
        let sigma = estimate.position_sigma();
        if sigma > UNKNOWN_POSITION_SIGMA_M {
            Self::Unknown
        } else if sigma >= lost_sigma {
            Self::Uncertain { sigma }
        } else if sigma >= KNOWN_AGAIN_SHARE * lost_sigma {
            Self::Weak
        } else {
            Self::Known
        }
    }

    /// Whether the pose is too uncertain to drive.
    pub(crate) fn is_lost(self) -> bool {
        matches!(self, Self::Uncertain { .. } | Self::Unknown)
    }
}

impl PoseStatus {
    /// Whether scans, contacts and station light may enter the map.
    pub(crate) fn allows_mapping(&self) -> bool {
        !self.is_doubtful && !self.certainty.is_lost()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;
    use trundle_core::{Pose2, Stamp, Twist2};

    fn certainty(sigma: f64) -> PoseCertainty {
        let covariance = Matrix3::from_diagonal_element(sigma * sigma);
        let estimate =
            PoseEstimate { stamp: Stamp::default(), pose: Pose2::IDENTITY, twist: Twist2::ZERO, covariance };
        PoseCertainty::of(&estimate, 0.7)
    }

    #[test]
    fn the_certainty_follows_the_standard_deviation() {
        assert_eq!([certainty(0.0), certainty(0.34)], [PoseCertainty::Known; 2]);
        assert_eq!([certainty(0.36), certainty(0.69)], [PoseCertainty::Weak; 2]);
        let PoseCertainty::Uncertain { sigma } = certainty(0.71) else { panic!("lost") };
        assert!((sigma - 0.71).abs() < 1e-12);
        assert!(certainty(49.0).is_lost() && certainty(51.0) == PoseCertainty::Unknown);
        assert!(!certainty(0.69).is_lost() && certainty(51.0).is_lost());
    }

    #[test]
    fn a_lost_or_doubtful_pose_allows_no_mapping_and_a_contradicted_one_does() {
        let status = |sigma, is_doubtful| PoseStatus {
            certainty: certainty(sigma),
            is_contradicted: true,
            is_doubtful,
        };
        assert!(status(0.1, false).allows_mapping() && status(0.6, false).allows_mapping());
        assert!(!status(0.1, true).allows_mapping() && !status(1.0, false).allows_mapping());
    }
}
