//! `/scan`: the newest scan, where the present estimate has it.

use super::{MAP_FRAME, pose3, timestamp};
use foxglove::messages::LaserScan;
use trundle_app::operator::RunView;
use trundle_core::{Beam, Pose2, Scan, Stamp};

/// The scan of a view. The origin of its angles is the sensor.
pub fn message(view: &RunView) -> Option<(Stamp, LaserScan)> {
    let (scan, map_from_base) = (view.scan.as_ref()?, view.scan_pose?);
    let base_from_sensor = Pose2::new(scan.origin().x, scan.origin().y, 0.0);
    let message = LaserScan {
        timestamp: Some(timestamp(scan.stamp())),
        frame_id: MAP_FRAME.to_owned(),
        pose: Some(pose3(map_from_base * base_from_sensor)),
        start_angle: scan.angle_min(),
        end_angle: scan.angle_min() + scan.angle_increment() * scan.beams().len().saturating_sub(1) as f64,
        ranges: ranges(scan),
        intensities: Vec::new(),
    };
    Some((scan.stamp(), message))
}

/// Ranges at even angles \[m\]; infinite without an obstacle. Beams with bearings of their own count at the nearest even angle.
fn ranges(scan: &Scan) -> Vec<f64> {
    let mut ranges = vec![f64::INFINITY; scan.beams().len()];
    for (i, beam) in scan.beams().iter().enumerate() {
        let Beam::Hit { range } = *beam else { continue };
        let index = ((scan.angle(i) - scan.angle_min()) / scan.angle_increment()).round();
        if let Some(known) = ranges.get_mut(index as usize) {
            *known = known.min(range);
        }
    }
    ranges
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Vector2;

    #[test]
    fn hits_have_a_range_and_all_else_is_infinite() {
        let beams = vec![Beam::Hit { range: 1.5 }, Beam::Free { range: 2.0 }, Beam::Unseen];
        let scan = Scan::new(Stamp::default(), Vector2::zeros(), -0.5, 0.5, beams).unwrap();
        assert_eq!(ranges(&scan), [1.5, f64::INFINITY, f64::INFINITY]);
    }
}
