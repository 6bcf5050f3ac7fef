//! `nav_msgs/Path`.

use super::{pose, stamp};
use crate::generated::nav_msgs::PathMessage;
use trundle_core::{Invalid, Pose2, Stamp, shape_points};

/// Poses along a path as a message.
#[must_use]
pub fn to_ros(poses: &[Pose2], at: Stamp, frame: &str) -> PathMessage {
    let poses = poses.iter().map(|own| pose::stamped(own, at, frame)).collect();
    PathMessage { header: stamp::header(at, frame), poses }
}

/// The poses that preserve the path's shape best: at most `count`, but always the ends.
#[must_use]
pub fn thinned(poses: &[Pose2], count: usize) -> Vec<Pose2> {
    let points: Vec<_> = poses.iter().map(Pose2::position).collect();
    // A straight path has poses between its ends too.
    shape_points(&points, count, f64::NEG_INFINITY).into_iter().map(|index| poses[index]).collect()
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
