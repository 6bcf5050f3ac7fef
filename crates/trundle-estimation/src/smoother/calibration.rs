//! The calibration that the smoother estimates.

/// A value with its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WithSigma {
    /// The estimate.
    pub value: f64,
    /// Standard deviation of the value.
    pub sigma: f64,
}

/// Calibration of gyro, wheels and camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SmootherCalibration {
    /// Bias of the gyro, rad/s.
    pub gyro_bias: WithSigma,
    /// True turn over the gyro's turn.
    pub gyro_scale: WithSigma,
    /// True over nominal radius of the left wheel.
    pub left_radius: WithSigma,
    /// True over nominal radius of the right wheel.
    pub right_radius: WithSigma,
    /// True over nominal wheelbase.
    pub wheelbase: WithSigma,
    /// Delay of the camera, s.
    pub camera_delay: WithSigma,
}
