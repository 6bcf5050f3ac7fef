use crate::OdometryConfig;

/// The gyro's bias, measured while the robot stands: a Kalman filter of one number.
#[derive(Debug, Clone)]
pub(crate) struct GyroBias {
    value: f64,
    variance: f64,
    measured: bool,
}

/// Rates farther than this many sigmas from the bias are not those of a robot at rest.
const GATE_SIGMAS: f64 = 4.0;

impl GyroBias {
    pub(crate) fn new(config: &OdometryConfig) -> Self {
        Self { value: 0.0, variance: config.gyro_bias_sigma.powi(2), measured: false }
    }

    /// The bias, rad/s: 0 before it was measured.
    pub(crate) fn value(&self) -> f64 {
        self.value
    }

    /// Whether it was ever measured.
    pub(crate) fn is_measured(&self) -> bool {
        self.measured
    }

    /// Lets `dt` s pass.
    pub(crate) fn wander(&mut self, config: &OdometryConfig, dt: f64) {
        self.variance =
            (self.variance + config.gyro_bias_walk.powi(2) * dt).min(config.gyro_bias_sigma.powi(2));
    }

    /// Whether a rate (rad/s) could be that of a robot at rest.
    pub(crate) fn explains(&self, config: &OdometryConfig, rate: f64) -> bool {
        let sigma = (self.variance + config.gyro_rate_noise.powi(2)).sqrt();
        (rate - self.value).abs() <= GATE_SIGMAS * sigma
    }

    /// Takes in a rate (rad/s) of a robot at rest.
    pub(crate) fn measure(&mut self, config: &OdometryConfig, rate: f64) {
        let gain = self.variance / (self.variance + config.gyro_rate_noise.powi(2));
        self.value += gain * (rate - self.value);
        self.variance *= 1.0 - gain;
        self.measured = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn converges_to_the_mean_rate_and_refuses_a_turn() {
        let config = OdometryConfig::default();
        let mut bias = GyroBias::new(&config);
        assert!(bias.explains(&config, 0.04) && !bias.is_measured());
        for i in 0..200 {
            bias.wander(&config, 0.02);
            bias.measure(&config, 0.013 + if i % 2 == 0 { 0.01 } else { -0.01 });
        }
        assert!((bias.value() - 0.013).abs() < 0.001, "{}", bias.value());
        assert!(!bias.explains(&config, 0.1));
    }
}
