//! Random numbers independent of the order of the work.

use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Random numbers that depend only on seed, update and particle, not on the order of the work.
#[derive(Debug)]
pub(crate) struct ParticleRng(ChaCha8Rng);

impl ParticleRng {
    /// The numbers of a particle in an update; `particle` up to 2^16.
    pub(crate) fn new(seed: u64, update: u64, particle: usize) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream((update << 16) | particle as u64);
        Self(rng)
    }

    /// Uniform in [0, 1).
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0.random()
    }

    /// Uniform in the unit ball.
    pub(crate) fn in_ball(&mut self) -> Vector3<f64> {
        let z = 2.0 * self.uniform() - 1.0;
        let (s, c) = (std::f64::consts::TAU * self.uniform()).sin_cos();
        let (radius, flat) = (self.uniform().cbrt(), (1.0 - z * z).sqrt());
        Vector3::new(flat * c, flat * s, z) * radius
    }

    /// Three independent normal numbers (Box and Muller).
    pub(crate) fn normal3(&mut self) -> Vector3<f64> {
        let mut pair = || {
            let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
            let (s, c) = (std::f64::consts::TAU * self.uniform()).sin_cos();
            (radius * c, radius * s)
        };
        let ((x, y), (z, _)) = (pair(), pair());
        Vector3::new(x, y, z)
    }
}
