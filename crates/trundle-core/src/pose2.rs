//! Poses in the plane, SE(2): composition, inverse, exponential and logarithm.

use crate::{Twist2, Vector2, Vector3, wrap_angle};
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};
use std::ops::Mul;

/// Largest coordinate of a pose that a user gives \[m\]. A cell of a grid at a larger coordinate has no index. Source: ours.
pub const MAX_COORDINATE_M: f64 = 1e6;

/// A pose in the plane, an element of SE(2): `a_from_b` maps points of frame b into frame a.
///
/// Names cancel: `map_from_base * base_from_goal` is `map_from_goal`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Pose2 {
    /// Metres.
    pub x: f64,
    /// Metres.
    pub y: f64,
    /// Heading, rad, in (-pi, pi] when made by this type's methods.
    pub theta: f64,
}

impl Pose2 {
    /// The identity pose.
    pub const IDENTITY: Self = Self { x: 0.0, y: 0.0, theta: 0.0 };

    /// A pose from metres and radians; the heading is wrapped into (-pi, pi].
    pub fn new(x: f64, y: f64, theta: f64) -> Self {
        Self { x, y, theta: wrap_angle(theta) }
    }

    /// The position, metres.
    pub fn position(&self) -> Vector2 {
        Vector2::new(self.x, self.y)
    }

    /// The unit vector along the heading.
    pub fn direction(&self) -> Vector2 {
        Vector2::new(self.theta.cos(), self.theta.sin())
    }

    /// `b_from_a` of an `a_from_b`.
    pub fn inverse(&self) -> Self {
        let (s, c) = self.theta.sin_cos();
        Self::new(-c * self.x - s * self.y, s * self.x - c * self.y, -self.theta)
    }

    /// A point of frame b, in frame a.
    pub fn transform(&self, point: Vector2) -> Vector2 {
        self.rotate(point) + self.position()
    }

    /// A direction of frame b, in frame a.
    pub fn rotate(&self, vector: Vector2) -> Vector2 {
        let (s, c) = self.theta.sin_cos();
        Vector2::new(c * vector.x - s * vector.y, s * vector.x + c * vector.y)
    }

    /// The exponential map of SE(2): the pose of a body after one unit of time with constant (vx, vy, omega).
    pub fn exp(tangent: Vector3) -> Self {
        let (vx, vy, w) = (tangent.x, tangent.y, tangent.z);
        let (a, b) = sinc_pair(w);
        Self::new(a * vx - b * vy, b * vx + a * vy, w)
    }

    /// The inverse of [`Pose2::exp`]; the angle of the result is in (-pi, pi].
    pub fn log(&self) -> Vector3 {
        let (a, b) = sinc_pair(self.theta);
        let scale = 1.0 / (a * a + b * b);
        Vector3::new((a * self.x + b * self.y) * scale, (a * self.y - b * self.x) * scale, self.theta)
    }

    /// The adjoint of SE(2), tangents (x m, y m, theta rad): how a right perturbation before the pose appears behind it,
    /// `pose exp(x) = exp(adjoint x) pose` (Sola et al. 2018, eq. 159).
    pub fn adjoint(&self) -> Matrix3<f64> {
        let (s, c) = self.theta.sin_cos();
        Matrix3::new(c, -s, self.y, s, c, -self.x, 0.0, 0.0, 1.0)
    }

    /// The pose after `dt` seconds of a constant twist: the exact arc.
    pub fn advance(&self, twist: Twist2, dt: f64) -> Self {
        *self * Self::exp(Vector3::new(twist.v * dt, 0.0, twist.omega * dt))
    }

    /// The distance between two positions, metres.
    pub fn distance(&self, other: &Self) -> f64 {
        (self.position() - other.position()).norm()
    }

    /// Between two poses: `fraction` 0 gives `self`, 1 gives `other`; straight in position, shorter way in heading.
    pub fn interpolate(&self, other: &Self, fraction: f64) -> Self {
        Self::new(
            self.x + (other.x - self.x) * fraction,
            self.y + (other.y - self.y) * fraction,
            self.theta + wrap_angle(other.theta - self.theta) * fraction,
        )
    }

    /// Whether every component is finite.
    pub fn is_finite(&self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.theta.is_finite()
    }
}

/// (sin w / w, (1 - cos w) / w), by their series near zero.
fn sinc_pair(w: f64) -> (f64, f64) {
    if w.abs() < 1e-5 {
        (1.0 - w * w / 6.0, w / 2.0 - w * w * w / 24.0)
    } else {
        (w.sin() / w, (1.0 - w.cos()) / w)
    }
}

/// Composition: `a_from_b * b_from_c = a_from_c`.
#[expect(clippy::suspicious_arithmetic_impl, reason = "composing planar poses adds their angles")]
impl Mul for Pose2 {
    type Output = Self;

    fn mul(self, rhs: Self) -> Self {
        let p = self.transform(rhs.position());
        let theta = self.theta + rhs.theta;
        Self::new(p.x, p.y, theta)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn any_pose() -> impl Strategy<Value = Pose2> {
        (-50.0..50.0, -50.0..50.0, -3.0..3.0).prop_map(|(x, y, t)| Pose2::new(x, y, t))
    }

    fn close(a: Pose2, b: Pose2) -> bool {
        a.distance(&b) < 1e-9 && wrap_angle(a.theta - b.theta).abs() < 1e-12
    }

    proptest! {
        #[test]
        fn group_laws(a in any_pose(), b in any_pose(), c in any_pose()) {
            prop_assert!(close((a * b) * c, a * (b * c)));
            prop_assert!(close(a * a.inverse(), Pose2::IDENTITY));
            prop_assert!(close(Pose2::IDENTITY * a, a));
        }

        #[test]
        fn exp_undoes_log(a in any_pose()) {
            prop_assert!(close(Pose2::exp(a.log()), a));
        }

        #[test]
        fn the_adjoint_moves_a_perturbation_to_the_other_side(a in any_pose(), b in any_pose()) {
            let step = b.log() * 1e-3;
            prop_assert!(close(a * Pose2::exp(step), Pose2::exp(a.adjoint() * step) * a));
        }
    }

    #[test]
    fn a_quarter_circle_ends_where_geometry_says() {
        let end = Pose2::IDENTITY
            .advance(Twist2::new(std::f64::consts::FRAC_PI_2, std::f64::consts::FRAC_PI_2), 1.0);
        assert!(close(end, Pose2::new(1.0, 1.0, std::f64::consts::FRAC_PI_2)));
    }
}
