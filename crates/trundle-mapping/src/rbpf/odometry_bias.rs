//! Systematic errors of the odometry, estimated from the scan matches.

use crate::rbpf::odometry_noise::Innovation;
use nalgebra::{Matrix2, Vector2, Vector3};
use trundle_core::Pose2;

/// Systematic error of the odometry per distance and per turn, estimated from the matches.
///
/// Unequal wheels, a wrong wheelbase and a gyro's drift give the same error at every step. Systematic errors grow with the distance, noise
/// with its root; the former dominate on smooth floors \[Borenstein96\]. The model of the heading's error is a |distance| + b turn, that of
/// the distance's error c distance. The least squares of the last steps give a, b and c, under a prior that they are 0, as for the means of
/// \[Eliazar04\]'s motion model.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct OdometryBias {
    /// Normal equations of (a, b): upper triangle, right side.
    turn: [f64; 5],
    /// Normal equation of c.
    distance: [f64; 2],
}

/// Prior sigma of the heading bias per distance [rad/m]. Source: \[Borenstein96\], the worst wheels.
const HEADING_BIAS_SIGMA_PER_M: f64 = 0.02;
/// Prior sigma of the heading bias per turn [rad/rad]. Source: \[Borenstein96\], the worst wheels.
const HEADING_BIAS_SIGMA_PER_RAD: f64 = 0.03;
/// Prior sigma of the distance bias per distance \[m/m\]. Source: \[Borenstein96\], the worst wheels.
const DISTANCE_BIAS_SIGMA_PER_M: f64 = 0.03;
/// Number of steps that the sums cover: tyres and floors change slowly. Source: ours.
const MEMORY_STEPS: f64 = 300.0;

impl OdometryBias {
    /// A motion by the odometry (m, rad), corrected by the estimated bias.
    pub(crate) fn corrected(&self, motion: Pose2) -> Pose2 {
        let [_, _, turn] = self.error(motion).into();
        let stretch = 1.0 + self.stretch();
        Pose2::new(motion.x * stretch, motion.y * stretch, motion.theta + turn)
    }

    /// Adds the innovation of a step. `motion` is the odometry's step (m, rad); `innovation` is against the corrected motion, `noise` holds
    /// the variances of a step's errors, both in units of `unit` m.
    pub(crate) fn learn(&mut self, motion: Pose2, innovation: &Innovation, noise: Vector3<f64>, unit: f64) {
        let (distance, forward) = (motion.position().norm(), motion.x);
        let applied = self.error(motion);
        let keep = 1.0 - 1.0 / MEMORY_STEPS;
        self.turn.iter_mut().chain(&mut self.distance).for_each(|sum| *sum *= keep);
        // An error beyond three sigmas is an outlier.
        let known = |k: usize| {
            let variance = noise[k] + innovation.open[k];
            let max = 3.0 * variance.sqrt();
            (innovation.off[k].clamp(-max, max), 1.0 / variance)
        };
        let (off, weight) = known(2);
        let error = off + applied.z;
        let parts = [
            distance * distance,
            distance * motion.theta,
            motion.theta * motion.theta,
            distance * error,
            motion.theta * error,
        ];
        self.turn.iter_mut().zip(parts).for_each(|(sum, part)| *sum += weight * part);
        let (off, weight) = known(0);
        let (error, weight) = (off * unit + applied.x, weight / (unit * unit));
        let parts = [forward * forward, forward * error];
        self.distance.iter_mut().zip(parts).for_each(|(sum, part)| *sum += weight * part);
    }

    /// The errors of a motion: x, y (m), heading.
    fn error(&self, motion: Pose2) -> Vector3<f64> {
        let [aa, ab, bb, ra, rb] = self.turn;
        let information = Matrix2::new(
            aa + HEADING_BIAS_SIGMA_PER_M.powi(-2),
            ab,
            ab,
            bb + HEADING_BIAS_SIGMA_PER_RAD.powi(-2),
        );
        let rates =
            information.try_inverse().map_or(Vector2::zeros(), |inverse| inverse * Vector2::new(ra, rb));
        let turn = rates.x * motion.position().norm() + rates.y * motion.theta;
        Vector3::new(self.stretch() * motion.x, self.stretch() * motion.y, turn)
    }

    fn stretch(&self) -> f64 {
        self.distance[1] / (self.distance[0] + DISTANCE_BIAS_SIGMA_PER_M.powi(-2))
    }

    /// The state as numbers, for saving.
    pub(crate) fn numbers(&self) -> [f64; 7] {
        let ([a, b, c, d, e], [f, g]) = (self.turn, self.distance);
        [a, b, c, d, e, f, g]
    }

    /// Restores the state from its numbers; impossible numbers restart the estimate.
    pub(crate) fn from_numbers([a, b, c, d, e, f, g]: [f64; 7]) -> Self {
        let fair = [a, b, c, d, e, f, g].iter().all(|v| v.is_finite()) && a >= 0.0 && c >= 0.0 && f >= 0.0;
        if fair { Self { turn: [a, b, c, d, e], distance: [f, g] } } else { Self::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rbpf::rng::ParticleRng;

    #[test]
    fn learns_what_is_wrong_at_every_step_among_noise() {
        let (mut bias, mut rng) = (OdometryBias::default(), ParticleRng::new(1, 0, 0));
        for i in 0..400 {
            let turn = [0.0, 0.2, -0.15, 0.0][i % 4];
            let motion = Pose2::new(if turn == 0.0 { 0.3 } else { 0.1 }, 0.0, turn);
            let truth = Pose2::new(motion.x * 1.02, 0.0, turn * 0.98 + 0.006 * motion.x);
            let reported = bias.corrected(motion);
            let noise = Vector3::new(0.2, 0.2, 0.004);
            let off = Vector3::new((truth.x - reported.x) / 0.05, 0.0, truth.theta - reported.theta);
            let off = off + noise.component_mul(&rng.normal3());
            let open = Vector3::new(0.01, 0.01, 1e-6);
            bias.learn(motion, &Innovation { off, open }, noise.component_mul(&noise), 0.05);
        }
        let ahead = bias.corrected(Pose2::new(1.0, 0.0, 0.0));
        assert!((ahead.x - 1.02).abs() < 0.01 && (ahead.theta - 0.006).abs() < 0.003, "{ahead:?}");
        let turned = bias.corrected(Pose2::new(0.0, 0.0, 1.0));
        assert!((turned.theta - 0.98).abs() < 0.01, "{turned:?}");
        assert_eq!(OdometryBias::from_numbers(bias.numbers()), bias);
        assert_eq!(OdometryBias::from_numbers([f64::NAN; 7]), OdometryBias::default());
    }

    #[test]
    fn a_single_wild_step_teaches_next_to_nothing() {
        let mut bias = OdometryBias::default();
        let wild = Innovation { off: Vector3::new(20.0, 0.0, 0.5), open: Vector3::repeat(1e-4) };
        bias.learn(Pose2::new(0.3, 0.0, 0.1), &wild, Vector3::new(0.04, 0.04, 1e-4), 0.05);
        let ahead = bias.corrected(Pose2::new(0.3, 0.0, 0.0));
        assert!(ahead.theta.abs() < 0.02 && (ahead.x - 0.3).abs() < 0.02, "{ahead:?}");
    }
}
