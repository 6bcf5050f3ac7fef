//! Errors of the evaluation: reasons why two trajectories or maps cannot be compared.

use std::fmt;
use thiserror::Error;
use trundle_core::{Invalid, Stamp};

/// Side of a comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The ground truth.
    Reference,
    /// The object of the evaluation.
    Estimate,
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Reference => "reference",
            Self::Estimate => "estimate",
        })
    }
}

/// Reason why two trajectories or maps cannot be compared.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum EvalError {
    /// A trajectory without a pose.
    #[error("the {0} trajectory has no pose")]
    Empty(Side),
    /// Stamps decrease.
    #[error("stamp of {side} pose {index} is {stamp} s, expected at least the {before} s of the pose before")]
    StampsGoBack {
        /// The trajectory.
        side: Side,
        /// Index of the pose, from 0.
        index: usize,
        /// Stamp of the pose.
        stamp: Stamp,
        /// Stamp of the previous pose.
        before: Stamp,
    },
    /// A pose holds NaN or infinity.
    #[error("{side} pose {index} is not finite")]
    NotFinite {
        /// The trajectory.
        side: Side,
        /// Index of the pose, from 0.
        index: usize,
    },
    /// No pose of one is near in time to a pose of the other.
    #[error(
        "no pose of the estimate ({e0} s to {e1} s) lies within {max_difference} s of a pose of the reference \
         ({r0} s to {r1} s)", e0 = estimate.0, e1 = estimate.1, r0 = reference.0, r1 = reference.1
    )]
    NoAssociation {
        /// First and last stamp of the reference.
        reference: (Stamp, Stamp),
        /// First and last stamp of the estimate.
        estimate: (Stamp, Stamp),
        /// The limit, s.
        max_difference: f64,
    },
    /// Too few poses.
    #[error("{found} associated poses, expected {needed} or more")]
    TooFewPoses {
        /// Number of poses.
        found: usize,
        /// Required number of poses.
        needed: usize,
    },
    /// The two slices to align differ in length.
    #[error("{reference} reference positions but {estimate} estimated ones")]
    LengthsDiffer {
        /// Reference positions.
        reference: usize,
        /// Estimated positions.
        estimate: usize,
    },
    /// Positions in one point or on one line leave the rotation open.
    #[error(
        "{poses} associated positions lie on a line or in a point (spread across it {spread:.1e} of that along), \
         so that no rotation aligns them better than others"
    )]
    Degenerate {
        /// Number of positions.
        poses: usize,
        /// Relative gap between the best rotation and the next, without unit.
        spread: f64,
    },
    /// No pair of poses is `delta` apart.
    #[error("no two of the {poses} associated poses are {delta} apart")]
    NoPairs {
        /// Number of poses.
        poses: usize,
        /// The requested distance.
        delta: crate::Delta,
    },
    /// No relation has poses at both of its times.
    #[error("the estimate has poses for none of the {relations} relations")]
    NoRelation {
        /// Number of relations.
        relations: usize,
    },
    /// A map without comparable obstacles.
    #[error("the {side} map has no obstacle to compare")]
    NoObstacle {
        /// The map.
        side: Side,
    },
    /// An option is out of range.
    #[error(transparent)]
    Invalid(#[from] Invalid),
}

impl EvalError {
    /// Side of the error; `None` if it concerns both sides.
    pub fn side(&self) -> Option<Side> {
        match self {
            Self::Empty(side)
            | Self::StampsGoBack { side, .. }
            | Self::NotFinite { side, .. }
            | Self::NoObstacle { side } => Some(*side),
            Self::NoRelation { .. } => Some(Side::Estimate),
            _ => None,
        }
    }
}
