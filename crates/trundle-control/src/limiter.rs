//! Limits a wanted twist to the speeds and accelerations of the base.
//!
//! Problem: a law commands any twist, while wheels have a maximum speed and acceleration. Idea: a twist that is too fast is slowed along
//! its own curve. During acceleration the turn rate is in proportion to the speed, which keeps the robot on the wanted curve. During
//! braking both fall in proportion, which keeps the robot on its present curve. Cost: O(1).

use trundle_core::{DifferentialDrive, DriveLimits, Invalid, Twist2};

/// Keeps commands within the speed and acceleration limits of the base.
#[derive(Debug, Clone, PartialEq)]
pub struct Limiter {
    limits: DriveLimits,
    wheelbase: f64,
    last: Twist2,
}

/// A command that the base can follow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limited {
    /// The twist to send.
    pub twist: Twist2,
    /// Whether the twist differs from the wanted one.
    pub saturated: bool,
}

/// Largest difference of two twists that counts as rounding, m/s and rad/s. Larger: small saturations go unreported. Source: ours.
const ROUNDING_TOLERANCE: f64 = 1e-9;

impl Limiter {
    /// A limiter for a base at rest.
    ///
    /// # Errors
    /// When a number of the drive or of the limits is not finite and positive.
    pub fn new(drive: DifferentialDrive, limits: DriveLimits) -> Result<Self, Invalid> {
        Ok(Self { limits: limits.validated()?, wheelbase: drive.validated()?.wheelbase, last: Twist2::ZERO })
    }

    /// The limits.
    pub fn limits(&self) -> &DriveLimits {
        &self.limits
    }

    /// The last command.
    pub fn last(&self) -> Twist2 {
        self.last
    }

    /// Sets the twist that was really sent, if it differs from the last command (after a safety stop).
    pub fn sent(&mut self, twist: Twist2) {
        self.last =
            if twist.is_finite() { self.limits.saturate(twist, self.wheelbase) } else { Twist2::ZERO };
    }

    /// The command nearest to `wanted` that is allowed `dt` seconds after the last one. It is within the speed limits, and each component
    /// changes by at most its acceleration times `dt`. A wanted twist with a component that is not finite counts as a stop.
    pub fn limit(&mut self, wanted: Twist2, dt: f64) -> Limited {
        let finite = if wanted.is_finite() { wanted } else { Twist2::ZERO };
        let target = self.limits.saturate(finite, self.wheelbase);
        let dt = if dt.is_finite() { dt.max(0.0) } else { 0.0 };
        let step = Twist2::new(self.limits.acceleration * dt, self.limits.angular_acceleration * dt);
        let curved = self.step_along_curve(target, step);
        let twist = if self.limits.saturate(curved, self.wheelbase) == curved {
            curved
        } else {
            self.step_straight(target, step)
        };
        self.last = twist;
        let saturated = !((twist.v - wanted.v).abs() < ROUNDING_TOLERANCE
            && (twist.omega - wanted.omega).abs() < ROUNDING_TOLERANCE);
        Limited { twist, saturated }
    }

    /// The speed changes up to its limit; the turn rate follows the curve at that speed, within its own limit.
    fn step_along_curve(&self, target: Twist2, step: Twist2) -> Twist2 {
        let last = self.last;
        let v = last.v + (target.v - last.v).clamp(-step.v, step.v);
        let omega = if v == target.v {
            target.omega
        } else if v * target.v > 0.0 && v.abs() < target.v.abs() {
            // During acceleration the twist is on the target's curve at this speed; a base that turns faster need not reduce its turn rate.
            let on_curve = target.omega * v / target.v;
            last.omega.clamp(on_curve.min(target.omega), on_curve.max(target.omega))
        } else {
            last.omega + (target.omega - last.omega) * (v - last.v) / (target.v - last.v)
        };
        Twist2::new(v, last.omega + (omega - last.omega).clamp(-step.omega, step.omega))
    }

    /// A step on the segment from the last twist to the target: the allowed twists are a convex set that contains both.
    fn step_straight(&self, target: Twist2, step: Twist2) -> Twist2 {
        let last = self.last;
        let part = |gap: f64, step: f64| if gap.abs() > step { step / gap.abs() } else { 1.0 };
        let part = part(target.v - last.v, step.v).min(part(target.omega - last.omega, step.omega));
        Twist2::new(last.v + (target.v - last.v) * part, last.omega + (target.omega - last.omega) * part)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn kobuki() -> Limiter {
        Limiter::new(DifferentialDrive::KOBUKI, DriveLimits::KOBUKI).unwrap()
    }

    fn any_twist() -> impl Strategy<Value = Twist2> {
        (-3.0..3.0, -9.0..9.0).prop_map(|(v, omega)| Twist2::new(v, omega))
    }

    proptest! {
        #[test]
        fn limits_hold_for_every_sequence_of_wishes(wishes in prop::collection::vec((any_twist(), 0.0..0.1), 1..60)) {
            let mut limiter = kobuki();
            let limits = DriveLimits::KOBUKI;
            for (wish, dt) in wishes {
                let last = limiter.last();
                let twist = limiter.limit(wish, dt).twist;
                prop_assert!(twist.v.abs() + 0.115 * twist.omega.abs() <= 0.70 + 1e-9);
                prop_assert!(twist.omega.abs() <= limits.omega + 1e-9);
                prop_assert!((twist.v - last.v).abs() <= limits.acceleration * dt + 1e-9);
                prop_assert!((twist.omega - last.omega).abs() <= limits.angular_acceleration * dt + 1e-9);
            }
        }

        #[test]
        fn every_wanted_twist_is_reached(first in any_twist(), wish in any_twist()) {
            let mut limiter = kobuki();
            limiter.sent(first);
            let target = DriveLimits::KOBUKI.saturate(wish, 0.230);
            let steps = (0..400).position(|_| limiter.limit(wish, 0.02).twist == target);
            prop_assert!(steps.is_some(), "stuck at {:?} on the way to {target:?}", limiter.last());
        }

        #[test]
        fn curvature_is_constant_from_rest_and_to_rest(v in 0.1..2.0, curvature in -4.0..4.0) {
            let (v, curvature): (f64, f64) = (v, curvature);
            let mut limiter = kobuki();
            for i in 0..200 {
                let wanted = if i < 100 { Twist2::new(v, v * curvature) } else { Twist2::ZERO };
                let twist = limiter.limit(wanted, 0.02).twist;
                prop_assert!((twist.omega - twist.v * curvature).abs() < 1e-9);
            }
            prop_assert_eq!(limiter.last(), Twist2::ZERO);
        }
    }

    #[test]
    fn a_twist_that_is_not_finite_brakes() {
        let mut limiter = kobuki();
        limiter.sent(Twist2::new(0.3, 0.0));
        let limited = limiter.limit(Twist2::new(f64::NAN, 0.0), 0.02);
        assert!(limited.saturated && limited.twist.v < 0.3);
        limiter.sent(Twist2::new(f64::INFINITY, 0.0));
        assert_eq!(limiter.last(), Twist2::ZERO);
    }
}
