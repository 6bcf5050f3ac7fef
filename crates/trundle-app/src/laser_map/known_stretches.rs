//! The stretches of a log over which the pose is known, and the trajectory along them.

use trundle_core::{Pose2, Stamp};
use trundle_mapping::propagated_poses;

/// Stretches without a pose: from the first scan without one to the next with one.
#[derive(Debug, Default)]
pub struct KnownStretches {
    gaps: Vec<(Stamp, Option<Stamp>)>,
}

impl KnownStretches {
    /// Notes that the pose is unknown from `since` on.
    pub fn lose(&mut self, since: Stamp) {
        if self.is_known() {
            self.gaps.push((since, None));
        }
    }

    /// Notes that the pose is known again at `stamp`.
    pub fn find(&mut self, stamp: Stamp) {
        if let Some((_, until @ None)) = self.gaps.last_mut() {
            *until = Some(stamp);
        }
    }

    /// Whether the pose is known at the last noted stamp.
    pub fn is_known(&self) -> bool {
        self.gaps.last().is_none_or(|(_, until)| until.is_some())
    }

    /// The poses at all stamps of `odometry` from those of some of them, as [`propagated_poses`] gives them, without the
    /// stamps in a gap. A stretch ends with its last processed scan.
    pub fn trajectory<'a>(
        &self,
        processed: &'a [(Stamp, Pose2)],
        odometry: &'a [(Stamp, Pose2)],
    ) -> impl Iterator<Item = (Stamp, Pose2)> + use<'a> {
        let mut stretches = Vec::new();
        let (mut rest, mut odometry) = (processed, odometry);
        for (since, until) in &self.gaps {
            let (known, after) = rest.split_at(rest.partition_point(|(stamp, _)| stamp < since));
            let end =
                known.last().map_or(0, |(last, _)| odometry.partition_point(|(stamp, _)| stamp <= last));
            stretches.push((known, &odometry[..end]));
            rest = after;
            let next = until.map_or(odometry.len(), |until| odometry.partition_point(|(s, _)| *s < until));
            odometry = &odometry[next..];
        }
        stretches.push((rest, odometry));
        stretches.into_iter().flat_map(|(known, odometry)| propagated_poses(known, odometry))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_has_no_poses_and_bends_none_beside_it() {
        let stamp = |i: i64| Stamp::from_nanos(i * 1_000_000_000);
        let odometry: Vec<_> = (0..20).map(|i| (stamp(i), Pose2::new(i as f64, 0.0, 0.0))).collect();
        let at = |i: i64, y: f64| (stamp(i), Pose2::new(i as f64, y, 0.0));
        let processed = [at(2, 0.0), at(6, 0.0), at(14, 9.0), at(16, 9.0)];
        let mut known = KnownStretches::default();
        known.find(stamp(1));
        known.lose(stamp(7));
        known.lose(stamp(9));
        known.find(stamp(14));
        known.lose(stamp(18));
        let trajectory: Vec<_> = known.trajectory(&processed, &odometry).collect();
        let stamps: Vec<i64> = trajectory.iter().map(|(s, _)| s.nanos / 1_000_000_000).collect();
        assert_eq!(stamps, [2, 3, 4, 5, 6, 14, 15, 16]);
        let is_straight = |(s, pose): &(Stamp, Pose2)| pose.y == if *s < stamp(7) { 0.0 } else { 9.0 };
        assert!(trajectory.iter().all(is_straight), "{trajectory:?}");
        let whole = KnownStretches::default().trajectory(&processed, &odometry);
        assert!(whole.eq(propagated_poses(&processed, &odometry)));
    }
}
