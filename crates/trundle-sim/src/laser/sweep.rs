//! Measurement of a scan by the simulated laser.

use super::LaserConfig;
use crate::rng::{GOLDEN_RATIO_STEP, hash, mix, normal, unit};
use crate::world::SceneSnapshot;
use rayon::prelude::*;
use trundle_core::{Beam, BeamTimes, Hypotenuse, Invalid, Pose2, Scan, Stamp, Vector2, Vector3};

/// Fewest beams that one thread takes. Source: ours.
const MIN_BEAMS_PER_THREAD: usize = 64;

/// Measures scans. Noise is a hash of (seed, scan, beam): the same on any number of threads.
#[derive(Debug)]
pub(crate) struct Laser {
    config: LaserConfig,
    seed: u64,
}

impl Laser {
    /// A laser of a valid configuration.
    pub(crate) fn new(config: LaserConfig, seed: u64) -> Self {
        Self { config, seed: hash(seed, 0x1A5E) }
    }

    /// Scan number `scan`, ended at `stamp`; `world_from_base(age)` is the base's pose `age` s before.
    ///
    /// # Errors
    /// Never for a valid configuration; the type is that of a scan's constructor.
    pub(crate) fn measure(
        &self,
        snapshot: &SceneSnapshot<'_>,
        world_from_base: impl Fn(f64) -> Pose2 + Sync,
        stamp: Stamp,
        scan: u64,
    ) -> Result<Scan, Invalid> {
        let c = &self.config;
        let key = hash(self.seed, scan);
        let beam = |i: usize| {
            let bits = mix(key.wrapping_add((i as u64).wrapping_mul(GOLDEN_RATIO_STEP)));
            self.beam(snapshot, &world_from_base(self.age(i)), i, bits)
        };
        let beams = (0..c.beams).into_par_iter().with_min_len(MIN_BEAMS_PER_THREAD).map(beam).collect();
        let scan = Scan::new(stamp, Vector2::new(c.x, c.y), c.angle_min(), c.increment(), beams)?;
        let step_s = self.age(0) - self.age(1);
        if c.sweeps { scan.with_beam_times(BeamTimes { first_s: -self.age(0), step_s }) } else { Ok(scan) }
    }

    /// Time between the measurement of beam `i` and the scan's stamp, s.
    fn age(&self, i: usize) -> f64 {
        let c = &self.config;
        let turn = (c.beams as f64 - 1.0 - i as f64) * c.increment() / std::f64::consts::TAU;
        if c.sweeps { turn / c.rate_hz } else { 0.0 }
    }

    fn beam(&self, snapshot: &SceneSnapshot<'_>, world_from_base: &Pose2, i: usize, bits: u64) -> Beam {
        let c = &self.config;
        let angle = c.angle_min() + i as f64 * c.increment();
        let origin = world_from_base.transform(Vector2::new(c.x, c.y));
        let direction = world_from_base.rotate(Vector2::new(angle.cos(), angle.sin()));
        let direction = Vector3::new(direction.x, direction.y, 0.0);
        let hit = snapshot.cast(Vector3::new(origin.x, origin.y, c.z), direction, c.range_max);
        let seen = hit.filter(|hit| hit.normal.dot(&direction).abs() >= c.max_incidence.cos());
        self.reading(seen.map(|hit| hit.distance), bits)
    }

    /// Reading of the device for a return from `range` m, or for none.
    fn reading(&self, range: Option<f64>, bits: u64) -> Beam {
        let c = &self.config;
        if unit(bits) < c.drop_out {
            return Beam::Unseen;
        }
        let Some(range) = range else {
            return if c.silence_is_free { Beam::Free { range: c.range_max } } else { Beam::Unseen };
        };
        let sigma = c.noise.hypotenuse(c.noise_part * range);
        let noisy = range + sigma * normal(mix(bits));
        let range = if c.quantum > 0.0 { (noisy / c.quantum).round() * c.quantum } else { noisy };
        if (c.range_min..=c.range_max).contains(&range) { Beam::Hit { range } } else { Beam::Unseen }
    }
}
