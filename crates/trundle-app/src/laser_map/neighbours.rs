//! Poses before and after a time.

use trundle_core::Stamp;

/// Time between two poses that are interpolated \[s\]. Across a longer gap the pose is unknown. Source: ours.
pub(super) const MAX_POSE_GAP_S: f64 = 1.0;
/// Time after the last pose for which that pose still counts \[s\]. Later the pose is unknown. Source: ours.
const MAX_POSE_AGE_S: f64 = 0.1;

/// The poses before and after a time, and its share of the time between them.
pub(super) fn neighbours<T: Copy>(poses: &[(Stamp, T)], stamp: Stamp) -> Option<(T, T, f64)> {
    let after = poses.partition_point(|(at, _)| *at <= stamp);
    let (t0, a) = *poses.get(after.checked_sub(1)?)?;
    match poses.get(after) {
        Some((t1, b)) if *t1 - t0 <= MAX_POSE_GAP_S => Some((a, *b, (stamp - t0) / (*t1 - t0))),
        _ => (stamp - t0 < MAX_POSE_AGE_S).then_some((a, a, 0.0)),
    }
}
