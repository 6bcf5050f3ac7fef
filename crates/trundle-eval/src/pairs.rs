//! Pairs of poses for relative errors: a fixed time, number of poses or distance apart.

use serde::{Deserialize, Serialize};
use std::fmt;
use trundle_core::{Invalid, Pose3, Stamp, require_positive};

/// Smallest number of frames at which a delta is refused: more than a trajectory has. Source: ours.
const MAX_FRAMES: f64 = 1e9;

/// Distance between the two poses of a relative error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Delta {
    /// Number of associated poses between both; 1 or more.
    Frames(usize),
    /// The first pose at least that many seconds later; above 0.
    Seconds(f64),
    /// The first pose after at least that many metres along the estimate; above 0.
    Metres(f64),
}

/// Unit of the length of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DeltaUnit {
    /// Poses.
    Frames,
    /// Seconds.
    Seconds,
    /// Metres along the estimate.
    Metres,
}

impl DeltaUnit {
    /// The choices of a front end: name, help text, value.
    pub const CHOICES: [(&'static str, &'static str, Self); 3] = [
        ("frames", "Poses", Self::Frames),
        ("s", "Seconds", Self::Seconds),
        ("m", "Metres along the estimate", Self::Metres),
    ];
}

impl fmt::Display for Delta {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Frames(n) => write!(f, "{n} frames"),
            Self::Seconds(s) => write!(f, "{s} s"),
            Self::Metres(m) => write!(f, "{m} m"),
        }
    }
}

impl Delta {
    /// A delta of this length in this unit.
    ///
    /// # Errors
    /// When the length is not above 0, or a number of frames is not whole.
    pub fn of(length: f64, unit: DeltaUnit) -> Result<Self, Invalid> {
        match unit {
            DeltaUnit::Frames if length.fract() == 0.0 && (1.0..MAX_FRAMES).contains(&length) => {
                Ok(Self::Frames(length as usize))
            }
            DeltaUnit::Frames => Err(Invalid::new("delta", length, "frames", "a whole number from 1 on")),
            DeltaUnit::Seconds => Self::Seconds(length).validated(),
            DeltaUnit::Metres => Self::Metres(length).validated(),
        }
    }

    /// Passes a valid delta through.
    ///
    /// # Errors
    /// When the distance is zero, negative or not finite.
    pub fn validated(self) -> Result<Self, Invalid> {
        match self {
            Self::Frames(0) => return Err(Invalid::new("delta", 0, "frames", "1 or more")),
            Self::Frames(_) => {}
            Self::Seconds(s) => drop(require_positive("delta", s, "s")?),
            Self::Metres(m) => drop(require_positive("delta", m, "m")?),
        }
        Ok(self)
    }

    /// Index pairs (from, to) `self` apart: every start when `all`, else chained end to start as evo does.
    pub(crate) fn pairs(self, poses: &[(Stamp, Pose3)], all: bool) -> Vec<(usize, usize)> {
        match self {
            Self::Frames(n) => {
                let step = if all { 1 } else { n };
                let last = poses.len().saturating_sub(n);
                (0..last).step_by(step).map(|i| (i, i + n)).collect()
            }
            Self::Seconds(s) => chain(poses.len(), all, |i, j| poses[j].0 - poses[i].0 >= s),
            Self::Metres(m) => metres(poses, m, all),
        }
    }
}

/// Pairs by the distance travelled.
fn metres(poses: &[(Stamp, Pose3)], delta: f64, all: bool) -> Vec<(usize, usize)> {
    let mut distance = Vec::with_capacity(poses.len());
    let mut sum = 0.0;
    for (i, (_, pose)) in poses.iter().enumerate() {
        sum += if i == 0 { 0.0 } else { (pose.translation - poses[i - 1].1.translation).norm() };
        distance.push(sum);
    }
    chain(poses.len(), all, |i, j| distance[j] - distance[i] >= delta)
}

/// Pairs (i, first j with `far(i, j)`), `far` being monotone in j: from every i when `all`, else from each j on.
fn chain(len: usize, all: bool, far: impl Fn(usize, usize) -> bool) -> Vec<(usize, usize)> {
    let (mut pairs, mut i, mut j) = (Vec::new(), 0, 0);
    while i < len {
        j = j.max(i);
        while j < len && !far(i, j) {
            j += 1;
        }
        if j == len {
            break;
        }
        pairs.push((i, j));
        i = if all { i + 1 } else { j };
    }
    pairs
}
