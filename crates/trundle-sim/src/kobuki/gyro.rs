//! The gyro: scale error, bias random walk and white noise.

use super::config::KobukiConfig;
use super::tolerance::tolerance;
use crate::rng::normal;
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use trundle_core::Stamp;

/// A rate gyro: the mean rate since the last reading, with scale error, a bias that walks, and white noise.
#[derive(Debug)]
pub(super) struct Gyro {
    rng: ChaCha8Rng,
    scale: f64,
    bias: f64,
    bias_walk: f64,
    noise: f64,
    /// Stamp and heading (rad, not wrapped) of the last reading.
    last: Option<(Stamp, f64)>,
}

impl Gyro {
    pub(super) fn new(config: &KobukiConfig, mut rng: ChaCha8Rng) -> Self {
        Self {
            scale: 1.0 + config.gyro_scale_error * tolerance(&mut rng),
            bias: config.gyro_bias * tolerance(&mut rng),
            bias_walk: config.gyro_bias_walk,
            noise: config.gyro_noise,
            last: None,
            rng,
        }
    }

    /// The rate, rad/s, when the body has turned by `turned` rad since the start.
    pub(super) fn read(&mut self, stamp: Stamp, turned: f64) -> f64 {
        let (earlier, before) = self.last.unwrap_or((stamp, turned));
        self.last = Some((stamp, turned));
        let elapsed = stamp - earlier;
        let rate = if elapsed > 0.0 { (turned - before) / elapsed } else { 0.0 };
        self.bias += self.bias_walk * elapsed.sqrt() * normal(self.rng.next_u64());
        self.scale * rate + self.bias + self.noise * normal(self.rng.next_u64())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    fn readings(config: &KobukiConfig, rate: f64, n: i64) -> Vec<f64> {
        let mut gyro = Gyro::new(config, ChaCha8Rng::seed_from_u64(3));
        (0..n).map(|i| gyro.read(Stamp::from_nanos(i * 20_000_000), rate * i as f64 * 0.02)).collect()
    }

    #[test]
    fn noise_has_its_spread_and_bias_its_walk() {
        let white = KobukiConfig { gyro_noise: 0.01, ..KobukiConfig::default().without_noise() };
        let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
        let rates = readings(&white, 0.5, 20_001);
        let spread = mean(&rates[1..].iter().map(|r| (r - 0.5).powi(2)).collect::<Vec<_>>()).sqrt();
        assert!((mean(&rates[1..]) - 0.5).abs() < 5e-4 && (spread - 0.01).abs() < 3e-4, "{spread}");
        let walk = KobukiConfig { gyro_bias_walk: 0.01, ..KobukiConfig::default().without_noise() };
        let rates = readings(&walk, 0.0, 20_001);
        let steps: Vec<f64> = rates.windows(2).map(|w| (w[1] - w[0]).powi(2) / 0.02).collect();
        assert!((mean(&steps).sqrt() - 0.01).abs() < 3e-4);
    }

    #[test]
    fn without_noise_it_integrates_to_the_heading() {
        let rates = readings(&KobukiConfig::default().without_noise(), 0.7, 101);
        assert!((rates.iter().sum::<f64>() * 0.02 - 1.4).abs() < 1e-12);
    }
}
