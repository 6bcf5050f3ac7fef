//! Parameters of the depth noise, with presets for Kinect v1 and v2.

use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;
use trundle_core::{Invalid, require_in, require_positive};

/// Errors of a camera's depth. Presets: [`DepthNoise::kinect_v2`], the default, and [`DepthNoise::kinect_v1`].
///
/// Axial noise is normal with sigma = a0 + a1 z + a2 z^2 + s z^p theta^2 / (pi/2 - theta)^2 (mm, z in m, theta the angle between ray and
/// normal): both published models have this form. Pixels at depth edges mix both surfaces ("flying pixels"), take the depth of the other
/// one, or are lost. Dark, slanted and distant surfaces return too little light. The return is modelled as luminance cos(theta) / z^2; the
/// luminance of the colour image replaces the unknown infrared albedo.
///
/// The shares at edges and the two thresholds of light are ours: the papers show the effects without such numbers. Not modelled: warm-up,
/// wiggling, offset by colour (millimetres, \[Wasenmueller16\]), rolling exposure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DepthNoise {
    /// Nearest depth measured, m, 0 to 10. Kinect V2: 0.5 \[Li18\].
    pub nearest: f64,
    /// Farthest depth measured, m, `nearest` to 100. Kinect V2: 8 \[Li18\].
    pub farthest: f64,
    /// Factor on sigma, 0 to 100. Default 1; 0 turns axial noise off.
    pub axial_factor: f64,
    /// Coefficients a0 (mm), a1 (mm/m) and a2 (mm/m^2) of the axial noise, -100 to 100 each.
    pub axial_mm: [f64; 3],
    /// Factor s of the slanted term, mm, 0 to 100.
    pub slant_mm: f64,
    /// Exponent p of the slanted term, -2 to 2.
    pub slant_power: f64,
    /// Angle of incidence below which the slanted term is left out, deg, 0 to 90.
    pub slant_from_deg: f64,
    /// Angle of incidence beyond which sigma is constant, deg, 0 to 89. Default 80: the models' pole at 90 deg is not
    /// physical.
    pub steepest_deg: f64,
    /// Smallest angle of incidence at which returns are lost, all of them at 90, deg, 0 to 90. Default 80; 90 turns it off.
    pub grazing_from_deg: f64,
    /// Returns (luminance 0..1 times cosine over m^2) below this are lost with rising probability, 0 to 1. Default
    /// 0.004: black felt is lost from about 3 m on, as the sensor's users see. 0 turns it off.
    pub weakest_return: f64,
    /// Smallest depth step that counts as an edge, m, 0.01 to 10. Default 0.08.
    pub edge_step: f64,
    /// Probability that a pixel at an edge flies between both surfaces, 0 to 1. Default 0.3.
    pub flying: f64,
    /// Probability that a pixel at an edge is lost (the driver's edge-aware filter), 0 to 1. Default 0.4.
    pub edge_loss: f64,
    /// Standard deviation of an edge's position in the image, px, 0 to 2: pixels near the edge may have the depth of the other side. Kinect
    /// v1: 0.8 \[Nguyen12\]; Kinect V2: 0.
    pub lateral_px: f64,
    /// Strength of multi-path in concave corners, 0 to 2: share of the corner's sagitta over 24 px that the depth there is
    /// too long by (see `docs/algorithms/simulator.md`). Default 0, off.
    pub multi_path: f64,
    /// Focal length times distance between projector and camera, px m, -200 to 200: surfaces that the projector, to the
    /// right of the camera, cannot see have no depth. Kinect v1: 525 px times 0.075 m \[Khoshelham12\]. 0 turns it off.
    pub shadow_px_m: f64,
    /// Step of the inverse depth that is measured, 1/m, 0 to 0.1. Kinect v1: 2.85e-3, its disparity in eighths of a
    /// pixel \[Khoshelham12\]; 0 for time of flight.
    pub inverse_quantum: f64,
    /// Depths are whole multiples of this, m, 1e-6 to 1. Default 0.001, the drivers' unit.
    pub quantum: f64,
}

impl Default for DepthNoise {
    fn default() -> Self {
        Self::kinect_v2()
    }
}

impl DepthNoise {
    /// The Kinect V2, time of flight, indoors \[Fankhauser15\]:
    /// sigma = 1.5 - 0.5 z + 0.3 z^2 + 0.1 z^1.5 theta^2 / (pi/2 - theta)^2 mm.
    pub fn kinect_v2() -> Self {
        Self {
            nearest: 0.5,
            farthest: 8.0,
            axial_factor: 1.0,
            axial_mm: [1.5, -0.5, 0.3],
            slant_mm: 0.1,
            slant_power: 1.5,
            slant_from_deg: 0.0,
            steepest_deg: 80.0,
            grazing_from_deg: 80.0,
            weakest_return: 0.004,
            edge_step: 0.08,
            flying: 0.3,
            edge_loss: 0.4,
            lateral_px: 0.0,
            multi_path: 0.0,
            shadow_px_m: 0.0,
            inverse_quantum: 0.0,
            quantum: 0.001,
        }
    }

    /// The Kinect v1, structured light \[Nguyen12\]: sigma = 1.2 + 1.9 (z - 0.4)^2 mm, and beyond 60 deg of incidence 0.1 z^-0.5 theta^2 /
    /// (pi/2 - theta)^2 mm more; edges uncertain by 0.8 px. Disparity is in eighths of a pixel, 7 cm at 5 m, the end of the range
    /// \[Khoshelham12\]; edges have the projector's shadow.
    pub fn kinect_v1() -> Self {
        Self {
            farthest: 5.0,
            axial_mm: [1.504, -1.52, 1.9],
            slant_mm: 0.1,
            slant_power: -0.5,
            slant_from_deg: 60.0,
            flying: 0.0,
            edge_loss: 0.2,
            lateral_px: 0.8,
            shadow_px_m: 525.0 * 0.075,
            inverse_quantum: 2.85e-3,
            ..Self::kinect_v2()
        }
    }

    /// Range and quantum of the Kinect V2, but no noise and no losses.
    pub fn none() -> Self {
        Self {
            axial_factor: 0.0,
            grazing_from_deg: 90.0,
            weakest_return: 0.0,
            flying: 0.0,
            edge_loss: 0.0,
            ..Self::kinect_v2()
        }
    }

    /// Passes valid noise through.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        let check = |field: &str, value, unit, low, high| {
            require_in(&format!("depth_noise.{field}"), value, unit, low, high).map(|_| ())
        };
        check("nearest", self.nearest, "m", 0.0, 10.0)?;
        check("farthest", self.farthest, "m", self.nearest, 100.0)?;
        check("axial_factor", self.axial_factor, "", 0.0, 100.0)?;
        for (i, a) in self.axial_mm.iter().enumerate() {
            check(&format!("axial_mm[{i}]"), *a, "mm", -100.0, 100.0)?;
        }
        check("slant_mm", self.slant_mm, "mm", 0.0, 100.0)?;
        check("slant_power", self.slant_power, "", -2.0, 2.0)?;
        check("slant_from_deg", self.slant_from_deg, "deg", 0.0, 90.0)?;
        check("steepest_deg", self.steepest_deg, "deg", 0.0, 89.0)?;
        check("grazing_from_deg", self.grazing_from_deg, "deg", 0.0, 90.0)?;
        check("weakest_return", self.weakest_return, "", 0.0, 1.0)?;
        check("edge_step", self.edge_step, "m", 0.01, 10.0)?;
        check("flying", self.flying, "", 0.0, 1.0)?;
        check("edge_loss", self.edge_loss, "", 0.0, 1.0 - self.flying)?;
        check("lateral_px", self.lateral_px, "px", 0.0, 2.0)?;
        check("multi_path", self.multi_path, "", 0.0, 2.0)?;
        check("shadow_px_m", self.shadow_px_m, "px m", -200.0, 200.0)?;
        check("inverse_quantum", self.inverse_quantum, "1/m", 0.0, 0.1)?;
        require_positive("depth_noise.quantum", self.quantum, "m")?;
        check("quantum", self.quantum, "m", 1e-6, 1.0)?;
        Ok(self)
    }

    /// The standard deviation of depth, m, at depth `z` (m) and incidence `theta` (rad), steps of depth included.
    pub fn sigma(&self, z: f64, theta: f64) -> f64 {
        self.axial_factor * (self.sigma_head_on(z) + self.slant(theta) * z.powf(self.slant_power))
    }

    /// a0 + a1 z + a2 z^2, m; never below zero.
    pub(super) fn sigma_head_on(&self, z: f64) -> f64 {
        let [a0, a1, a2] = self.axial_mm;
        ((a0 + a1 * z + a2 * z * z) * 1e-3).max(0.0)
    }

    /// s theta^2 / (pi/2 - theta)^2, m per m^p.
    pub(super) fn slant(&self, theta: f64) -> f64 {
        if theta < self.slant_from_deg.to_radians() {
            return 0.0;
        }
        let theta = theta.min(self.steepest_deg.to_radians());
        1e-3 * self.slant_mm * (theta / (FRAC_PI_2 - theta)).powi(2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_are_valid_and_bad_numbers_are_named() {
        for noise in [DepthNoise::kinect_v2(), DepthNoise::kinect_v1(), DepthNoise::none()] {
            assert!(noise.validated().is_ok());
        }
        let error =
            DepthNoise { flying: 0.8, edge_loss: 0.8, ..DepthNoise::default() }.validated().unwrap_err();
        assert_eq!(error.field, "depth_noise.edge_loss");
        assert!(DepthNoise { axial_mm: [0.0, f64::NAN, 0.0], ..DepthNoise::default() }.validated().is_err());
    }

    #[test]
    fn sigma_is_that_of_the_papers() {
        let mm = |noise: &DepthNoise, z, degrees: f64| noise.sigma(z, degrees.to_radians()) * 1e3;
        let v2 = DepthNoise::kinect_v2();
        for (z, degrees, sigma) in [(1.0, 0.0, 1.3), (2.0, 0.0, 1.7), (4.0, 0.0, 4.3), (2.0, 60.0, 2.831)] {
            assert!((mm(&v2, z, degrees) - sigma).abs() < 1e-3, "{z} {degrees}");
        }
        // 1.2 + 1.9 (z - 0.4)^2, and 0.1 / sqrt(z) (70 / 20)^2 beyond 60 deg.
        let v1 = DepthNoise::kinect_v1();
        for (z, degrees, sigma) in [(1.0, 0.0, 1.884), (3.0, 59.0, 14.044), (4.0, 70.0, 25.824 + 0.6125)] {
            assert!((mm(&v1, z, degrees) - sigma).abs() < 1e-3, "{z} {degrees} {}", mm(&v1, z, degrees));
        }
    }
}
