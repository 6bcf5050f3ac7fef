//! Small maps for the tests beside the code.

use crate::depth::DepthConfig;
use crate::frame::Frame;
use crate::ids::KeyframeId;
use crate::map::LandmarkMap;
use crate::sensor::Sensor;
use trundle_core::{DepthImage, PinholeCamera, Pose3, Stamp, Vector3};
use trundle_vision::{Descriptor, Features, Keypoint};

/// A small camera without distortion.
pub(crate) fn sensor() -> Sensor {
    let camera = PinholeCamera::from_field_of_view((320, 240), (1.2, 0.9)).unwrap();
    Sensor::new(camera, vec![1.0, 1.2, 1.44], 1.0)
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
    let features = Features { keypoints, descriptors };
    let (sensor, turn) = (sensor(), Vector3::zeros());
    Frame::new(Stamp::default(), features, &image, turn, (&sensor, &DepthConfig::default()))
}

/// A frame without depth.
pub(crate) fn blank_frame(features: usize) -> Frame {
    frame_over(0.0, features)
}

/// A frame of a wall at 2 m.
pub(crate) fn frame_with_depth(features: usize) -> Frame {
    frame_over(2.0, features)
}

/// A keyframe at the origin that sees a wall of landmarks.
pub(crate) fn map_of_one_view(features: usize) -> (LandmarkMap, KeyframeId) {
    let (mut map, sensor) = (LandmarkMap::default(), sensor());
    let frame = frame_with_depth(features);
    let points: Vec<_> = (0..features).map(|i| sensor.point(&frame, i).unwrap()).collect();
    let keyframe = map.add_keyframe(frame, Pose3::identity());
    for (feature, point) in points.into_iter().enumerate() {
        let landmark = map.add_landmark(point);
        map.observe(landmark, keyframe, feature);
    }
    (map, keyframe)
}
