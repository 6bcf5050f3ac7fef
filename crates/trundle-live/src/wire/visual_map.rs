//! The visual map as bytes, in the map frame.
//!
//! | bytes | content |
//! |---|---|
//! | 1, 3 | kind; 0 |
//! | 4 | number of keyframes |
//! | 2, 2, 2 each | a keyframe: x, y \[cm\], heading \[1/10000 rad\] |
//! | 2, 2, 2 each | a landmark: x, y, z \[cm\] |

use super::Kind;
use trundle_app::operator::VisualMapView;

/// Centimetres of a metre. Source: SI.
const CM_PER_M: f64 = 100.0;
/// Steps per radian of a heading that is sent. Source: ours.
const HEADING_PARTS_PER_RAD: f64 = 1e4;

/// The message of a visual map. Points farther than 327 m are clamped to this distance.
pub fn visual_map_message(map: &VisualMapView) -> Vec<u8> {
    let mut bytes = vec![Kind::VisualMap as u8, 0, 0, 0];
    bytes.extend((map.keyframes.len() as u32).to_le_bytes());
    let mut add = |numbers: [f64; 3]| {
        // The conversion saturates.
        numbers.iter().for_each(|number| bytes.extend((number.round() as i16).to_le_bytes()));
    };
    for pose in &map.keyframes {
        add([CM_PER_M * pose.x, CM_PER_M * pose.y, HEADING_PARTS_PER_RAD * pose.theta]);
    }
    for at in &map.landmarks {
        add([CM_PER_M * at.x, CM_PER_M * at.y, CM_PER_M * at.z]);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{Pose2, Vector3};

    #[test]
    fn keyframes_come_before_landmarks() {
        let map = VisualMapView {
            keyframes: vec![Pose2::new(1.0, -2.0, 0.5)],
            landmarks: vec![Vector3::new(0.25, 1e9, f64::NAN)],
        };
        let bytes = visual_map_message(&map);
        let number = |i: usize| i16::from_le_bytes([bytes[8 + 2 * i], bytes[9 + 2 * i]]);
        assert_eq!((bytes.len(), bytes[4]), (8 + 12, 1));
        assert_eq!([0, 1, 2, 3, 4, 5].map(number), [100, -200, 5000, 25, i16::MAX, 0]);
    }
}
