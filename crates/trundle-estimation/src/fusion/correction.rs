//! Measurements of the localizer, and their use.

use crate::fusion::pose_uncertainty::PoseUncertainty;
use nalgebra::{Matrix3, Matrix6};
use trundle_core::{Pose2, Pose3, Stamp};

/// A camera pose from visual tracking.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VisualPose {
    /// Stamp of the image.
    pub stamp: Stamp,
    /// The camera's pose in the visual frame.
    pub visual_from_camera: Pose3,
    /// Covariance as a right perturbation (m, m, m, rad, rad, rad); with zeros, only the configured noise applies.
    pub covariance: Matrix6<f64>,
    /// Quality of the pose.
    pub quality: VisualQuality,
    /// Number of the visual map of the pose: each visual map has its own frame.
    pub map: u32,
    /// Whether the tracker recognised a place in this image (a loop closure, a relocalisation, a merge of two maps). Such a pose is
    /// accepted at any distance from the prediction.
    pub recognised: bool,
}

impl VisualPose {
    /// Whether pose and covariance are finite.
    pub(crate) fn is_finite(&self) -> bool {
        self.visual_from_camera.is_finite() && self.covariance.iter().all(|v| v.is_finite())
    }
}

/// A pose of the base from a scan match.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScanPose {
    /// Stamp of the scan.
    pub stamp: Stamp,
    /// The base's pose in the map.
    pub map_from_base: Pose2,
    /// Covariance of the match as a right perturbation (m, m, rad).
    pub covariance: Matrix3<f64>,
    /// Uncertainty of the map at this pose: [`crate::MapUncertainty::at`].
    pub map: PoseUncertainty,
}

impl ScanPose {
    /// Whether pose and covariances are finite.
    pub(crate) fn is_finite(&self) -> bool {
        let PoseUncertainty { covariance, scale_error } = &self.map;
        let mut numbers = self.covariance.iter().chain(covariance).chain(scale_error);
        self.map_from_base.is_finite() && numbers.all(|v| v.is_finite())
    }
}

/// Quality of a visual pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VisualQuality {
    /// A pose from many landmarks.
    Ok,
    /// A pose from few landmarks, with larger noise.
    Weak,
}

/// Use of a measurement of the pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Correction {
    /// First visual pose of a visual map: it anchors the visual frame in the map.
    Anchored,
    /// First visual pose of a visual map while the robot's pose is too uncertain to anchor the map: ignored.
    PoseUnknown,
    /// Applied.
    Applied {
        /// Mahalanobis distance from the prediction.
        distance: f64,
    },
    /// Outside the gate: rejected.
    Gated {
        /// Mahalanobis distance from the prediction.
        distance: f64,
    },
    /// Consecutive visual poses are outside the gate, after a jump that the wheels did not measure: the visual frame moved (a loop closure,
    /// a new map). The localizer anchors `map_from_visual` again and does not change the estimate.
    Reanchored,
    /// A recognised place far from the prediction, or consecutive visual poses outside the gate without a jump: the wheels
    /// slipped, or the robot was transported. The estimate moved to the visual pose.
    Recovered {
        /// Mahalanobis distance from the prediction.
        distance: f64,
    },
    /// Older than the buffer: rejected.
    TooOld {
        /// Delay, s.
        by: f64,
    },
    /// The measurement is too far ahead of the newest odometry: rejected.
    TooNew {
        /// Time ahead of the odometry, s.
        by: f64,
    },
    /// No odometry has arrived: rejected.
    NoOdometry,
    /// Pose or covariance is not finite: rejected.
    NotFinite,
}

impl Correction {
    /// Whether the measurement changed the estimate.
    pub fn is_applied(&self) -> bool {
        matches!(self, Self::Applied { .. } | Self::Recovered { .. })
    }

    /// Whether the measurement was used: it changed the estimate or the anchor of the visual map.
    pub fn is_used(&self) -> bool {
        self.is_applied() || matches!(self, Self::Anchored | Self::Reanchored)
    }
}

/// Use of a reading of the odometry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Prediction {
    /// First reading: the estimate starts here.
    Started,
    /// The estimate moved with the odometry.
    Moved,
    /// Stamp of the last reading: no effect.
    NothingNew,
    /// Older than the last reading: rejected.
    TimeWentBack {
        /// Difference of the stamps, s.
        by: f64,
    },
    /// A number in the reading is not finite: rejected.
    NotFinite,
}
