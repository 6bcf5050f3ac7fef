//! Weighted candidates of the station's pose.

use super::random::Random;
use nalgebra::{Matrix3, Vector3};
use trundle_core::{Pose2, difference_of_angles};

/// Shrinkage towards the mean in resampling, with which the kernel preserves mean and covariance. Source: Liu and West 2001.
const SHRINKAGE_FACTOR: f64 = 0.95;
/// Effective fraction of the particles below which they are resampled. Source: the usual half.
const MIN_EFFECTIVE_PART: f64 = 0.5;

/// A candidate.
#[derive(Debug, Clone, Copy)]
pub(super) struct Particle {
    pub(super) map_from_station: Pose2,
    pub(super) weight: f64,
}

/// Weighted candidates.
#[derive(Debug, Clone, Default)]
pub(super) struct Particles(pub(super) Vec<Particle>);

impl Particles {
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Multiplies each weight by its likelihood; returns the mean likelihood, or 0 if all weights vanish.
    pub(super) fn weigh(&mut self, likelihood: impl Fn(Pose2) -> f64) -> f64 {
        for particle in &mut self.0 {
            particle.weight *= likelihood(particle.map_from_station);
        }
        let sum: f64 = self.0.iter().map(|particle| particle.weight).sum();
        if sum > 0.0 {
            self.0.iter_mut().for_each(|particle| particle.weight /= sum);
        }
        sum
    }

    /// Effective number of particles.
    fn effective_size(&self) -> f64 {
        1.0 / self.0.iter().map(|particle| particle.weight * particle.weight).sum::<f64>()
    }

    /// Resamples if few particles are effective, with a kernel that preserves mean and covariance.
    pub(super) fn resample_if_needed(&mut self, random: &mut Random) {
        if self.effective_size() < MIN_EFFECTIVE_PART * self.0.len() as f64 {
            self.resample(self.0.len(), random);
        }
    }

    /// Draws `count` particles by weight (low variance), shrunk towards the mean and spread by the kernel.
    pub(super) fn resample(&mut self, count: usize, random: &mut Random) {
        let (mean, covariance) = self.moments();
        let spread = factor(&covariance) * (1.0 - SHRINKAGE_FACTOR * SHRINKAGE_FACTOR).sqrt();
        let step = 1.0 / count as f64;
        let (mut at, mut sum, mut i) = (step * random.unit(), self.0[0].weight, 0);
        let mut drawn = Vec::with_capacity(count);
        for _ in 0..count {
            while sum < at && i + 1 < self.0.len() {
                i += 1;
                sum += self.0[i].weight;
            }
            at += step;
            let off = offset(mean, self.0[i].map_from_station) * SHRINKAGE_FACTOR;
            let off = off + spread * Vector3::from(random.normal3());
            drawn.push(Particle { map_from_station: moved(mean, off), weight: step });
        }
        self.0 = drawn;
    }

    /// Spreads the set by `sigma` (m, m, rad) in each candidate's frame.
    pub(super) fn diffuse(&mut self, sigma: Vector3<f64>, random: &mut Random) {
        for particle in &mut self.0 {
            let [x, y, theta] = random.normal3();
            particle.map_from_station =
                particle.map_from_station * Pose2::new(sigma.x * x, sigma.y * y, sigma.z * theta);
        }
    }

    /// Weighted mean, and covariance in the frame of the mean (right perturbation: x, y, heading).
    pub(super) fn moments(&self) -> (Pose2, Matrix3<f64>) {
        let mut sum = [0.0; 4];
        for Particle { map_from_station: pose, weight } in &self.0 {
            let (s, c) = pose.theta.sin_cos();
            for (total, value) in sum.iter_mut().zip([pose.x, pose.y, c, s]) {
                *total += weight * value;
            }
        }
        let mean = Pose2::new(sum[0], sum[1], sum[3].atan2(sum[2]));
        let mut covariance = Matrix3::zeros();
        for Particle { map_from_station: pose, weight } in &self.0 {
            let off = offset(mean, *pose);
            covariance += off * off.transpose() * *weight;
        }
        (mean, covariance)
    }
}

/// A pose in the frame of another: x, y, heading.
fn offset(mean: Pose2, pose: Pose2) -> Vector3<f64> {
    let off = mean.inverse() * pose;
    Vector3::new(off.x, off.y, difference_of_angles(off.theta, 0.0))
}

fn moved(mean: Pose2, off: Vector3<f64>) -> Pose2 {
    mean * Pose2::new(off.x, off.y, off.z)
}

/// A matrix whose product with its transpose is the covariance; for a singular covariance, only of the diagonal.
fn factor(covariance: &Matrix3<f64>) -> Matrix3<f64> {
    covariance.cholesky().map_or_else(
        || Matrix3::from_diagonal(&covariance.diagonal().map(|v| v.max(0.0).sqrt())),
        |cholesky| cholesky.l(),
    )
}
