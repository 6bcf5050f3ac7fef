//! Predicted pose of the camera between located frames.

use crate::motion::motion_model::MotionModelConfig;
use crate::motion::uncertain_pose::{UncertainPose, of_sigmas};
use nalgebra::{Matrix6, Vector6};
use trundle_core::{CameraMotion, Pose3, Stamp, Vector3};

/// Predicted pose and motion of the camera.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PoseBelief {
    pub stamp: Option<Stamp>,
    pub visual_from_camera: Pose3,
    /// Covariance of the pose as a right perturbation.
    pub covariance: Matrix6<f64>,
    /// Right tangent per second, while the last two frames were located.
    pub velocity: Option<Vector6<f64>>,
}

impl PoseBelief {
    /// A camera at rest at a known pose.
    pub fn at(visual_from_camera: Pose3) -> Self {
        Self { stamp: None, visual_from_camera, covariance: Matrix6::zeros(), velocity: None }
    }

    /// A camera at an unknown pose: the covariance is larger than any map.
    pub fn anywhere() -> Self {
        let covariance = Matrix6::from_diagonal(&Vector6::new(1e6, 1e6, 1e6, 10.0, 10.0, 10.0));
        Self { covariance, ..Self::at(Pose3::identity()) }
    }

    /// Predicted pose at `stamp`: moved by the prior, else at constant velocity, else at rest.
    pub fn predict(&self, stamp: Stamp, prior: Option<Pose3>) -> Pose3 {
        (self.visual_from_camera * self.motion(stamp, prior)).renormalized()
    }

    /// Predicted turn rate at `stamp`, rad/s, camera frame.
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
        let at_constant_velocity = || self.velocity.map(|velocity| Pose3::exp(velocity * elapsed));
        self.since_last(prior).or_else(at_constant_velocity).unwrap_or_default()
    }

    /// Sets the pose of the located frame at `stamp`. `before` is the last frame's pose by the present map, if that frame was located.
    pub fn located(&mut self, stamp: Stamp, pose: Pose3, covariance: Matrix6<f64>, before: Option<Pose3>) {
        let elapsed = self.seconds_until(stamp);
        self.velocity = before.filter(|_| elapsed > 0.0).map(|b| (b.inverse() * pose).log() / elapsed);
        (self.stamp, self.visual_from_camera, self.covariance) = (Some(stamp), pose, covariance);
    }

    /// Predicts over a frame at `stamp` that was not located: moves by the prior, else holds the pose, and grows the covariance.
    pub fn missed(&mut self, stamp: Stamp, prior: Option<CameraMotion>, config: &MotionModelConfig) {
        let elapsed = self.seconds_until(stamp);
        let motion = self.since_last(prior.map(|prior| prior.motion)).unwrap_or_default();
        let covariance = match prior {
            Some(prior) => config.covariance_of(&prior, elapsed),
            None => of_sigmas(config.unseen * elapsed, config.unseen * elapsed),
        };
        let believed = UncertainPose { pose: self.visual_from_camera, covariance: self.covariance };
        let moved = believed.then(&UncertainPose { pose: motion, covariance });
        (self.visual_from_camera, self.covariance) = (moved.pose, moved.covariance);
        (self.stamp, self.velocity) = (Some(stamp), None);
    }

    /// The prior; `None` for the first frame.
    fn since_last(&self, prior: Option<Pose3>) -> Option<Pose3> {
        prior.filter(|_| self.stamp.is_some())
    }

    /// Seconds since the last frame, 0 for the first or when stamps go back.
    pub fn seconds_until(&self, stamp: Stamp) -> f64 {
        self.stamp.map_or(0.0, |last| (stamp - last).max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_camera_is_predicted_at_constant_velocity() {
        let mut belief = PoseBelief::at(Pose3::identity());
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
    fn uncertainty_grows_while_nothing_is_seen() {
        let mut belief = PoseBelief::at(Pose3::identity());
        let config = MotionModelConfig::default();
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
