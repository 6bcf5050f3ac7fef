//! The law in polar coordinates around the goal.

use crate::stabilization::stabilizer_config::StabilizerConfig;
use std::f64::consts::{FRAC_PI_2, PI};
use trundle_core::{Pose2, Twist2, difference_of_angles, wrap_angle};

/// Direction of driving.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Gear {
    Forward,
    Backward,
}

/// Angle beyond abeam at which the gear changes, rad. Larger: fewer gear changes, longer detours. Source: ours.
const GEAR_HYSTERESIS_RAD: f64 = 0.3;

/// A pose in polar coordinates around the goal; for driving backward both headings are rotated by pi.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Polar {
    /// rho, m.
    pub(super) distance: f64,
    /// alpha, rad.
    pub(super) bearing: f64,
    /// beta, rad.
    pub(super) approach: f64,
}

impl Polar {
    pub(super) fn about(goal: Pose2, pose: Pose2, gear: Gear) -> Self {
        let gap = goal.position() - pose.position();
        let turned = if gear == Gear::Forward { 0.0 } else { PI };
        let direction = gap.y.atan2(gap.x);
        Self {
            distance: gap.norm(),
            bearing: wrap_angle(direction - pose.theta - turned),
            approach: wrap_angle(goal.theta + turned - direction),
        }
    }
}

/// The gear for a goal, given the engaged gear.
pub(super) fn select_gear(goal: Pose2, pose: Pose2, engaged: Option<Gear>) -> Gear {
    let gap = goal.position() - pose.position();
    let bearing = difference_of_angles(gap.y.atan2(gap.x), pose.theta).abs();
    match engaged {
        Some(Gear::Forward) if bearing < FRAC_PI_2 + GEAR_HYSTERESIS_RAD => Gear::Forward,
        Some(Gear::Backward) if bearing > FRAC_PI_2 - GEAR_HYSTERESIS_RAD => Gear::Backward,
        _ if bearing <= FRAC_PI_2 => Gear::Forward,
        _ => Gear::Backward,
    }
}

/// A7 with v = k_rho rho cos(alpha) \[Aicardi95\]: equal to k_rho rho to first order, and never away from the goal. A turn rate above the
/// limit slows the twist along its own curve.
pub(super) fn polar_law(polar: Polar, gear: Gear, config: &StabilizerConfig) -> Twist2 {
    let shaping = (polar.distance / config.shaping_distance).min(1.0);
    let beta = polar.approach.clamp(-config.max_approach, config.max_approach);
    let omega = config.k_alpha * polar.bearing + shaping * config.k_beta * beta;
    let ahead = polar.bearing.cos().max(0.0);
    let v = (config.k_rho * polar.distance).clamp(config.creep_speed, config.speed.max(config.creep_speed))
        * ahead;
    let slower = (config.turn_rate / omega.abs().max(1e-9)).min(1.0);
    let v = if gear == Gear::Forward { v } else { -v };
    Twist2::new(v * slower, omega * slower)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn free() -> StabilizerConfig {
        StabilizerConfig { creep_speed: 0.0, speed: 10.0, turn_rate: 20.0, ..StabilizerConfig::default() }
    }

    proptest! {
        #[test]
        fn backward_is_forward_with_both_headings_turned(x in -1.0..1.0, y in -1.0..1.0, t in -3.0..3.0, g in -3.0..3.0) {
            let (goal, pose) = (Pose2::new(0.0, 0.0, g), Pose2::new(x, y, t));
            let round = |p: Pose2| Pose2::new(p.x, p.y, p.theta + PI);
            let back = polar_law(Polar::about(goal, pose, Gear::Backward), Gear::Backward, &free());
            let forth = polar_law(Polar::about(round(goal), round(pose), Gear::Forward), Gear::Forward, &free());
            prop_assert!((back.v + forth.v).abs() < 1e-9 && (back.omega - forth.omega).abs() < 1e-9);
        }

        #[test]
        fn the_distance_to_the_goal_never_grows(x in -1.0..1.0, y in -1.0..1.0, t in -3.0..3.0, g in -3.0..3.0) {
            let (goal, pose) = (Pose2::new(0.0, 0.0, g), Pose2::new(x, y, t));
            let gear = select_gear(goal, pose, None);
            let twist = polar_law(Polar::about(goal, pose, gear), gear, &StabilizerConfig::default());
            prop_assert!(pose.rotate(trundle_core::Vector2::new(twist.v, 0.0)).dot(&-pose.position()) >= 0.0);
        }
    }

    #[test]
    fn the_integrated_law_reaches_the_pose() {
        let config = StabilizerConfig { shaping_distance: 0.001, ..free() };
        let goal = Pose2::new(1.0, 0.5, 0.7);
        let mut pose = Pose2::new(0.0, 0.4, 0.3);
        for _ in 0..12_000 {
            let twist = polar_law(Polar::about(goal, pose, Gear::Forward), Gear::Forward, &config);
            pose = pose.advance(twist, 0.001);
        }
        assert!(pose.distance(&goal) < 1e-3, "{pose:?}");
        assert!((pose.theta - goal.theta).abs() < 0.02, "{pose:?}");
    }

    #[test]
    fn the_gear_has_hysteresis() {
        let goal = Pose2::new(0.0, 1.0, 0.0);
        let slightly_behind = Pose2::new(0.0, 0.0, -0.1);
        assert_eq!(select_gear(goal, slightly_behind, None), Gear::Backward);
        assert_eq!(select_gear(goal, slightly_behind, Some(Gear::Forward)), Gear::Forward);
        assert_eq!(select_gear(goal, Pose2::new(0.0, 0.0, -0.5), Some(Gear::Forward)), Gear::Backward);
    }
}
