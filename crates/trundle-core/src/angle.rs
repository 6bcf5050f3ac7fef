//! Angles in rad: wrapping into (-pi, pi] and the signed difference of two angles.

use std::f64::consts::{PI, TAU};

/// The same angle in (-pi, pi], rad. NaN remains NaN.
pub fn wrap_angle(angle: f64) -> f64 {
    if angle > -PI && angle <= PI {
        return angle;
    }
    let turned = angle.rem_euclid(TAU);
    if turned > PI { turned - TAU } else { turned }
}

/// The shorter turn that leads from `from` to `to`, in (-pi, pi], rad.
pub fn difference_of_angles(to: f64, from: f64) -> f64 {
    wrap_angle(to - from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wraps_into_the_half_open_circle() {
        assert_eq!(wrap_angle(PI), PI);
        assert_eq!(wrap_angle(-PI), PI);
        assert!((wrap_angle(7.0) - (7.0 - TAU)).abs() < 1e-15);
        assert!((difference_of_angles(-3.0, 3.0) - (TAU - 6.0)).abs() < 1e-12);
    }
}
