//! Features of the camera's last image as bytes.
//!
//! | bytes | content |
//! |---|---|
//! | 1, 3 | kind; 0 |
//! | 2, 2 | width and height of the image \[px\] |
//! | 2, 2 each | a feature: x and y \[1/8 px\]; the highest bit of x: it agrees with the pose |

use super::Kind;
use trundle_app::operator::FeatureView;

/// Parts of a pixel in which a place is sent. Source: ours.
const PARTS_PER_PX: f64 = 8.0;
/// Bit of a feature that agrees with the pose. Source: ours.
const TRACKED_BIT: u16 = 1 << 15;

/// The message of the features of an image.
pub fn features_message(view: &FeatureView) -> Vec<u8> {
    let mut bytes = vec![Kind::Features as u8, 0, 0, 0];
    let mut add = |number: u16| bytes.extend(number.to_le_bytes());
    view.size_px.into_iter().for_each(|side| add(side.min(u16::MAX.into()) as u16));
    for feature in &view.features {
        // The conversion saturates.
        let [x, y] = feature.at_px.map(|px| (PARTS_PER_PX * px).round() as u16 & !TRACKED_BIT);
        add(if feature.is_tracked { x | TRACKED_BIT } else { x });
        add(y);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_app::operator::FeatureSpot;

    #[test]
    fn places_and_the_tracked_bit_are_sent() {
        let spot = |x, y, is_tracked| FeatureSpot { at_px: [x, y], is_tracked };
        let view = FeatureView {
            size_px: [640, 480],
            features: vec![spot(10.5, 20.0, true), spot(639.0, -3.0, false)],
        };
        let bytes = features_message(&view);
        let number = |i: usize| u16::from_le_bytes([bytes[4 + 2 * i], bytes[5 + 2 * i]]);
        assert_eq!([0, 1, 2, 3, 4, 5].map(number), [640, 480, 84 | TRACKED_BIT, 160, 5112, 0]);
        assert_eq!(bytes.len(), 16);
    }
}
