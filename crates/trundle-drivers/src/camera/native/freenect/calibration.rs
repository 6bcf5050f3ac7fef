//! Calibration of the Kinect v1. The camera stores none that libfreenect offers in a usable form: the values are assumed.

use crate::camera::native::RgbdCalibration;
use trundle_core::{Distortion, Invalid, PinholeCamera, Pose3, Vector3};

/// Focal length of the depth camera \[px\]. Source: defaults of the ROS packages openni_camera and freenect_camera.
const DEPTH_FOCAL_LENGTH_PX: f64 = 575.816;
/// Column of the principal point of the depth image \[px\]: the middle, less half the correlation window of 10 x 8 px. Source:
/// defaults of the ROS packages openni_camera and freenect_camera.
const DEPTH_CENTRE_X_PX: f64 = 314.5;
/// Row of the principal point \[px\]. Source: defaults of the ROS packages openni_camera and freenect_camera.
const DEPTH_CENTRE_Y_PX: f64 = 235.5;
/// Distance of the depth camera to the right of the colour camera \[m\]. Source: defaults of the ROS packages openni_camera and freenect_camera.
const BASELINE_M: f64 = 0.025;

/// Typical values, with errors of some pixels for any Kinect v1. A calibration of the individual camera is better.
///
/// # Errors
/// Never, unless a constant is wrong.
pub fn assumed_calibration() -> Result<RgbdCalibration, Invalid> {
    let focal = (DEPTH_FOCAL_LENGTH_PX, DEPTH_FOCAL_LENGTH_PX);
    let depth =
        PinholeCamera::new((640, 480), focal, (DEPTH_CENTRE_X_PX, DEPTH_CENTRE_Y_PX), Distortion::default())?;
    let color_from_depth = Some(depth_camera_pose());
    Ok(RgbdCalibration { color: PinholeCamera::kinect_v1(), depth, color_from_depth })
}

/// Pose of the depth camera in the colour camera's frame. The cameras of the Xtion and the first Astra have the same arrangement.
pub(in crate::camera::native) fn depth_camera_pose() -> Pose3 {
    Pose3::new(Pose3::identity().rotation, Vector3::new(BASELINE_M, 0.0, 0.0))
}
