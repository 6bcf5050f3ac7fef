//! `geometry_msgs/TransformStamped`.

use super::{pose, stamp};
use crate::generated::geometry_msgs::{Point, Pose, Transform, TransformStamped, Vector3Message};
use trundle_core::{Invalid, Pose2, Pose3, Stamp};

/// The pose of the child in its parent's frame.
///
/// # Errors
/// When a number is not finite, or the rotation was never set.
pub fn from_ros(transform: &Transform) -> Result<Pose3, Invalid> {
    let Vector3Message { x, y, z } = transform.translation;
    pose::pose3(&Pose { position: Point { x, y, z }, orientation: transform.rotation.clone() })
}

/// The pose of `child` in the frame `parent`.
#[must_use]
pub fn to_ros(parent_from_child: &Pose3, at: Stamp, parent: &str, child: &str) -> TransformStamped {
    let Pose { position: Point { x, y, z }, orientation } = pose::space_to_ros(parent_from_child);
    TransformStamped {
        header: stamp::header(at, parent),
        child_frame_id: child.to_owned(),
        transform: Transform { translation: Vector3Message { x, y, z }, rotation: orientation },
    }
}

/// The pose on the floor of `child` in the frame `parent`.
#[must_use]
pub fn planar_to_ros(parent_from_child: &Pose2, at: Stamp, parent: &str, child: &str) -> TransformStamped {
    to_ros(&Pose3::from_pose2(*parent_from_child), at, parent, child)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transforms_go_there_and_back() {
        let own = Pose2::new(0.5, -0.25, 1.0);
        let mut message = planar_to_ros(&own, Stamp::default(), "map", "odom");
        assert!((from_ros(&message.transform).unwrap().to_pose2().distance(&own)) < 1e-12);
        message.transform.rotation.w = f64::NAN;
        assert!(from_ros(&message.transform).is_err());
    }
}
