//! Small maps for the tests beside the code.

use crate::frame::depth::DepthConfig;
use crate::frame::observation_model::ObservationModel;
use crate::frame::rgbd_frame::Frame;
use crate::ids::KeyframeId;
use crate::map::landmark_map::LandmarkMap;
use crate::place_recognition::place_hypothesis::PlaceHypothesis;
use nalgebra::Vector6;
use trundle_core::{DepthImage, PinholeCamera, Pose2, Pose3, Stamp, Vector2, Vector3};
use trundle_vision::{Descriptor, Features, ImagePatch, Keypoint};

/// A small camera without distortion.
pub(crate) fn model() -> ObservationModel {
    let camera = PinholeCamera::from_field_of_view((320, 240), (1.2, 0.9)).unwrap();
    ObservationModel::new(camera, vec![1.0, 1.2, 1.44], 1.0)
}

fn frame_over(depth: f32, features: usize) -> Frame {
    let keypoint = |i: usize| Keypoint {
        x: (i % 16 * 20) as f32,
        y: (i / 16 * 20) as f32,
        octave: 0,
        angle: 0.0,
        response: 1.0,
    };
    let keypoints = (0..features).map(keypoint).collect();
    let descriptors = (0..features).map(|i| Descriptor([i as u64; 4])).collect();
    let image = DepthImage::filled(320, 240, depth);
    let features = Features { keypoints, descriptors, ..Default::default() };
    let (model, turn) = (model(), Vector3::zeros());
    Frame::new(Stamp::default(), features, &image, turn, (&model, &DepthConfig::default()))
}

/// A frame without depth.
pub(crate) fn blank_frame(features: usize) -> Frame {
    frame_over(0.0, features)
}

/// A frame of a wall at 2 m.
pub(crate) fn frame_with_depth(features: usize) -> Frame {
    frame_over(2.0, features)
}

/// A keyframe at the origin that observes a wall of landmarks.
pub(crate) fn map_of_one_view(features: usize) -> (LandmarkMap, KeyframeId) {
    let (mut map, model) = (LandmarkMap::default(), model());
    let frame = frame_with_depth(features);
    let points: Vec<_> = (0..features).map(|i| frame.point(i, &model).unwrap()).collect();
    let keyframe = map.add_keyframe(frame, Pose3::identity());
    for (feature, point) in points.into_iter().enumerate() {
        let landmark = map.add_landmark(point);
        map.observe(landmark, keyframe, feature);
    }
    (map, keyframe)
}

/// Points of a painted wall at z = 2 m.
pub(crate) fn painted_points() -> Vec<Vector3> {
    (0..48).map(|i| Vector3::new(0.12 * f64::from(i % 8 - 4), 0.12 * f64::from(i / 8 - 3), 2.0)).collect()
}

/// A frame of the painted wall with these points as features, each with an error of `off` px.
pub(crate) fn painted_frame(visual_from_camera: Pose3, points: &[Vector3], off: Vector2) -> Frame {
    let model = model();
    let camera_from_visual = visual_from_camera.inverse();
    let wall = |x: f64, y: f64| {
        let ray = visual_from_camera.rotate(model.camera.unproject(Vector2::new(x, y), 1.0));
        let depth = (2.0 - visual_from_camera.translation.z) / ray.z;
        (visual_from_camera.translation + ray * depth, depth)
    };
    let mut features = Features::default();
    for (i, point) in points.iter().enumerate() {
        let pixel = model.project(camera_from_visual.transform(*point)).unwrap().0 + off;
        let middle = pixel.map(f64::round);
        let shade = |i: usize| {
            let from_middle = Vector2::new((i % 21) as f64, (i / 21) as f64).add_scalar(-10.0);
            paint(wall(middle.x + from_middle.x, middle.y + from_middle.y).0)
        };
        let feature = (pixel - middle).cast::<f32>();
        features.patches.push(ImagePatch::new(std::array::from_fn(shade), feature.into()).unwrap());
        let (x, y) = (pixel.x as f32, pixel.y as f32);
        features.keypoints.push(Keypoint { x, y, octave: 0, angle: 0.0, response: 1.0 });
        features.descriptors.push(Descriptor([i as u64; 4]));
    }
    let image = DepthImage::from_fn(320, 240, |x, y| wall(x as f64, y as f64).1 as f32);
    Frame::new(Stamp::default(), features, &image, Vector3::zeros(), (&model, &DepthConfig::default()))
}

/// The grey value of a point of the wall: a texture without repetition.
fn paint(point: Vector3) -> u8 {
    let (x, y) = (point.x * 110.0, point.y * 110.0);
    (120.0 + 50.0 * (0.5 * x + 0.2 * y).sin() + 40.0 * (0.15 * x - 0.6 * y + 1.0).sin()).round() as u8
}

/// A map of the painted wall, seen from the origin, and the keyframe.
pub(crate) fn painted_map() -> (LandmarkMap, KeyframeId) {
    let (mut map, points) = (LandmarkMap::default(), painted_points());
    let frame = painted_frame(Pose3::identity(), &points, Vector2::zeros());
    let keyframe = map.add_keyframe(frame, Pose3::identity());
    for (feature, point) in points.into_iter().enumerate() {
        let landmark = map.add_landmark(point);
        map.observe(landmark, keyframe, feature);
    }
    (map, keyframe)
}

/// Certainty of a hypothesis.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub(crate) enum Certainty {
    Implausible,
    Plausible,
    Certain,
}

/// A hypothesis on a line: x \[m\], number of points, certainty.
impl PlaceHypothesis for (f64, usize, Certainty) {
    fn pose(&self) -> Pose3 {
        Pose3::new(nalgebra::UnitQuaternion::identity(), Vector3::x() * self.0)
    }

    fn points(&self) -> usize {
        self.1
    }

    fn is_plausible(&self) -> bool {
        self.2 >= Certainty::Plausible
    }

    fn is_certain(&self) -> bool {
        self.2 == Certainty::Certain
    }
}

/// A camera 0.4 m above the floor, turned and tilted on its robot.
pub(crate) fn camera_on_floor() -> Pose3 {
    Pose3::exp(Vector6::new(0.1, 0.02, 0.4, -1.4, 1.1, -1.2))
}

/// The pose of that camera after `i` steps of 0.2 m along a curve.
pub(crate) fn camera_along_floor(i: usize) -> Pose3 {
    let along = 0.2 * i as f64;
    Pose3::from_pose2(Pose2::new(along.sin(), 0.5 * along, 0.3 * along)) * camera_on_floor()
}
