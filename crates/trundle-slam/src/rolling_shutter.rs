use crate::frame::Frame;
use crate::refine::Fix;
use crate::sensor::Sensor;
use nalgebra::{Matrix3x6, Matrix6, Vector6};
use trundle_core::Vector3;

/// How much of what earlier frames said counts on from frame to frame: the last hundred or so count, since the map gets
/// better by what is found out.
const REMEMBERED: f64 = 0.99;
/// How many standard deviations a readout must be above none to be believed.
const SIGNIFICANT: f64 = 5.0;
/// Standard deviation that a readout must be known to, s: a tenth of a px at 0.4 rad/s.
const KNOWN: f64 = 1e-3;
/// The longest readout that is believed, s: more than a camera of 20 Hz has time for.
const LONGEST: f64 = 0.05;

/// Finds out how long a camera takes to read an image, from its first row to its last, from the images themselves.
///
/// A camera that turns while its shutter rolls sees upright lines lean: row by row, what is seen is where the camera has
/// turned to by then. No pose explains that, so what is left of the reprojection errors of a located frame says how long
/// the readout is: one more unknown besides the six of the pose, of which these are eliminated. Cost: some tens of
/// nanoseconds an inlier.
#[derive(Debug, Clone, Default)]
pub(crate) struct RollingShutter {
    /// Sum of the frames' information of the readout, 1/s^2, and of that times what they say, 1/s.
    information: f64,
    weighted: f64,
}

impl RollingShutter {
    /// The readout, s; 0 as long as none is known to be there.
    pub fn readout(&self) -> f64 {
        let readout = self.weighted / self.information;
        let sigma = self.information.sqrt().recip();
        if sigma <= KNOWN && readout >= SIGNIFICANT * sigma { readout.min(LONGEST) } else { 0.0 }
    }

    /// Takes in a located frame that was unrolled by `used` s of readout, while the camera turned by `rate` rad/s.
    pub fn note(&mut self, used: f64, rate: Vector3, frame: &Frame, fix: &Fix, sensor: &Sensor) {
        let camera_from_visual = fix.visual_from_camera().inverse();
        let (mut pose, mut coupling) = (Matrix6::<f64>::zeros(), Vector6::<f64>::zeros());
        let (mut gradient, mut own, mut slope) = (Vector6::<f64>::zeros(), 0.0, 0.0);
        for inlier in fix.inliers() {
            let p = camera_from_visual.transform(inlier.point);
            let seen = sensor.observation(frame, inlier.feature);
            let Some(linear) = seen.linearize(&sensor.camera, p) else { continue };
            let mut by_pose = Matrix3x6::zeros();
            by_pose.fixed_view_mut::<3, 3>(0, 0).copy_from(&-linear.by_point);
            by_pose.fixed_view_mut::<3, 3>(0, 3).copy_from(&(linear.by_point * p.cross_matrix()));
            // Where it was seen moves with the readout as its ray turns; how far it is does not.
            let mut by_readout = -linear.by_point * rate.cross(&p) * frame.lateness(inlier.feature, sensor);
            by_readout.z = 0.0;
            pose += by_pose.transpose() * by_pose;
            coupling += by_pose.transpose() * by_readout;
            gradient += by_pose.transpose() * linear.residual;
            own += by_readout.norm_squared();
            slope += by_readout.dot(&linear.residual);
        }
        let Some(pose) = pose.cholesky() else { return };
        let information = own - coupling.dot(&pose.solve(&coupling));
        let missing = -(slope - coupling.dot(&pose.solve(&gradient)));
        if information > 0.0 && missing.is_finite() {
            self.information = REMEMBERED * self.information + information;
            self.weighted = REMEMBERED * self.weighted + information * used + missing;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::depth::DepthConfig;
    use crate::refine::PointMatch;
    use crate::testing::sensor;
    use nalgebra::UnitQuaternion;
    use trundle_core::{DepthImage, Pose3, Stamp};
    use trundle_optim::PoseConfig;
    use trundle_vision::{Descriptor, Features, Keypoint};

    /// What is found out of a camera with this readout that turns this way and that.
    fn found(readout: f64) -> f64 {
        let (sensor, image) = (sensor(), DepthImage::filled(320, 240, 2.0));
        let mut shutter = RollingShutter::default();
        for number in 0..40 {
            let t = f64::from(number) * 0.3;
            let rate = Vector3::new(0.5 * t.sin(), 1.2 * t.cos(), 0.4 * (2.0 * t).sin());
            let (mut features, mut points) = (Features::default(), Vec::new());
            for i in 0..120 {
                let ray = Vector3::new(f64::from(i % 12) * 0.1 - 0.55, f64::from(i / 12) * 0.08 - 0.36, 1.0);
                let mut pixel = sensor.camera.project(ray).unwrap();
                for _ in 0..5 {
                    let late = readout * (pixel.y / 239.0 - 0.5);
                    pixel =
                        sensor.camera.project(UnitQuaternion::from_scaled_axis(-rate * late) * ray).unwrap();
                }
                // Off by up to half a pixel.
                let off = |k: i32| f64::from((i * 7 + number * 13 + k * 5) % 11) / 11.0 - 0.45;
                let (x, y) = ((pixel.x + off(0)) as f32, (pixel.y + off(1)) as f32);
                features.keypoints.push(Keypoint { x, y, octave: 0, angle: 0.0, response: 1.0 });
                features.descriptors.push(Descriptor::default());
                points.push(ray * 2.0);
            }
            let used = shutter.readout();
            let settings = (&sensor, &DepthConfig::default());
            let frame = Frame::new(Stamp::default(), features, &image, rate * used, settings);
            let matched = |(feature, point)| PointMatch { feature, point, landmark: None, sigma_factor: 1.0 };
            let matches = points.into_iter().enumerate().map(matched).collect();
            let fix = Fix::by(matches, Pose3::identity(), &frame, &sensor, &PoseConfig::default());
            shutter.note(used, rate, &frame, &fix, &sensor);
        }
        shutter.readout()
    }

    #[test]
    fn the_readout_is_found_out_and_none_is_where_there_is_none() {
        for truth in [0.01, 0.026, 0.033] {
            assert!((found(truth) - truth).abs() < 1e-3, "{} is not {truth}", found(truth));
        }
        assert_eq!(found(0.0), 0.0);
    }
}
