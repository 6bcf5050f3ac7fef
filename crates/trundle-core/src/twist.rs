//! The velocity of a differential drive: forward speed and turn rate.

use serde::{Deserialize, Serialize};

/// Motion of a differential drive: speed along x and turn rate around z, in the base frame.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Twist2 {
    /// Forward speed, m/s.
    pub v: f64,
    /// Turn rate, counter-clockwise, rad/s.
    pub omega: f64,
}

impl Twist2 {
    /// Standing still.
    pub const ZERO: Self = Self { v: 0.0, omega: 0.0 };

    /// A twist from m/s and rad/s.
    pub const fn new(v: f64, omega: f64) -> Self {
        Self { v, omega }
    }

    /// Whether both components are finite.
    pub fn is_finite(&self) -> bool {
        self.v.is_finite() && self.omega.is_finite()
    }
}
