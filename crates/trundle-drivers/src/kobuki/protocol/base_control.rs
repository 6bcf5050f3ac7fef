//! Base control: speed and radius for a twist, and the twist for speed and radius.

use trundle_core::Twist2;

/// Half the distance between the wheels in the firmware: 115 mm. Source: the protocol's "Base Control", b = 230 mm.
const HALF_WHEELBASE_MM: f64 = 115.0;
/// Turn rate below which the base drives straight: 1e-4 rad/s. Source: the vendor's driver.
const MIN_TURN_RATE_RAD_S: f64 = 1e-4;
/// Speed below which the base turns on the spot: 1e-4 m/s. Source: the vendor's driver.
const MIN_SPEED_M_S: f64 = 1e-4;
/// Radius up to which the base turns on the spot: 1 mm. Source: the protocol's "Base Control".
const SPIN_RADIUS_MM: f64 = 1.0;
/// Radius above which straight ahead is the nearest possible curve: 65534 mm. Source: ours; the radius field ends at 32767 mm, and half of
/// that curvature is nearer to zero.
const STRAIGHT_RADIUS_MM: f64 = 65534.0;

/// Content of the base control command.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct BaseControl {
    /// Speed of the wheel on the outside of the curve, mm/s; of both wheels when straight.
    pub speed_mm_s: i16,
    /// Radius of the curve, mm: positive with the centre at the left; 0 is straight ahead, 1 a turn on the spot.
    pub radius_mm: i16,
}

impl BaseControl {
    /// The command that stops the base.
    pub const STOP: Self = Self { speed_mm_s: 0, radius_mm: 0 };

    /// The command for a twist of the base: v in m/s, omega in rad/s, counter-clockwise. A twist that is not finite stops the base. Numbers
    /// outside the fields' range are clamped, the others truncated to whole mm.
    pub fn from_twist(twist: Twist2) -> Self {
        let Twist2 { v, omega } = twist;
        if !(v.is_finite() && omega.is_finite()) {
            return Self::STOP;
        }
        let radius = 1000.0 * v / omega;
        if omega.abs() < MIN_TURN_RATE_RAD_S {
            Self::new(1000.0 * v, 0.0)
        } else if v.abs() < MIN_SPEED_M_S || radius.abs() <= SPIN_RADIUS_MM {
            Self::new(HALF_WHEELBASE_MM * omega, 1.0)
        } else {
            let kept = if radius.abs() > STRAIGHT_RADIUS_MM { 0.0 } else { radius };
            Self::new((radius + HALF_WHEELBASE_MM.copysign(radius)) * omega, kept)
        }
    }

    /// Clamps, then truncates.
    fn new(speed_mm_s: f64, radius_mm: f64) -> Self {
        Self { speed_mm_s: speed_mm_s as i16, radius_mm: radius_mm as i16 }
    }

    /// The twist of the base for this command: v in m/s, omega in rad/s, counter-clockwise.
    pub fn twist(self) -> Twist2 {
        let (speed, radius) = (f64::from(self.speed_mm_s), f64::from(self.radius_mm));
        match self.radius_mm {
            0 => Twist2::new(speed / 1000.0, 0.0),
            -1 | 1 => Twist2::new(0.0, radius * speed / HALF_WHEELBASE_MM),
            _ => {
                let omega = speed / (radius + HALF_WHEELBASE_MM.copysign(radius));
                Twist2::new(radius * omega / 1000.0, omega)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn control(v: f64, omega: f64) -> (i16, i16) {
        let BaseControl { speed_mm_s, radius_mm } = BaseControl::from_twist(Twist2::new(v, omega));
        (speed_mm_s, radius_mm)
    }

    #[test]
    fn straight_spin_and_curves_follow_the_table() {
        assert_eq!(control(0.3, 0.0), (300, 0));
        assert_eq!(control(-0.3, 5e-5), (-300, 0));
        assert_eq!(control(0.0, 1.0), (115, 1));
        assert_eq!(control(5e-5, -1.0), (-115, 1));
        assert_eq!(control(0.5, 1.0), (615, 500));
        assert_eq!(control(0.5, -1.0), (615, -500));
        assert_eq!(control(-0.5, 1.0), (-615, -500));
        assert_eq!(control(0.2, 0.3), (234, 666));
    }

    #[test]
    fn numbers_beyond_the_fields_are_clamped() {
        assert_eq!(control(1e6, 0.0), (32767, 0));
        assert_eq!(control(0.5, 0.010), (501, 32767));
        assert_eq!(control(-0.5, 0.010), (-501, -32768));
        assert_eq!(control(0.5, 0.005), (500, 0), "100 m is nearer to straight than to 33 m");
        assert_eq!(control(f64::NAN, 0.0), (0, 0));
        assert_eq!(control(0.1, f64::INFINITY), (0, 0));
    }

    proptest! {
        #[test]
        fn the_twist_comes_back_to_a_millimetre(v in -0.7..0.7f64, omega in -3.1..3.1f64) {
            let back = BaseControl::from_twist(Twist2::new(v, omega)).twist();
            let wheel_error = (back.v - v).abs() + 0.115 * (back.omega - omega).abs();
            prop_assert!(wheel_error < 0.012, "{back:?}");
        }
    }
}
