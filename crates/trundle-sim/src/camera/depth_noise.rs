use crate::chance::{NormalTable, mix};
use serde::{Deserialize, Serialize};
use std::f32::consts::FRAC_PI_2;
use trundle_core::{Invalid, require_in, require_positive};

/// How a time-of-flight camera's depth differs from the truth: the Kinect V2 by default.
///
/// Axial noise \[Fankhauser15\], indoors: sigma_z = 1.5 - 0.5 z + 0.3 z^2 + 0.1 z^1.5 theta^2 / (pi/2 - theta)^2 in mm, z in
/// m, theta the angle between ray and normal. Pixels at depth edges mix both surfaces ("flying pixels") or are lost.
/// Dark, slanted and far surfaces return too little light: the return is taken as luminance cos(theta) / z^2, the
/// luminance of the colour image standing for the unknown infrared albedo. Multi-path is not modelled.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DepthNoise {
    /// Nearest depth measured, m, 0 to 10. Default 0.5 \[Li18\].
    pub nearest: f64,
    /// Farthest depth measured, m, 0 to 100. Default 8 \[Li18\].
    pub farthest: f64,
    /// Factor on the published sigma, 0 to 100. Default 1; 0 turns axial noise off.
    pub axial_factor: f64,
    /// Angle of incidence beyond which sigma grows no more, deg, 0 to 89. Default 80: the model's pole at 90 deg is not
    /// physical.
    pub steepest_deg: f64,
    /// Angle of incidence from which returns are lost, all of them at 90, deg, 0 to 90. Default 80; 90 turns it off.
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
    /// Depths are whole multiples of this, m, 1e-6 to 1. Default 0.001, the driver's unit.
    pub quantum: f64,
}

impl Default for DepthNoise {
    fn default() -> Self {
        Self {
            nearest: 0.5,
            farthest: 8.0,
            axial_factor: 1.0,
            steepest_deg: 80.0,
            grazing_from_deg: 80.0,
            weakest_return: 0.004,
            edge_step: 0.08,
            flying: 0.3,
            edge_loss: 0.4,
            quantum: 0.001,
        }
    }
}

impl DepthNoise {
    /// Range and quantum of the Kinect V2, but no noise and no losses.
    pub fn none() -> Self {
        Self {
            axial_factor: 0.0,
            grazing_from_deg: 90.0,
            weakest_return: 0.0,
            flying: 0.0,
            edge_loss: 0.0,
            ..Self::default()
        }
    }

    /// Passes valid noise through.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("depth_noise.nearest", self.nearest, "m", 0.0, 10.0)?;
        require_in("depth_noise.farthest", self.farthest, "m", self.nearest, 100.0)?;
        require_in("depth_noise.axial_factor", self.axial_factor, "", 0.0, 100.0)?;
        require_in("depth_noise.steepest_deg", self.steepest_deg, "deg", 0.0, 89.0)?;
        require_in("depth_noise.grazing_from_deg", self.grazing_from_deg, "deg", 0.0, 90.0)?;
        require_in("depth_noise.weakest_return", self.weakest_return, "", 0.0, 1.0)?;
        require_in("depth_noise.edge_step", self.edge_step, "m", 0.01, 10.0)?;
        require_in("depth_noise.flying", self.flying, "", 0.0, 1.0)?;
        require_in("depth_noise.edge_loss", self.edge_loss, "", 0.0, 1.0 - self.flying)?;
        require_positive("depth_noise.quantum", self.quantum, "m")?;
        require_in("depth_noise.quantum", self.quantum, "m", 1e-6, 1.0)?;
        Ok(self)
    }

    /// The standard deviation of depth, m, at depth `z` (m) and incidence `theta` (rad).
    pub fn sigma(&self, z: f64, theta: f64) -> f64 {
        let (z, theta) = (z as f32, (theta as f32).min(self.steepest_deg.to_radians() as f32));
        f64::from(self.axial_factor as f32 * axial_sigma(z, slant_term(theta)))
    }
}

/// \[Fankhauser15\], m: depth in m and [`slant_term`].
fn axial_sigma(z: f32, slant: f32) -> f32 {
    (1.5 - 0.5 * z + 0.3 * z * z + slant * z * z.sqrt()) * 1e-3
}

/// 0.1 theta^2 / (pi/2 - theta)^2.
fn slant_term(theta: f32) -> f32 {
    0.1 * (theta / (FRAC_PI_2 - theta)).powi(2)
}

/// What a pixel's depth is measured from.
#[derive(Debug, Clone, Copy)]
pub(super) struct DepthTruth {
    /// Depth, m; 0 where nothing is.
    pub(super) depth: f32,
    /// Depth beyond the edge the pixel lies at, m; 0 when it lies at none.
    pub(super) beyond: f32,
    /// Cosine of the angle of incidence.
    pub(super) cosine: f32,
    /// 0 to 1.
    pub(super) luminance: f32,
}

/// [`DepthNoise`] made ready for millions of pixels: f32, angles looked up.
#[derive(Debug, Clone)]
pub(super) struct DepthModel {
    nearest: f32,
    farthest: f32,
    axial_factor: f32,
    weakest_return: f32,
    edge_step: f32,
    flying: f32,
    edge_loss: f32,
    quantum: f32,
    /// Slant term of sigma and probability of a grazing loss, by cosine of incidence in 255 steps.
    by_cosine: [(f32, f32); 256],
}

impl DepthModel {
    pub(super) fn new(noise: &DepthNoise) -> Self {
        let steepest = noise.steepest_deg.to_radians() as f32;
        let grazing = (noise.grazing_from_deg as f32).to_radians();
        let entry = |i: usize| {
            let theta = (i as f32 / 255.0).acos();
            let loss = (theta - grazing) / (FRAC_PI_2 - grazing).max(1e-6);
            (slant_term(theta.min(steepest)), loss.clamp(0.0, 1.0))
        };
        Self {
            nearest: noise.nearest as f32,
            farthest: noise.farthest as f32,
            axial_factor: noise.axial_factor as f32,
            weakest_return: noise.weakest_return as f32,
            edge_step: noise.edge_step as f32,
            flying: noise.flying as f32,
            edge_loss: noise.edge_loss as f32,
            quantum: noise.quantum as f32,
            by_cosine: std::array::from_fn(entry),
        }
    }

    /// The smallest depth step that counts as an edge, m.
    pub(super) fn edge_step(&self) -> f32 {
        self.edge_step
    }

    /// What the camera says for a pixel, m, 0 for nothing; `bits` is the pixel's hash.
    pub(super) fn measure(&self, truth: DepthTruth, bits: u64, normals: &NormalTable) -> f32 {
        let mut z = truth.depth;
        if z <= 0.0 {
            return 0.0;
        }
        let chance = |nth: u32| (mix(bits) >> (nth * 20) & 0xF_FFFF) as i32 as f32 * (1.0 / (1 << 20) as f32);
        if truth.beyond > 0.0 {
            let fate = chance(0);
            if fate < self.edge_loss {
                return 0.0;
            }
            if fate < self.edge_loss + self.flying {
                z += chance(1) * (truth.beyond - z);
            }
        }
        let (slant, grazing_loss) = self.by_cosine[(truth.cosine * 255.0 + 0.5) as i32 as usize & 255];
        let strength = truth.luminance * truth.cosine;
        let enough = self.weakest_return * z * z;
        if (grazing_loss > 0.0 || strength < enough) && chance(2) < grazing_loss.max(1.0 - strength / enough)
        {
            return 0.0;
        }
        z += self.axial_factor * axial_sigma(z, slant) * normals.pick(bits, 0);
        let z = (z / self.quantum + 0.5) as i32 as f32 * self.quantum;
        if z >= self.nearest && z <= self.farthest { z } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chance::hash;

    fn measured(noise: DepthNoise, truth: DepthTruth) -> Vec<f64> {
        let model = DepthModel::new(&noise);
        let normals = NormalTable::shared();
        (0..40_000).map(|i| f64::from(model.measure(truth, hash(5, i), normals))).collect()
    }

    fn wall(depth: f32, theta_deg: f32) -> DepthTruth {
        DepthTruth { depth, beyond: 0.0, cosine: theta_deg.to_radians().cos(), luminance: 0.6 }
    }

    #[test]
    fn spread_follows_the_published_model() {
        for (z, theta_deg, sigma_mm) in [(1.0, 0.0, 1.3), (2.0, 0.0, 1.7), (4.0, 0.0, 4.3), (2.0, 60.0, 2.83)]
        {
            let depths = measured(DepthNoise::default(), wall(z, theta_deg));
            let n = depths.len() as f64;
            let mean = depths.iter().sum::<f64>() / n;
            let sigma = (depths.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / n).sqrt();
            assert!((mean - f64::from(z)).abs() < 1e-4, "mean {mean} of {z}");
            assert!((sigma * 1e3 - sigma_mm).abs() < 0.05 * sigma_mm + 0.05, "sigma {sigma} at {z} m");
            let stated = DepthNoise::default().sigma(z.into(), f64::from(theta_deg).to_radians());
            assert!((stated * 1e3 - sigma_mm).abs() < 0.01 * sigma_mm, "stated {stated}");
        }
    }

    #[test]
    fn losses_and_flying_pixels_have_their_shares() {
        let lost = |truth| {
            let depths = measured(DepthNoise::default(), truth);
            depths.iter().filter(|&&d| d == 0.0).count() as f64 / depths.len() as f64
        };
        assert_eq!(lost(wall(3.0, 30.0)), 0.0);
        assert!((lost(wall(2.0, 85.0)) - 0.5).abs() < 0.02);
        assert_eq!(
            lost(DepthTruth { luminance: 0.01, ..wall(5.0, 0.0) }),
            lost(DepthTruth { luminance: 0.01, ..wall(5.0, 0.0) })
        );
        assert!(lost(DepthTruth { luminance: 0.02, ..wall(5.0, 0.0) }) > 0.7);
        assert_eq!((lost(wall(0.4, 0.0)), lost(wall(9.0, 0.0)), lost(wall(0.0, 0.0))), (1.0, 1.0, 1.0));
        let edge = DepthTruth { beyond: 4.0, ..wall(2.0, 0.0) };
        assert!((lost(edge) - 0.4).abs() < 0.01);
        let flying = measured(DepthNoise::default(), edge).iter().filter(|&&d| d > 2.05).count();
        assert!((flying as f64 / 40_000.0 - 0.3).abs() < 0.02);
    }

    #[test]
    fn depths_are_whole_millimetres() {
        for d in measured(DepthNoise::default(), wall(3.0, 20.0)) {
            assert!((d * 1e3 - (d * 1e3).round()).abs() < 1e-3);
        }
        assert!(DepthNoise { flying: 0.8, edge_loss: 0.8, ..DepthNoise::default() }.validated().is_err());
        assert!(DepthNoise::default().validated().is_ok() && DepthNoise::none().validated().is_ok());
    }
}
