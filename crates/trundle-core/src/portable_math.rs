//! Functions whose results have equal bits on every processor.
//!
//! The C library's `hypot` and its `atan2`, `tanh` and `hypot` of f32 round differently on x86-64 and aarch64. The compiler's square root
//! is correctly rounded everywhere. Functions of f64, rounded to f32, have no such difference in practice: their last bits are lost.

/// The length of the hypotenuse, with equal bits on every processor.
pub trait Hypotenuse {
    /// `sqrt(self^2 + other^2)`. Unlike `hypot` it overflows above 1e154, and is 0 below 1e-162; f32 does neither.
    #[must_use]
    fn hypotenuse(self, other: Self) -> Self;
}

impl Hypotenuse for f64 {
    #[inline]
    fn hypotenuse(self, other: Self) -> Self {
        (self * self + other * other).sqrt()
    }
}

impl Hypotenuse for f32 {
    #[inline]
    fn hypotenuse(self, other: Self) -> Self {
        f64::from(self).hypotenuse(f64::from(other)) as Self
    }
}

/// The angle of the vector `(x, y)` \[rad\], in (-pi, pi\].
#[must_use]
pub fn angle_of_f32(x: f32, y: f32) -> f32 {
    f64::from(y).atan2(f64::from(x)) as f32
}

/// The hyperbolic tangent.
#[must_use]
pub fn tanh_f32(x: f32) -> f32 {
    f64::from(x).tanh() as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn known_values() {
        assert_eq!((3.0_f64.hypotenuse(-4.0), 3.0_f32.hypotenuse(-4.0)), (5.0, 5.0));
        assert_eq!(1e30_f32.hypotenuse(1e30), std::f32::consts::SQRT_2 * 1e30);
        assert_eq!(angle_of_f32(-1.0, 0.0), std::f32::consts::PI);
        assert_eq!(angle_of_f32(0.0, -2.0), -std::f32::consts::FRAC_PI_2);
        assert!((tanh_f32(0.5) - 0.462_117_16).abs() < 1e-7);
    }

    proptest! {
        #[test]
        #[expect(clippy::disallowed_methods, reason = "the compared functions")]
        fn they_agree_with_the_functions_that_they_replace(x in -1e6..1e6f64, y in -1e6..1e6f64) {
            let near = |a: f64, b: f64, ulp: f64| (a - b).abs() <= ulp * b.abs();
            prop_assert!(near(x.hypotenuse(y), x.hypot(y), 4.0 * f64::EPSILON));
            let (x, y) = (x as f32, y as f32);
            let ulp = 2.0 * f64::from(f32::EPSILON);
            prop_assert!(near(x.hypotenuse(y).into(), x.hypot(y).into(), ulp));
            prop_assert!(near(angle_of_f32(x, y).into(), y.atan2(x).into(), ulp));
            prop_assert!(near(tanh_f32(x / 1e6).into(), (x / 1e6).tanh().into(), ulp));
        }
    }
}
