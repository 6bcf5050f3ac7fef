//! The rest of a plan.

use trundle_core::{Pose2, Trajectory};

/// The rest of a plan.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Remaining {
    /// Distance along the path \[m\].
    pub distance_m: f64,
    /// Time by the plan \[s\].
    pub time_s: f64,
}

/// The rest of `plan` for a robot at `pose`: from the plan's nearest point on.
#[must_use]
pub fn remaining(plan: &Trajectory, pose: &Pose2) -> Remaining {
    let points = plan.points();
    let distance = |i: &usize| points[*i].pose.distance(pose);
    let nearest = (0..points.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let Some(left) = nearest.map(|i| &points[i..]) else { return Remaining::default() };
    let distance_m = left.windows(2).map(|pair| pair[1].pose.distance(&pair[0].pose)).sum();
    let time_s = left.last().zip(left.first()).map_or(0.0, |(last, first)| last.time - first.time);
    Remaining { distance_m, time_s }
}
