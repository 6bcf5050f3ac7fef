//! Measurements of the smoother, and their use.

use super::innovation::Innovation;
use nalgebra::Matrix3;
use trundle_core::{Pose2, Stamp};

/// A pose of the base measured in the map frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanarMeasurement {
    /// Stamp of the measurement.
    pub stamp: Stamp,
    /// `map_from_base`.
    pub pose: Pose2,
    /// Covariance as a right perturbation (x m, y m, theta rad).
    pub covariance: Matrix3<f64>,
}

/// Use of a measurement by the smoother.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MeasurementUse {
    /// First visual pose of a visual map: it anchors the map.
    Anchored,
    /// A factor of the window.
    Applied(Innovation),
    /// The visual pose is a recognised place, or far from the prediction: a factor with a switch.
    Switched {
        /// Agreement with the prediction.
        innovation: Innovation,
        /// Probability that the place is correct, 0 to 1.
        weight: f64,
    },
    /// Outside the gate: unused.
    Gated(Innovation),
    /// Too near another measurement of its kind with the same error: unused.
    Redundant,
    /// Older than the window: unused.
    TooOld {
        /// Time beyond the limit, s.
        by: f64,
    },
    /// Too far ahead of the newest motion: unused.
    TooNew {
        /// Time beyond the limit, s.
        by: f64,
    },
    /// No motion has arrived: unused.
    NoMotion,
    /// The window holds other visual maps: unused.
    TooManyMaps,
    /// Pose or covariance is not finite or not positive: unused.
    Invalid,
}

impl MeasurementUse {
    /// The innovation; `None` if the measurement was not compared with the estimate.
    pub fn innovation(&self) -> Option<&Innovation> {
        match self {
            Self::Applied(innovation) | Self::Gated(innovation) | Self::Switched { innovation, .. } => {
                Some(innovation)
            }
            _ => None,
        }
    }
}
