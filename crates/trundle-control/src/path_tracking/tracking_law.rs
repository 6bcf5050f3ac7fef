//! The tracking law, without limits.

use crate::path_tracking::tracking_error::TrackingError;
use trundle_core::Twist2;

/// A6's gains at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Gains {
    /// Gain of the error along the path, 1/s.
    pub(super) k1: f64,
    /// Gain of the heading error, 1/s.
    pub(super) k2: f64,
    /// Gain of the lateral error, 1/m^2.
    pub(super) k_cross: f64,
}

/// The twist of A6, without limits.
///
/// V = 1/2 (e_x^2 + e_y^2 + e_theta^2 / k_cross) falls by k1 e_x^2 + k2 / k_cross e_theta^2.
pub(super) fn tracking_law(error: TrackingError, reference: Twist2, gains: Gains) -> Twist2 {
    let TrackingError { along, cross, heading } = error;
    Twist2 {
        v: reference.v * heading.cos() + gains.k1 * along,
        omega: reference.omega + gains.k_cross * cross * reference.v * sin_over(heading) + gains.k2 * heading,
    }
}

/// sin(x) / x, by its series near zero.
fn sin_over(x: f64) -> f64 {
    if x.abs() < 1e-4 { 1.0 - x * x / 6.0 } else { x.sin() / x }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// dV/dt by the error's dynamics: e_x' = omega e_y - v + v_d cos e_theta, e_y' = -omega e_x + v_d sin e_theta,
    /// e_theta' = omega_d - omega.
    fn slope(e: TrackingError, d: Twist2, gains: Gains) -> f64 {
        let u = tracking_law(e, d, gains);
        e.along * (u.omega * e.cross - u.v + d.v * e.heading.cos())
            + e.cross * (-u.omega * e.along + d.v * e.heading.sin())
            + e.heading / gains.k_cross * (d.omega - u.omega)
    }

    proptest! {
        #[test]
        fn the_lyapunov_function_falls_at_the_proven_rate(
            (along, cross, heading) in (-2.0..2.0, -2.0..2.0, -3.1..3.1),
            (v, omega) in (-0.7..0.7, -3.0..3.0),
            (k1, k2, k_cross) in (0.1..9.0, 0.1..9.0, 0.1..20.0),
        ) {
            let error = TrackingError { along, cross, heading };
            let fall = slope(error, Twist2::new(v, omega), Gains { k1, k2, k_cross });
            let proven = -k1 * along * along - k2 / k_cross * heading * heading;
            prop_assert!((fall - proven).abs() < 1e-9 * (1.0 + proven.abs()), "{fall} is not {proven}");
        }

        #[test]
        fn series_and_quotient_agree(x in 1e-5..1e-3) {
            let x: f64 = x;
            prop_assert!((sin_over(x) - x.sin() / x).abs() < 1e-15);
        }
    }

    #[test]
    fn without_error_the_twist_is_the_reference() {
        let gains = Gains { k1: 1.0, k2: 1.0, k_cross: 1.0 };
        let reference = Twist2::new(0.3, -0.4);
        assert_eq!(tracking_law(TrackingError::default(), reference, gains), reference);
        assert_eq!(sin_over(0.0), 1.0);
    }
}
