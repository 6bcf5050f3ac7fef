//! Floor plane of one depth image, relative to the floor that the mount implies.

/// Floor plane of a depth image relative to the floor of the mount (base frame, origin below the camera).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FloorFit {
    /// Rise toward the base's x, m/m: about the error of the camera's tilt, rad.
    pub rise_ahead: f64,
    /// Rise toward the base's y, m/m.
    pub rise_left: f64,
    /// Height under the camera, m.
    pub height: f64,
    /// Bound on the error of the rise, m/m: three sigmas plus the unevenness of floors.
    pub rise_error: f64,
    /// Fraction of the sampled points near the expected floor that fit the plane, 0 to 1.
    pub share: f64,
}
