//! `/pose`: pose with covariance, and twist.

use super::{BASE_FRAME, MAP_FRAME, pose3, timestamp};
use foxglove::messages::{Odometry, Vector3};
use trundle_app::operator::RunView;
use trundle_core::Stamp;

/// Rows and columns of x, y and the heading in a covariance of six axes. Source: the schema foxglove.Odometry.
const PLANAR_ROWS: [usize; 3] = [0, 1, 5];
/// Rows of a covariance of six axes. Source: the schema foxglove.Odometry.
const COVARIANCE_ROWS: usize = 6;

/// The estimate of a view.
pub fn message(view: &RunView) -> Option<(Stamp, Odometry)> {
    let estimate = &view.estimate;
    let covariance = view.map_covariance();
    let mut pose_covariance = vec![0.0; COVARIANCE_ROWS * COVARIANCE_ROWS];
    for (i, row) in PLANAR_ROWS.into_iter().enumerate() {
        for (j, column) in PLANAR_ROWS.into_iter().enumerate() {
            pose_covariance[COVARIANCE_ROWS * row + column] = covariance[i][j];
        }
    }
    let message = Odometry {
        timestamp: Some(timestamp(view.stamp)),
        frame_id: MAP_FRAME.to_owned(),
        body_frame_id: BASE_FRAME.to_owned(),
        pose: Some(pose3(estimate.pose)),
        linear_velocity: Some(Vector3 { x: estimate.twist.v, y: 0.0, z: 0.0 }),
        angular_velocity: Some(Vector3 { x: 0.0, y: 0.0, z: estimate.twist.omega }),
        pose_covariance,
        velocity_covariance: vec![0.0; COVARIANCE_ROWS * COVARIANCE_ROWS],
        metadata: Vec::new(),
    };
    Some((view.stamp, message))
}
