//! `/tf`: the frames of odometry and base.

use super::{BASE_FRAME, MAP_FRAME, ODOM_FRAME, position, rotation, timestamp};
use foxglove::messages::{FrameTransform, FrameTransforms};
use trundle_app::operator::RunView;
use trundle_core::{Pose2, Stamp};

/// `map_from_odom` and `odom_from_base`. Before the first odometry both frames of the base are one.
pub fn message(view: &RunView) -> Option<(Stamp, FrameTransforms)> {
    let odom_from_base = view.odometry.map_or(Pose2::IDENTITY, |odometry| odometry.pose);
    let map_from_odom = view.estimate.pose * odom_from_base.inverse();
    let transform = |parent: &str, child: &str, pose: Pose2| FrameTransform {
        timestamp: Some(timestamp(view.stamp)),
        parent_frame_id: parent.to_owned(),
        child_frame_id: child.to_owned(),
        translation: Some(position(pose)),
        rotation: Some(rotation(pose)),
    };
    let transforms = vec![
        transform(MAP_FRAME, ODOM_FRAME, map_from_odom),
        transform(ODOM_FRAME, BASE_FRAME, odom_from_base),
    ];
    Some((view.stamp, FrameTransforms { transforms }))
}
