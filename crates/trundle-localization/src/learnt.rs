/// A number learnt while driving: a Kalman filter.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Learnt {
    value: f64,
    variance: f64,
}

/// Never surer than this (one sigma, as a part): neighbouring measurements err alike.
const LEAST_SIGMA: f64 = 3e-4;
/// How far the number may go from one measurement to the next (one sigma, as a part): tyres wear, floors differ, sensors get warm.
const WALK: f64 = 1e-4;
/// Measurements farther off are not believed, sigmas.
const GATE: f64 = 4.0;

impl Learnt {
    /// Before the first measurement; one that is sure (0) is never learnt.
    pub(crate) fn new(value: f64, sigma: f64) -> Self {
        Self { value, variance: sigma * sigma }
    }

    pub(crate) fn value(&self) -> f64 {
        self.value
    }

    /// Takes in a measurement that can be believed.
    pub(crate) fn learn(&mut self, measured: f64, variance: f64) {
        if self.variance == 0.0 {
            return;
        }
        self.variance += WALK * WALK;
        let (off, all) = (measured - self.value, self.variance + variance);
        if off * off <= GATE * GATE * all {
            let gain = self.variance / all;
            self.value += gain * off;
            self.variance = ((1.0 - gain) * self.variance).max(LEAST_SIGMA * LEAST_SIGMA);
        }
    }
}
