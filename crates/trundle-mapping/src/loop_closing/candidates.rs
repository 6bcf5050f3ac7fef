//! Earlier stretches of the trajectory that the robot may have returned to.

use crate::pose_graph::RelativeUncertainty;
use nalgebra::Matrix2;
use std::ops::Range;
use trundle_core::Pose2;

/// An earlier part of the trajectory that the robot may be near.
#[derive(Debug, Clone)]
pub(crate) struct Candidate {
    /// Poses of the stretch.
    pub(crate) range: Range<usize>,
    /// The pose that is most likely near.
    pub(crate) nearest: usize,
    /// Distance of the candidate, in standard deviations.
    pub(crate) distance: f64,
    /// Uncertainty of the robot's pose relative to the candidate.
    pub(crate) reached: RelativeUncertainty,
}

/// Minimum path length of a loop \[m\]. Shorter loops are within the map of one particle. Source: ours.
const MIN_LOOP_LENGTH_M: f64 = 20.0;
/// Distance between two poses that observe the same place \[m\]. Source: ours.
const VIEW_RADIUS_M: f64 = 4.0;
/// Maximum radius of a loop search \[m\]: the drift of one minute of failing odometry. Source: ours.
pub(crate) const MAX_SEARCH_RADIUS_M: f64 = 40.0;

/// The parts of the trajectory that may be near the last pose, the likeliest first. `lengths` are the distances travelled up to each pose, m.
pub(crate) fn candidates(
    poses: &[Pose2],
    lengths: &[f64],
    reached: &[Option<RelativeUncertainty>],
) -> Vec<Candidate> {
    let last = poses.len() - 1;
    let mut found: Vec<Candidate> = Vec::new();
    for k in 0..last {
        if lengths[last] - lengths[k] < MIN_LOOP_LENGTH_M {
            break;
        }
        let Some((distance, reached)) = feasible(poses[k], poses[last], reached[k]) else { continue };
        match found.last_mut().filter(|c| c.range.end == k) {
            Some(stretch) => {
                stretch.range.end = k + 1;
                if distance < stretch.distance {
                    (stretch.nearest, stretch.distance, stretch.reached) = (k, distance, reached);
                }
            }
            None => found.push(Candidate { range: k..k + 1, nearest: k, distance, reached }),
        }
    }
    found.sort_by(|a, b| a.distance.total_cmp(&b.distance).then(b.nearest.cmp(&a.nearest)));
    found
}

/// Distance of a pose in standard deviations; `None` if it is too large.
fn feasible(
    pose: Pose2,
    last: Pose2,
    reached: Option<RelativeUncertainty>,
) -> Option<(f64, RelativeUncertainty)> {
    let reached = reached?;
    let off = last.position() - pose.position();
    if off.norm() > MAX_SEARCH_RADIUS_M {
        return None;
    }
    let drift: Matrix2<f64> = reached.covariance.fixed_view::<2, 2>(0, 0).into();
    let spread = drift + Matrix2::identity() * (VIEW_RADIUS_M / 3.0_f64).powi(2);
    let distance = off.dot(&(spread.try_inverse()? * off)).sqrt();
    (distance < 3.0).then_some((distance, reached))
}
