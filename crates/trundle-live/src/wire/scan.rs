//! The points of a scan as bytes: kind, 3 bytes of 0, then x and y of each point in the map frame relative to the first three numbers.
//!
//! | bytes | content |
//! |---|---|
//! | 1, 3 | kind; 0 |
//! | 8, 8, 8 | `map_from_base` at the scan: x \[m\], y \[m\], heading \[rad\] |
//! | 2, 2 each | a point in the base frame: x, y \[mm\] |

use super::Kind;
use trundle_core::{Pose2, Scan};

/// Millimetres of a metre. Source: SI.
const MM_PER_M: f64 = 1000.0;

/// The message of a scan. Points farther than 32 m are left out.
pub fn scan_message(scan: &Scan, map_from_base: Pose2) -> Vec<u8> {
    let mut bytes = vec![Kind::Scan as u8, 0, 0, 0];
    for number in [map_from_base.x, map_from_base.y, map_from_base.theta] {
        bytes.extend(number.to_le_bytes());
    }
    for point in scan.hits() {
        let mm = [point.x, point.y].map(|m| (m * MM_PER_M).round());
        if mm.iter().all(|mm| mm.abs() <= f64::from(i16::MAX)) {
            mm.iter().for_each(|mm| bytes.extend((*mm as i16).to_le_bytes()));
        }
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{Beam, Stamp, Vector2};

    #[test]
    fn hits_are_sent_in_millimetres_and_far_ones_left_out() {
        let beams = vec![Beam::Hit { range: 1.5 }, Beam::Free { range: 2.0 }, Beam::Hit { range: 40.0 }];
        let scan = Scan::new(Stamp::default(), Vector2::zeros(), 0.0, 1e-9, beams).unwrap();
        let bytes = scan_message(&scan, Pose2::new(1.0, 2.0, 0.5));
        assert_eq!(bytes.len(), 4 + 24 + 4);
        assert_eq!(i16::from_le_bytes([bytes[28], bytes[29]]), 1500);
    }
}
