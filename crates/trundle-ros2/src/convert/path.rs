//! `nav_msgs/Path`.

use super::{pose, stamp};
use crate::generated::nav_msgs::PathMessage;
use trundle_core::{Invalid, Pose2, Stamp};

/// Poses along a path as a message.
#[must_use]
pub fn to_ros(poses: &[Pose2], at: Stamp, frame: &str) -> PathMessage {
    let poses = poses.iter().map(|own| pose::stamped(own, at, frame)).collect();
    PathMessage { header: stamp::header(at, frame), poses }
}

/// The poses that preserve the path's shape best \[Douglas73\]: its ends, then repeatedly the pose farthest from the line between its
/// selected neighbours. At most `count` poses, but always the ends.
#[must_use]
pub fn thinned(poses: &[Pose2], count: usize) -> Vec<Pose2> {
    let mut kept: Vec<usize> = [0, poses.len().saturating_sub(1)].into_iter().take(poses.len()).collect();
    kept.dedup();
    while kept.len() < count {
        let farthest = kept.windows(2).filter_map(|ends| farthest(poses, ends[0], ends[1]));
        let Some((_, index)) = farthest.max_by(|a, b| a.0.total_cmp(&b.0)) else { break };
        kept.insert(kept.partition_point(|k| *k < index), index);
    }
    kept.into_iter().map(|k| poses[k]).collect()
}

/// The pose between two of a path that is farthest from the line between them: its distance \[m\] and its index.
fn farthest(poses: &[Pose2], from: usize, to: usize) -> Option<(f64, usize)> {
    let (a, chord) = (poses[from].position(), poses[to].position() - poses[from].position());
    let offset = |index: usize| {
        let beside = poses[index].position() - a;
        let along = (beside.dot(&chord) / chord.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        ((beside - chord * along).norm(), index)
    };
    (from + 1..to).map(offset).max_by(|a, b| a.0.total_cmp(&b.0))
}

/// The poses of a path.
///
/// # Errors
/// Names the first pose that is not finite or whose rotation was never set.
pub fn from_ros(path: &PathMessage) -> Result<Vec<Pose2>, Invalid> {
    let pose = |(i, stamped): (usize, &crate::generated::geometry_msgs::PoseStamped)| {
        pose::pose2(&stamped.pose)
            .map_err(|error| Invalid { field: format!("poses[{i}].{}", error.field), ..error })
    };
    path.poses.iter().enumerate().map(pose).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thinned_path_keeps_its_ends_and_corners() {
        let straight = (0..50).map(|i| Pose2::new(0.1 * f64::from(i), 0.0, 0.0));
        let up = (0..30).map(|i| Pose2::new(4.9, 0.1 * f64::from(i), 1.6));
        let path: Vec<Pose2> = straight.chain(up).collect();
        let places = |poses: &[Pose2]| {
            poses.iter().map(|pose| ((pose.x * 10.0).round(), (pose.y * 10.0).round())).collect::<Vec<_>>()
        };
        assert_eq!(places(&thinned(&path, 3)), [(0.0, 0.0), (49.0, 0.0), (49.0, 29.0)]);
        assert_eq!(places(&thinned(&path, 2)), [(0.0, 0.0), (49.0, 29.0)]);
        assert!(thinned(&[], 15).is_empty());
        assert_eq!(thinned(&path[..1], 15).len(), 1);
        let circle: Vec<Pose2> =
            (0..100).map(|i| f64::from(i) * 0.0635).map(|a| Pose2::new(a.cos(), a.sin(), a)).collect();
        assert_eq!(thinned(&circle, 15).len(), 15);
    }

    #[test]
    fn paths_go_there_and_back() {
        let own = [Pose2::new(0.0, 0.0, 0.0), Pose2::new(1.0, 0.5, 1.0)];
        let mut path = to_ros(&own, Stamp::default(), "map");
        assert!(from_ros(&path).unwrap()[1].distance(&own[1]) < 1e-12);
        path.poses[1].pose.position.x = f64::NAN;
        assert!(from_ros(&path).unwrap_err().to_string().starts_with("poses[1].position.x is NaN"));
    }
}
