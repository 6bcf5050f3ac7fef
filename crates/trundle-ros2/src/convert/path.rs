//! `nav_msgs/Path`.

use super::{pose, stamp};
use crate::generated::nav_msgs::Path;
use trundle_core::{Invalid, Pose2, Stamp};

/// Poses along a path as a message.
#[must_use]
pub fn to_ros(poses: &[Pose2], at: Stamp, frame: &str) -> Path {
    let poses = poses.iter().map(|own| pose::stamped(own, at, frame)).collect();
    Path { header: stamp::header(at, frame), poses }
}

/// The poses of a path.
///
/// # Errors
/// Names the first pose that is not finite or whose rotation was never set.
pub fn from_ros(path: &Path) -> Result<Vec<Pose2>, Invalid> {
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
    fn paths_go_there_and_back() {
        let own = [Pose2::new(0.0, 0.0, 0.0), Pose2::new(1.0, 0.5, 1.0)];
        let mut path = to_ros(&own, Stamp::default(), "map");
        assert!(from_ros(&path).unwrap()[1].distance(&own[1]) < 1e-12);
        path.poses[1].pose.position.x = f64::NAN;
        assert!(from_ros(&path).unwrap_err().to_string().starts_with("poses[1].position.x is NaN"));
    }
}
