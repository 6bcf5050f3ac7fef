use nalgebra::Matrix6;
use trundle_core::{Pose3, Stamp};

/// A pose that visual tracking found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VisualPose {
    /// Of the image.
    pub stamp: Stamp,
    /// The camera's pose in the visual frame.
    pub visual_from_camera: Pose3,
    /// Its covariance as a right perturbation (m, m, m, rad, rad, rad); zeros leave the configured noise alone.
    pub covariance: Matrix6<f64>,
    /// How well it was found.
    pub quality: VisualQuality,
    /// The visual map that it is in: each has a frame of its own.
    pub map: u32,
    /// Whether a place was recognised in this image (a loop, a relocalisation, two maps that became one). Then the pose is
    /// believed however far off it is: the odometry knows no better.
    pub recognised: bool,
}

/// How well a visual pose was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VisualQuality {
    /// As usual.
    Ok,
    /// By few landmarks: it counts less.
    Weak,
}

/// What became of a measurement of the pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Correction {
    /// The first visual pose of a visual map: it only says where the visual frame lies in the map.
    Anchored,
    /// The first visual pose of a visual map, while the place is too uncertain to lay a map by it: ignored.
    Nowhere,
    /// Taken in.
    Applied {
        /// Mahalanobis distance from the prediction.
        distance: f64,
    },
    /// Too far from the prediction to be believed: ignored.
    Gated {
        /// Mahalanobis distance from the prediction.
        distance: f64,
    },
    /// Many visual poses in a row were too far off, and they began to be with a jump that the wheels know nothing of: the
    /// visual frame moved (a loop closure, a new map). `map_from_visual` was set anew; the estimate stays.
    Reanchored,
    /// A place was recognised far from the prediction, or many visual poses in a row were too far off without ever having
    /// jumped: the wheels went astray, or the robot was carried. The estimate moved to the visual pose.
    Recovered {
        /// Mahalanobis distance from the prediction.
        distance: f64,
    },
    /// From before the history that is kept.
    TooOld {
        /// By how much, s.
        by: f64,
    },
    /// Too far ahead of the newest odometry.
    TooNew {
        /// By how much, s.
        by: f64,
    },
    /// There was no odometry yet.
    NoOdometry,
    /// The pose or its covariance is not finite.
    NotFinite,
}

impl Correction {
    /// Whether the estimate took the measurement in.
    pub fn is_applied(&self) -> bool {
        matches!(self, Self::Applied { .. } | Self::Recovered { .. })
    }
}

/// What became of a reading of the odometry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Prediction {
    /// The first one: the estimate starts here.
    Started,
    /// The estimate moved with it.
    Moved,
    /// Of the same time as the one before: nothing happened since.
    NothingNew,
    /// Older than the one before: ignored.
    TimeWentBack {
        /// By how much, s.
        by: f64,
    },
    /// A number in it is not finite: ignored.
    NotFinite,
}
