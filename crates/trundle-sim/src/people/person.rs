//! A person as a scene defines one: way-points, speed and timing.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_finite, require_in};

/// A person who walks from way-point to way-point, turns into each leg, and waits while the robot blocks it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Person {
    /// The path, world frame, m; one point is a standing person.
    pub waypoints: Vec<[f64; 2]>,
    /// Walking speed, m/s, 0.05 to 3. Default 1.2, a calm walk.
    pub speed: f64,
    /// Stands at every way-point for, s, 0 to 3600. Default 0.
    pub pause: f64,
    /// Waits before the first step for, s, 0 to 3600. Default 0.
    pub delay: f64,
    /// Whether the path continues from its last point to its first; otherwise it reverses. Default false.
    pub around: bool,
    /// Whether the person remains at the last way-point. Default false.
    pub once: bool,
}

impl Default for Person {
    fn default() -> Self {
        Self { waypoints: Vec::new(), speed: 1.2, pause: 0.0, delay: 0.0, around: false, once: false }
    }
}

impl Person {
    /// The legs of the path, as indices of way-points.
    pub(crate) fn legs(&self) -> Vec<(usize, usize)> {
        let n = self.waypoints.len();
        let mut legs: Vec<_> = (1..n).map(|i| (i - 1, i)).collect();
        if legs.is_empty() || (self.around && !self.once) {
            legs.push((n - 1, 0));
        }
        legs
    }

    /// Passes a valid person through.
    ///
    /// # Errors
    /// When no way-point is given, or a number is outside its range or not finite.
    pub fn validated(self) -> Result<Self, Invalid> {
        if self.waypoints.is_empty() {
            return Err(Invalid::new("way-points of a person", 0, "", "1 or more"));
        }
        for (i, point) in self.waypoints.iter().enumerate() {
            require_finite(&format!("way-point {i} of a person"), point[0] + point[1], "m")?;
        }
        require_in("speed of a person", self.speed, "m/s", 0.05, 3.0)?;
        require_in("pause of a person", self.pause, "s", 0.0, 3600.0)?;
        require_in("delay of a person", self.delay, "s", 0.0, 3600.0)?;
        Ok(self)
    }
}
