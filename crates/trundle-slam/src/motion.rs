use nalgebra::{Matrix6, Vector6};
use serde::{Deserialize, Serialize};
use trundle_core::{CameraMotion, Invalid, Pose3, Stamp, Vector3, require_in};

/// How uncertain a pose becomes while the image does not give it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MotionConfig {
    /// Standard deviation of a motion prior after 1 m of way, m, and after 1 rad of turning, rad, 0 to 1. Errors of steps
    /// are independent \[Chong97\], so it grows with the root of the way, however that is cut into steps. Default 0.05:
    /// wheels that slip now and then.
    pub prior_part: f64,
    /// What is added to it after 1 s: m, and rad, 0 or more; grows with the root of the time. Default 0.01.
    pub prior_drift: f64,
    /// Without a prior: how fast the camera may move unseen, m/s, and turn, rad/s, 0 or more. Default 1.
    pub unseen: f64,
    /// Time from the first to the last row of a colour image, s, 0 to 0.05: a rolling shutter, whose lines lean while the
    /// camera turns. Default 0, all rows at once; a Kinect v1 takes 0.026 \[Ringaby11\].
    pub readout: f64,
}

impl Default for MotionConfig {
    fn default() -> Self {
        Self { prior_part: 0.05, prior_drift: 0.01, unseen: 1.0, readout: 0.0 }
    }
}

impl MotionConfig {
    /// Standard deviations of a motion prior's translation (m) and rotation (rad) over so many seconds.
    pub fn sigmas(&self, motion: Pose3, seconds: f64) -> (f64, f64) {
        let drift = self.prior_drift * seconds.sqrt();
        let grown = |way: f64| (self.prior_part * way.sqrt()).hypot(drift);
        (grown(motion.translation.norm()), grown(motion.angle()))
    }

    /// The covariance of a motion prior over so many seconds: its own, if it can be one, else by these settings.
    pub(crate) fn covariance_of(&self, prior: &CameraMotion, seconds: f64) -> Matrix6<f64> {
        prior.covariance.filter(is_covariance).unwrap_or_else(|| {
            let (along, turned) = self.sigmas(prior.motion, seconds);
            of_sigmas(along, turned)
        })
    }

    /// Passes a valid configuration through.
    ///
    /// # Errors
    /// When a number is out of the range that its field names.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("motion.prior_part", self.prior_part, "", 0.0, 1.0)?;
        require_in("motion.prior_drift", self.prior_drift, "", 0.0, 1e3)?;
        require_in("motion.unseen", self.unseen, "", 0.0, 1e3)?;
        require_in("motion.readout", self.readout, "s", 0.0, 0.05)?;
        Ok(self)
    }
}

/// Where the camera is believed to be, and how it moves.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Belief {
    pub stamp: Option<Stamp>,
    pub visual_from_camera: Pose3,
    /// Of a right perturbation.
    pub covariance: Matrix6<f64>,
    /// Right tangent a second, while the last two frames were located.
    pub(crate) velocity: Option<Vector6<f64>>,
}

impl Belief {
    /// At a pose taken as known, standing still.
    pub fn at(visual_from_camera: Pose3) -> Self {
        Self { stamp: None, visual_from_camera, covariance: Matrix6::zeros(), velocity: None }
    }

    /// At a pose that says nothing: as far off as any map reaches, and turned anyhow.
    pub fn anywhere() -> Self {
        let covariance = Matrix6::from_diagonal(&Vector6::new(1e6, 1e6, 1e6, 10.0, 10.0, 10.0));
        Self { covariance, ..Self::at(Pose3::identity()) }
    }

    /// Where the camera should be at `stamp`: moved by the prior, else on at the same velocity, else where it was.
    pub fn predict(&self, stamp: Stamp, prior: Option<Pose3>) -> Pose3 {
        (self.visual_from_camera * self.motion(stamp, prior)).renormalized()
    }

    /// How fast the camera should be turning at `stamp`, rad/s, camera frame.
    pub fn turn_rate(&self, stamp: Stamp, prior: Option<Pose3>) -> Vector3 {
        let elapsed = self.seconds_until(stamp);
        if elapsed > 0.0 {
            self.motion(stamp, prior).rotation.scaled_axis() / elapsed
        } else {
            Vector3::zeros()
        }
    }

    /// The motion since the last frame.
    fn motion(&self, stamp: Stamp, prior: Option<Pose3>) -> Pose3 {
        let elapsed = self.seconds_until(stamp);
        let going_on = || self.velocity.map(|velocity| Pose3::exp(velocity * elapsed));
        self.since_last(prior).or_else(going_on).unwrap_or_default()
    }

    /// The frame at `stamp` was located. `before` is where the last frame was, as the map has it now, if it was located.
    pub fn located(&mut self, stamp: Stamp, pose: Pose3, covariance: Matrix6<f64>, before: Option<Pose3>) {
        let elapsed = self.seconds_until(stamp);
        self.velocity = before.filter(|_| elapsed > 0.0).map(|b| (b.inverse() * pose).log() / elapsed);
        (self.stamp, self.visual_from_camera, self.covariance) = (Some(stamp), pose, covariance);
    }

    /// The frame at `stamp` was not located: moves by the prior, or holds the pose, and grows uncertain.
    pub fn missed(&mut self, stamp: Stamp, prior: Option<CameraMotion>, config: &MotionConfig) {
        let elapsed = self.seconds_until(stamp);
        let motion = self.since_last(prior.map(|prior| prior.motion)).unwrap_or_default();
        let noise = match prior {
            Some(prior) => config.covariance_of(&prior, elapsed),
            None => of_sigmas(config.unseen * elapsed, config.unseen * elapsed),
        };
        self.covariance = carried(&self.covariance, motion) + noise;
        self.visual_from_camera = (self.visual_from_camera * motion).renormalized();
        (self.stamp, self.velocity) = (Some(stamp), None);
    }

    /// The prior, unless this is the first frame, before which there was nothing to move from.
    fn since_last(&self, prior: Option<Pose3>) -> Option<Pose3> {
        prior.filter(|_| self.stamp.is_some())
    }

    /// Seconds since the last frame, 0 for the first or when stamps go back.
    pub fn seconds_until(&self, stamp: Stamp) -> f64 {
        self.stamp.map_or(0.0, |last| (stamp - last).max(0.0))
    }
}

/// Faster than this no camera moves that nobody tells about: m/s, a brisk walk, and rad/s, 200 deg.
pub(crate) const FASTEST_CAMERA: (f64, f64) = (2.0, 3.5);

/// Whether something can have moved so in so many seconds: by `least` (m and rad) however short they are, and by no more than
/// `fastest` (m/s and rad/s) besides.
pub(crate) fn is_within(motion: Pose3, least: f64, fastest: (f64, f64), seconds: f64) -> bool {
    motion.translation.norm() <= least + fastest.0 * seconds && motion.angle() <= least + fastest.1 * seconds
}

/// Whether a matrix is symmetric and has no negative variance, but for rounding.
fn is_covariance(matrix: &Matrix6<f64>) -> bool {
    let size = matrix.amax();
    let lifted = matrix + Matrix6::identity() * (1e-9 * size + f64::MIN_POSITIVE);
    (matrix - matrix.transpose()).amax() <= 1e-9 * size && lifted.cholesky().is_some()
}

pub(crate) fn of_sigmas(along: f64, turned: f64) -> Matrix6<f64> {
    let (along, turned) = (along * along, turned * turned);
    Matrix6::from_diagonal(&Vector6::new(along, along, along, turned, turned, turned))
}

/// The covariance of `a_from_b * motion` when that of `a_from_b` is `covariance` and the motion is exact; both as right
/// perturbations.
pub(crate) fn carried(covariance: &Matrix6<f64>, motion: Pose3) -> Matrix6<f64> {
    let backward = motion.inverse().adjoint();
    backward * covariance * backward.transpose()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_adjoint_moves_a_perturbation_through_a_pose(
            a in prop::array::uniform6(-1.0..1.0), b in prop::array::uniform6(-1e-4..1e-4),
        ) {
            let (pose, small) = (Pose3::exp(Vector6::from(a)), Vector6::from(b));
            let through = (pose * Pose3::exp(small) * pose.inverse()).log();
            prop_assert!((through - pose.adjoint() * small).norm() < 1e-10);
        }
    }

    #[test]
    fn velocity_carries_on_for_the_time_that_passed() {
        let mut belief = Belief::at(Pose3::identity());
        let at = |secs: f64| Stamp::from_secs(secs).unwrap();
        let step = Pose3::exp(Vector6::new(0.1, 0.0, 0.0, 0.0, 0.05, 0.0));
        belief.located(at(0.0), Pose3::identity(), Matrix6::zeros(), None);
        belief.located(at(0.1), step, Matrix6::zeros(), Some(Pose3::identity()));
        let predicted = belief.predict(at(0.3), None);
        assert!((predicted.inverse() * (step * step * step)).log().norm() < 1e-9);
        let prior = Pose3::exp(Vector6::new(0.0, 0.0, 1.0, 0.0, 0.0, 0.0));
        assert_eq!(belief.predict(at(0.3), Some(prior)), (step * prior).renormalized());
    }

    #[test]
    fn how_a_way_is_cut_into_steps_does_not_matter() {
        let config = MotionConfig::default();
        let way = |metres: f64| Pose3::exp(Vector6::new(metres, 0.0, 0.0, 0.0, 0.0, 0.0));
        let (whole, _) = config.sigmas(way(1.0), 2.0);
        let (part, _) = config.sigmas(way(0.1), 0.2);
        assert!((whole * whole - 10.0 * part * part).abs() < 1e-12);
    }

    #[test]
    fn what_cannot_be_a_covariance_is_not_taken_for_one() {
        let config = MotionConfig::default();
        let step = Pose3::exp(Vector6::repeat(0.01));
        let told = |matrix: Matrix6<f64>| CameraMotion { motion: step, covariance: Some(matrix) };
        let own = config.covariance_of(&step.into(), 0.1);
        let mut lopsided = Matrix6::identity();
        lopsided[(0, 1)] = 0.5;
        for wrong in [
            -Matrix6::identity(),
            lopsided,
            Matrix6::from_diagonal(&Vector6::new(1.0, 1.0, -0.1, 1.0, 1.0, 1.0)),
        ] {
            assert_eq!(config.covariance_of(&told(wrong), 0.1), own);
        }
        let planar = Matrix6::from_diagonal(&Vector6::new(1e-6, 1e-6, 0.0, 0.0, 0.0, 1e-8));
        for right in [planar, Matrix6::zeros()] {
            assert_eq!(config.covariance_of(&told(right), 0.1), right);
        }
    }

    #[test]
    fn uncertainty_grows_while_nothing_is_seen() {
        let mut belief = Belief::at(Pose3::identity());
        let config = MotionConfig::default();
        let mut last = 0.0;
        belief.missed(
            Stamp::from_secs(-0.1).unwrap(),
            Some(Pose3::exp(Vector6::repeat(1.0)).into()),
            &config,
        );
        assert_eq!(belief.visual_from_camera, Pose3::identity(), "nothing to move from");
        for i in 0..5 {
            let stamp = Stamp::from_secs(f64::from(i) * 0.1).unwrap();
            let prior = Pose3::exp(Vector6::new(0.0, 0.0, 0.1, 0.0, 0.1, 0.0));
            belief.missed(stamp, Some(prior.into()), &config);
            let trace = belief.covariance.trace();
            assert!(trace > last);
            last = trace;
        }
        belief.missed(Stamp::from_secs(2.0).unwrap(), None, &config);
        assert!(belief.covariance.trace() > last + 5.0);
    }
}
