//! The frames of poses: their names, and the base's pose in that of the odometry.

use super::FrameNames;
use crate::body::OdometryReader;
use trundle_app::operator::RunView;
use trundle_core::Pose2;

/// The frames of a run's poses.
#[derive(Clone)]
pub struct RunFrames {
    /// Names of the frames. A body that publishes its own odometry names that frame itself.
    pub names: FrameNames,
    /// The odometry that the body publishes itself; `None`: the robot's own is published.
    pub body_odometry: Option<OdometryReader>,
}

impl RunFrames {
    /// The frames of a robot that publishes its own odometry.
    #[must_use]
    pub const fn of_own_odometry(names: FrameNames) -> Self {
        Self { names, body_odometry: None }
    }

    /// Name of the odometry's frame: that of the body's messages, if it publishes some.
    #[must_use]
    pub fn odom(&self) -> String {
        let of_body = self.body_odometry.as_ref().and_then(OdometryReader::frame);
        of_body.unwrap_or_else(|| self.names.odom.clone())
    }

    /// Whether another node publishes a transform from the odometry's frame to the base.
    #[must_use]
    pub fn has_foreign_odom_transform(&self) -> bool {
        self.body_odometry.as_ref().is_some_and(|odometry| odometry.has_transform(&self.names.base))
    }

    /// `odom_from_base` at the time of the estimate, as others see it on `/tf`.
    #[must_use]
    pub fn odom_from_base(&self, view: &RunView) -> Option<Pose2> {
        match &self.body_odometry {
            Some(reader) => reader.at(view.estimate.stamp).map(|odometry| odometry.pose),
            None => view.odometry.map(|odometry| odometry.pose),
        }
    }
}
