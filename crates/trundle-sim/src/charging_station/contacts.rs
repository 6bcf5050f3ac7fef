//! The charging contacts: whether the robot touches the plates at a pose.

use super::config::StationConfig;
use std::f64::consts::PI;
use trundle_core::{Footprint, Pose2, difference_of_angles};

/// Whether the robot's contacts touch the plates, `station_from_base`.
pub(super) fn touches_plates(config: &StationConfig, footprint: &Footprint, base: Pose2) -> bool {
    let gap = base.x - front_of(footprint);
    let heading_error = difference_of_angles(base.theta, PI).abs();
    (0.0..=config.contact_gap).contains(&gap.max(0.0))
        && base.y.abs() <= config.contact_lateral
        && heading_error <= config.contact_heading_deg.to_radians()
}

/// Distance from the base's origin to the front of its footprint, m.
fn front_of(footprint: &Footprint) -> f64 {
    match footprint {
        Footprint::Disc { radius } => *radius,
        Footprint::Polygon { corners } => corners.iter().map(|corner| corner.x).fold(0.0, f64::max),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_plates_touch_a_robot_straight_in_front_and_no_other() {
        let (config, footprint) = (StationConfig::default(), Footprint::KOBUKI);
        let front = footprint.circumscribed_radius();
        let touches = |dx: f64, y: f64, deg: f64| {
            touches_plates(&config, &footprint, Pose2::new(front + dx, y, PI + deg.to_radians()))
        };
        assert!(touches(0.0, 0.0, 0.0) && touches(0.009, 0.009, -2.9));
        assert!(!touches(0.011, 0.0, 0.0) && !touches(0.0, -0.011, 0.0) && !touches(0.0, 0.0, 3.1));
        assert!(!touches_plates(&config, &footprint, Pose2::new(front, 0.0, 0.0)), "it faces away");
    }
}
