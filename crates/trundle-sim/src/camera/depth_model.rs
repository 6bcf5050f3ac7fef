//! The depth noise model in tables, for evaluation at every pixel.

use super::DepthNoise;
use super::round::{nearest, nearest_f32};
use crate::rng::{NormalTable, mix};
use std::f64::consts::FRAC_PI_2;

/// Entries of the tables over depth, a power of two. Source: ours.
const TABLE_STEPS: usize = 1024;

/// Inputs of a pixel's depth measurement.
#[derive(Debug, Clone, Copy)]
pub(super) struct DepthTruth {
    /// Depth, m; 0 without a surface.
    pub(super) depth: f32,
    /// Depth on the other side of the pixel's edge, m; 0 without an edge.
    pub(super) beyond: f32,
    /// Cosine of the angle of incidence.
    pub(super) cosine: f32,
    /// 0 to 1.
    pub(super) luminance: f32,
}

/// [`DepthNoise`] prepared for millions of pixels: f32, with tables of powers and angles.
#[derive(Debug, Clone)]
pub(super) struct DepthModel {
    nearest: f32,
    farthest: f32,
    weakest_return: f32,
    edge_step: f32,
    flying: f32,
    edge_loss: f32,
    lateral_px: f32,
    multi_path: f32,
    shadow_px_m: f32,
    /// Disparity steps in a metre's inverse; 0 for time of flight.
    disparities: f32,
    quantum: f32,
    /// Quanta per metre.
    quanta: f32,
    /// Table entries per metre.
    steps_a_metre: f32,
    /// Sigma without slant, m, and z^p, by depth.
    by_depth: Box<[(f32, f32); TABLE_STEPS]>,
    /// Slant term of sigma and probability of a grazing loss, by cosine of incidence in 255 steps.
    by_cosine: Box<[(f32, f32); 256]>,
}

impl DepthModel {
    pub(super) fn new(noise: &DepthNoise) -> Self {
        let grazing = noise.grazing_from_deg.to_radians();
        let cosine = |i: usize| {
            let theta = (i as f64 / 255.0).acos();
            let loss = (theta - grazing) / (FRAC_PI_2 - grazing).max(1e-6);
            ((noise.axial_factor * noise.slant(theta)) as f32, loss.clamp(0.0, 1.0) as f32)
        };
        let steps_a_metre = (TABLE_STEPS - 1) as f64 / noise.farthest.max(1e-3);
        let depth = |i: usize| {
            let z = i.max(1) as f64 / steps_a_metre;
            let sigma = noise.axial_factor * noise.sigma_head_on(z);
            // The published sigma includes the steps of disparity.
            let steps = noise.inverse_quantum * z * z;
            let rest = (sigma * sigma - steps * steps / 12.0).max(0.0).sqrt();
            (rest as f32, z.powf(noise.slant_power) as f32)
        };
        Self {
            nearest: noise.nearest as f32,
            farthest: noise.farthest as f32,
            weakest_return: noise.weakest_return as f32,
            edge_step: noise.edge_step as f32,
            flying: noise.flying as f32,
            edge_loss: noise.edge_loss as f32,
            lateral_px: noise.lateral_px as f32,
            multi_path: noise.multi_path as f32,
            shadow_px_m: noise.shadow_px_m as f32,
            disparities: if noise.inverse_quantum > 0.0 { (1.0 / noise.inverse_quantum) as f32 } else { 0.0 },
            quantum: noise.quantum as f32,
            quanta: (1.0 / noise.quantum) as f32,
            steps_a_metre: steps_a_metre as f32,
            by_depth: Box::new(std::array::from_fn(depth)),
            by_cosine: Box::new(std::array::from_fn(cosine)),
        }
    }

    /// The smallest depth step that counts as an edge, m.
    pub(super) fn edge_step(&self) -> f32 {
        self.edge_step
    }

    /// Strength of multi-path; 0 for none.
    pub(super) fn multi_path(&self) -> f32 {
        self.multi_path
    }

    /// Focal length times base line of the projector, px m; 0 for none.
    pub(super) fn shadow_px_m(&self) -> f32 {
        self.shadow_px_m
    }

    /// Measured depth of a pixel, m, 0 for none; `bits` is the pixel's hash.
    #[inline]
    pub(super) fn measure(&self, truth: DepthTruth, bits: u64, normals: &NormalTable) -> f32 {
        let mut z = truth.depth;
        if z <= 0.0 {
            return 0.0;
        }
        if truth.beyond > 0.0 {
            z = self.at_edge(z, truth.beyond, mix(bits), normals);
            if z <= 0.0 {
                return 0.0;
            }
        }
        let (slant, grazing_loss) = self.by_cosine[nearest(truth.cosine * 255.0) as usize & 255];
        let strength = truth.luminance * truth.cosine;
        let enough = self.weakest_return * z * z;
        if (grazing_loss > 0.0 || strength < enough)
            && uniform(mix(bits), 2) < grazing_loss.max(1.0 - strength / enough)
        {
            return 0.0;
        }
        let within = if z < self.farthest { z } else { self.farthest };
        let (head_on, power) =
            self.by_depth[nearest(within * self.steps_a_metre) as usize & (TABLE_STEPS - 1)];
        z += (head_on + slant * power) * normals.pick(bits, 0);
        if self.disparities > 0.0 {
            z = self.disparities / nearest_f32(self.disparities / z.max(1e-3)).max(1.0);
        }
        let z = nearest_f32(z * self.quanta) * self.quantum;
        if z >= self.nearest && z <= self.farthest { z } else { 0.0 }
    }

    /// Measured depth of a pixel at an edge, m; 0 when it is lost.
    #[cold]
    fn at_edge(&self, z: f32, beyond: f32, bits: u64, normals: &NormalTable) -> f32 {
        let fate = uniform(bits, 0);
        if fate < self.edge_loss {
            return 0.0;
        }
        if fate < self.edge_loss + self.flying {
            return z + uniform(bits, 1) * (beyond - z);
        }
        // The edge runs half a pixel away; a shift by more than that puts the pixel on the other side.
        let shift = self.lateral_px * normals.pick(mix(bits), 0);
        if shift > 0.5 { beyond } else { z }
    }
}

/// A number in 0 to 1 from the `nth` group of 20 bits; n is 0 to 2.
fn uniform(bits: u64, nth: u32) -> f32 {
    (bits >> (nth * 20) & 0xF_FFFF) as i32 as f32 * (1.0 / (1 << 20) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::hash;

    fn measured(noise: &DepthNoise, truth: DepthTruth) -> Vec<f64> {
        let model = DepthModel::new(noise);
        let normals = NormalTable::shared();
        (0..40_000).map(|i| f64::from(model.measure(truth, hash(5, i), normals))).collect()
    }

    fn wall(depth: f32, theta_deg: f32) -> DepthTruth {
        DepthTruth { depth, beyond: 0.0, cosine: theta_deg.to_radians().cos(), luminance: 0.6 }
    }

    #[test]
    fn spread_follows_the_published_models() {
        for noise in [DepthNoise::kinect_v2(), DepthNoise::kinect_v1()] {
            for (z, degrees) in [(1.0, 0.0), (2.0, 0.0), (4.0, 0.0), (2.0, 60.5), (3.0, 70.0)] {
                let depths = measured(&noise, wall(z, degrees));
                let n = depths.len() as f64;
                let mean = depths.iter().sum::<f64>() / n;
                let sigma = (depths.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / n).sqrt();
                let stated = noise.sigma(z.into(), f64::from(degrees).to_radians());
                assert!((sigma - stated).abs() < 0.05 * stated + 5e-5, "sigma {sigma} of {stated} at {z} m");
                // Few disparities, each rounded to a millimetre.
                assert!((mean - f64::from(z)).abs() < 0.1 * stated + 5e-4, "mean {mean} of {z}");
            }
        }
    }

    #[test]
    fn the_first_kinect_sees_whole_disparities() {
        let mut depths = measured(&DepthNoise::kinect_v1(), wall(4.9, 0.0));
        depths.retain(|&d| d > 0.0);
        depths.sort_by(f64::total_cmp);
        depths.dedup();
        let steps: Vec<f64> = depths.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(steps.iter().all(|step| (0.055..0.072).contains(step)), "7 cm at 5 m: {steps:?}");
    }

    #[test]
    fn losses_and_flying_pixels_have_their_shares() {
        let v2 = DepthNoise::kinect_v2();
        let lost = |truth| {
            let depths = measured(&v2, truth);
            depths.iter().filter(|&&d| d == 0.0).count() as f64 / depths.len() as f64
        };
        assert_eq!(lost(wall(3.0, 30.0)), 0.0);
        assert!((lost(wall(2.0, 85.0)) - 0.5).abs() < 0.02);
        assert!((lost(DepthTruth { luminance: 0.02, ..wall(5.0, 0.0) }) - 0.8).abs() < 0.02);
        assert_eq!((lost(wall(0.4, 0.0)), lost(wall(9.0, 0.0)), lost(wall(0.0, 0.0))), (1.0, 1.0, 1.0));
        let edge = DepthTruth { beyond: 4.0, ..wall(2.0, 0.0) };
        assert!((lost(edge) - 0.4).abs() < 0.01);
        let share = |noise: &DepthNoise, low: f64, high: f64| {
            measured(noise, edge).iter().filter(|d| (low..high).contains(*d)).count() as f64 / 40_000.0
        };
        assert!((share(&v2, 2.05, 3.95) - 0.3 * 1.9 / 2.0).abs() < 0.02, "flying, evenly between both");
        // A normal shift by more than half a pixel at sigma = 0.8 px: 26.6 % of those not lost.
        assert!((share(&DepthNoise::kinect_v1(), 3.8, 4.2) - 0.8 * 0.266).abs() < 0.02);
    }

    #[test]
    fn depths_are_whole_millimetres() {
        for d in measured(&DepthNoise::default(), wall(3.0, 20.0)) {
            assert!((d * 1e3 - (d * 1e3).round()).abs() < 1e-3);
        }
    }
}
