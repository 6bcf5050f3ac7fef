//! The infrared light: which sectors a receiver sees.

use super::config::StationConfig;
use crate::world::SceneSnapshot;
use trundle_core::{DockBeams, Pose2, Vector2, Vector3, difference_of_angles};

/// Height of emitters and receivers above the floor \[m\]: within the box, below most furniture's boards. Source: ours.
const LIGHT_HEIGHT_M: f64 = 0.06;
/// Distance of the emitters from the front of the box \[m\]: a ray starts outside the box. Source: ours.
const EMITTER_OFFSET_M: f64 = 1e-3;

/// Pose of a receiver on the robot, `base_from_receiver`, x along its axis.
pub(super) fn receivers(config: &StationConfig) -> [Pose2; 3] {
    let bearing = config.receiver_bearing_deg.to_radians();
    [bearing, 0.0, -bearing].map(|bearing| {
        let at = config.receiver_radius * Vector2::new(bearing.cos(), bearing.sin());
        Pose2::new(at.x, at.y, bearing)
    })
}

/// Light at a receiver with pose `station_from_receiver`; every edge is shifted by `edge_error` rad. Occlusion is not considered.
pub(super) fn beams(config: &StationConfig, receiver: Pose2, edge_error: f64) -> DockBeams {
    let (range, bearing) = (receiver.position().norm(), receiver.y.atan2(receiver.x));
    let to_station = (-receiver.y).atan2(-receiver.x);
    let off_axis = difference_of_angles(to_station, receiver.theta).abs() + edge_error;
    if off_axis > config.receiver_half_view_deg.to_radians() {
        return DockBeams::default();
    }
    let (near, far) = (range <= config.near_range, range > config.near_range && range <= config.far_range);
    let [left, center, right] = sectors(config, bearing + edge_error);
    DockBeams {
        near_left: near && left,
        near_center: near && center,
        near_right: near && right,
        far_left: far && left,
        far_center: far && center,
        far_right: far && right,
    }
}

/// Whether a bearing from the station is in the left, middle and right sector.
fn sectors(config: &StationConfig, bearing: f64) -> [bool; 3] {
    let [middle, bound, overlap] =
        [config.middle_half_angle_deg, config.side_bound_deg, config.overlap_deg / 2.0].map(f64::to_radians);
    let inner = middle - overlap;
    [
        (inner..=bound).contains(&bearing),
        bearing.abs() <= middle + overlap,
        (inner..=bound).contains(&-bearing),
    ]
}

/// Whether the line between the station and a receiver is free (world frame, m).
pub(super) fn is_in_sight(snapshot: &SceneSnapshot<'_>, station: Pose2, receiver: Vector2) -> bool {
    let from = station.transform(Vector2::new(EMITTER_OFFSET_M, 0.0));
    let offset = receiver - from;
    let origin = Vector3::new(from.x, from.y, LIGHT_HEIGHT_M);
    snapshot.cast(origin, Vector3::new(offset.x, offset.y, 0.0), 1.0).is_none()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn seen(x: f64, y: f64) -> DockBeams {
        let facing = Pose2::new(x, y, (-y).atan2(-x));
        beams(&StationConfig::default().without_noise(), facing, 0.0)
    }

    #[test]
    fn each_field_has_its_code() {
        let only = |set: fn(&mut DockBeams)| {
            let mut beams = DockBeams::default();
            set(&mut beams);
            beams
        };
        assert_eq!(seen(0.8, 0.0), only(|b| b.near_center = true));
        assert_eq!(seen(2.0, 0.0), only(|b| b.far_center = true));
        assert_eq!(seen(0.7, 0.4), only(|b| b.near_left = true));
        assert_eq!(seen(2.0, -1.0), only(|b| b.far_right = true));
        assert_eq!(seen(3.1, 0.0), DockBeams::default(), "out of range");
        assert_eq!(seen(0.1, 1.0), DockBeams::default(), "beside the station");
        assert_eq!(seen(-1.0, 0.0), DockBeams::default(), "behind the station");
    }

    #[test]
    fn neighbouring_sectors_overlap() {
        let at = |deg: f64| seen(2.0 * deg.to_radians().cos(), 2.0 * deg.to_radians().sin());
        assert!(at(10.0).far_left && at(10.0).far_center && !at(10.0).far_right);
        assert!(!at(8.0).far_left && at(8.0).far_center);
        assert!(at(12.0).far_left && !at(12.0).far_center);
    }

    /// The vendor's dock drive: a robot in the left sector turns counter-clockwise until its right receiver detects the station. Straight
    /// ahead it then reaches the middle.
    #[test]
    fn the_left_sector_is_where_the_vendors_drive_expects_it() {
        let config = StationConfig::default().without_noise();
        let [_, _, right] = receivers(&config);
        let facing = Pose2::new(2.0, 1.2, PI);
        let sees = |deg: i32| {
            let base = Pose2 { theta: PI + f64::from(deg).to_radians(), ..facing };
            beams(&config, base * right, 0.0).far_left
        };
        let turned = (0..180).find(|deg| sees(*deg)).unwrap();
        let ahead = facing.theta + f64::from(turned).to_radians();
        assert!(turned > 0 && ahead.sin() < -0.3, "it drives towards the axis: {turned} deg");
    }
}
