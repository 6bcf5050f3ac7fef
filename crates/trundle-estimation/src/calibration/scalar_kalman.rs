//! Kalman filter of one scalar.

/// A Kalman filter of a scalar with a random walk, updated during the drive.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ScalarKalman {
    value: f64,
    variance: f64,
}

/// Smallest sigma, ratio. The limit lets the filter follow changes, because errors of neighbouring measurements are correlated. Source:
/// ours.
const MIN_SIGMA: f64 = 3e-4;
/// Random walk from one measurement to the next, ratio (one sigma): tyre wear, floors, temperature. Source: ours.
const RANDOM_WALK_SIGMA: f64 = 1e-4;
/// Gate of the innovation, sigmas. Measurements beyond it are rejected. Source: ours.
const GATE_SIGMAS: f64 = 4.0;

impl ScalarKalman {
    /// The filter without any measurement. A sigma of 0 means a known value, which is never estimated.
    pub(crate) fn new(value: f64, sigma: f64) -> Self {
        Self { value, variance: sigma * sigma }
    }

    pub(crate) fn value(&self) -> f64 {
        self.value
    }

    /// Updates by a measurement, unless outside the gate.
    pub(crate) fn update(&mut self, measured: f64, variance: f64) {
        if self.variance == 0.0 {
            return;
        }
        self.variance += RANDOM_WALK_SIGMA * RANDOM_WALK_SIGMA;
        let (innovation, innovation_variance) = (measured - self.value, self.variance + variance);
        if innovation * innovation <= GATE_SIGMAS * GATE_SIGMAS * innovation_variance {
            let gain = self.variance / innovation_variance;
            self.value += gain * innovation;
            self.variance = ((1.0 - gain) * self.variance).max(MIN_SIGMA * MIN_SIGMA);
        }
    }
}
