//! The lighting of a scene: ambient light and directional lamps.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_finite, require_in};

/// Lights of a scene: ambient light and distant lamps, without shadows (Lambert's law).
///
/// A surface of normal n shows its colour times ambient + sum of strength max(0, n . direction), at most white.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Lights {
    /// Light from everywhere, 0 to 2. Default 0.64.
    pub ambient: f64,
    /// Lamps. Default two, from either side above.
    pub lamps: Vec<Lamp>,
}

/// A lamp far away.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lamp {
    /// Direction from the scene to the lamp, world frame, of any length.
    pub direction: [f64; 3],
    /// Strength on a surface that faces the lamp, 0 to 2.
    pub strength: f64,
}

impl Default for Lights {
    fn default() -> Self {
        let lamp = |direction, strength| Lamp { direction, strength };
        Self { ambient: 0.64, lamps: vec![lamp([0.31, 0.45, 0.84], 0.24), lamp([-0.62, -0.52, 0.59], 0.12)] }
    }
}

impl Lights {
    /// Passes valid lights through.
    ///
    /// # Errors
    /// When a number is outside its range or not finite, or a direction is zero.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("lights.ambient", self.ambient, "", 0.0, 2.0)?;
        for (i, lamp) in self.lamps.iter().enumerate() {
            require_in(&format!("lights.lamps[{i}].strength"), lamp.strength, "", 0.0, 2.0)?;
            let length = lamp.direction.iter().map(|x| x * x).sum::<f64>().sqrt();
            require_finite(&format!("lights.lamps[{i}].direction"), length, "")?;
            require_in(&format!("length of lights.lamps[{i}].direction"), length, "", 1e-6, 1e6)?;
        }
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_lamps_are_refused_by_name() {
        assert!(Lights::default().validated().is_ok());
        let dark = Lamp { direction: [0.0; 3], strength: 0.1 };
        let error = Lights { lamps: vec![dark], ..Lights::default() }.validated().unwrap_err();
        assert_eq!(error.field, "length of lights.lamps[0].direction");
    }
}
