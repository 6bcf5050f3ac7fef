//! Wheel slip as two Ornstein-Uhlenbeck processes.

use super::config::KobukiConfig;
use super::dynamics_step::STEP_S;
use crate::rng::normal;
use rand::Rng;
use rand_chacha::ChaCha8Rng;

/// Slip of both wheels, fraction of their distance: two independent Ornstein-Uhlenbeck processes.
///
/// White noise in each step would shake the body. Slip has the correlation time `slip_time`, the time on one piece of floor.
/// At speed v the distance's variance grows by 2 slip^2 slip_time v per metre \[Chong97\].
#[derive(Debug)]
pub(super) struct Slip {
    rng: ChaCha8Rng,
    keep: f64,
    kick: f64,
    now: [f64; 2],
}

impl Slip {
    pub(super) fn new(config: &KobukiConfig, rng: ChaCha8Rng) -> Self {
        let keep = (-STEP_S / config.slip_time).exp();
        Self { rng, keep, kick: config.slip * (1.0 - keep * keep).sqrt(), now: [0.0; 2] }
    }

    /// Slip (left, right) of the next step.
    pub(super) fn step(&mut self) -> (f64, f64) {
        if self.kick > 0.0 {
            for slip in &mut self.now {
                *slip = self.keep * *slip + self.kick * normal(self.rng.next_u64());
            }
        }
        (self.now[0], self.now[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn spread_and_memory_are_as_configured() {
        let config = KobukiConfig { slip: 0.02, slip_time: 0.05, ..KobukiConfig::default() };
        let mut slip = Slip::new(&config, ChaCha8Rng::seed_from_u64(1));
        let values: Vec<f64> = (0..200_000).map(|_| slip.step().0).collect();
        let mean_product = |lag: usize| {
            values.iter().zip(&values[lag..]).map(|(a, b)| a * b).sum::<f64>() / (values.len() - lag) as f64
        };
        assert!((mean_product(0).sqrt() - 0.02).abs() < 1e-3);
        assert!((mean_product(50) / mean_product(0) - (-1.0_f64).exp()).abs() < 0.05);
    }
}
