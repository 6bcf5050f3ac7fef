//! Poses in space, SE(3): composition, inverse, exponential, logarithm, and conversion from and to SE(2).

use crate::{Pose2, Vector3};
use nalgebra::{Isometry3, Matrix3, Matrix6, Rotation3, Translation3, UnitQuaternion, Vector6};
use serde::{Deserialize, Serialize};
use std::ops::Mul;

/// A pose in space, an element of SE(3): `a_from_b` maps points of frame b into frame a.
///
/// Perturbations are on the right, translation first: `pose * Pose3::exp([rho, phi])`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "[f64; 7]", into = "[f64; 7]")]
pub struct Pose3 {
    /// Rotation as a unit quaternion.
    pub rotation: UnitQuaternion<f64>,
    /// Translation, metres.
    pub translation: Vector3,
}

impl Default for Pose3 {
    fn default() -> Self {
        Self::identity()
    }
}

impl Pose3 {
    /// The identity pose.
    pub fn identity() -> Self {
        Self { rotation: UnitQuaternion::identity(), translation: Vector3::zeros() }
    }

    /// A pose from a rotation and a translation in metres.
    pub fn new(rotation: UnitQuaternion<f64>, translation: Vector3) -> Self {
        Self { rotation, translation }
    }

    /// From a rotation matrix (orthonormal, determinant 1) and a translation in metres.
    pub fn from_matrix(rotation: Matrix3<f64>, translation: Vector3) -> Self {
        let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
        Self { rotation, translation }
    }

    /// A planar pose lifted into space: z = 0, rotation around z.
    pub fn from_pose2(pose: Pose2) -> Self {
        Self::new(
            UnitQuaternion::from_axis_angle(&Vector3::z_axis(), pose.theta),
            Vector3::new(pose.x, pose.y, 0.0),
        )
    }

    /// The planar part: x, y and yaw (the heading of the rotated x axis in the xy plane).
    pub fn to_pose2(&self) -> Pose2 {
        let x_axis = self.rotation * Vector3::x();
        Pose2::new(self.translation.x, self.translation.y, x_axis.y.atan2(x_axis.x))
    }

    /// `b_from_a` of an `a_from_b`.
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.inverse();
        Self { rotation, translation: -(rotation * self.translation) }
    }

    /// A point of frame b, in frame a.
    pub fn transform(&self, point: Vector3) -> Vector3 {
        self.rotation * point + self.translation
    }

    /// A direction of frame b, in frame a.
    pub fn rotate(&self, vector: Vector3) -> Vector3 {
        self.rotation * vector
    }

    /// The rotation as a matrix.
    pub fn rotation_matrix(&self) -> Matrix3<f64> {
        self.rotation.to_rotation_matrix().into_inner()
    }

    /// The exponential map of SE(3) of (rho, phi): metres, then rad.
    pub fn exp(tangent: Vector6<f64>) -> Self {
        let rho = Vector3::new(tangent[0], tangent[1], tangent[2]);
        let phi = Vector3::new(tangent[3], tangent[4], tangent[5]);
        Self { rotation: UnitQuaternion::from_scaled_axis(phi), translation: left_jacobian(phi) * rho }
    }

    /// The inverse of [`Pose3::exp`]: (rho, phi), metres, then rad.
    pub fn log(&self) -> Vector6<f64> {
        let phi = self.rotation.scaled_axis();
        let rho = left_jacobian(phi).try_inverse().unwrap_or_else(Matrix3::identity) * self.translation;
        Vector6::new(rho.x, rho.y, rho.z, phi.x, phi.y, phi.z)
    }

    /// The adjoint of SE(3), translation first (Sola et al. 2018, eq. 175): how a right perturbation before the pose appears
    /// behind it, `pose exp(x) = exp(adjoint x) pose`.
    pub fn adjoint(&self) -> Matrix6<f64> {
        let rotation = self.rotation_matrix();
        let mut matrix = Matrix6::zeros();
        matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&rotation);
        matrix.fixed_view_mut::<3, 3>(0, 3).copy_from(&(self.translation.cross_matrix() * rotation));
        matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&rotation);
        matrix
    }

    /// The angle of the rotation, rad, in [0, pi].
    pub fn angle(&self) -> f64 {
        self.rotation.angle()
    }

    /// The same pose with its quaternion normalised: after long chains of products.
    pub fn renormalized(&self) -> Self {
        Self {
            rotation: UnitQuaternion::new_normalize(self.rotation.into_inner()),
            translation: self.translation,
        }
    }

    /// Between two poses: `fraction` 0 gives `self`, 1 gives `other`; straight in position, shorter way in rotation.
    pub fn interpolate(&self, other: &Self, fraction: f64) -> Self {
        let turn = (self.rotation.inverse() * other.rotation).scaled_axis() * fraction;
        Self {
            rotation: self.rotation * UnitQuaternion::from_scaled_axis(turn),
            translation: self.translation + (other.translation - self.translation) * fraction,
        }
    }

    /// Whether every component is finite.
    pub fn is_finite(&self) -> bool {
        self.translation.iter().all(|v| v.is_finite()) && self.rotation.coords.iter().all(|v| v.is_finite())
    }
}

/// The left Jacobian of SO(3) (Sola et al. 2018, eq. 145), by its series near zero.
fn left_jacobian(phi: Vector3) -> Matrix3<f64> {
    let theta = phi.norm();
    let hat = phi.cross_matrix();
    let (a, b) = if theta < 1e-5 {
        (0.5 - theta * theta / 24.0, 1.0 / 6.0 - theta * theta / 120.0)
    } else {
        ((1.0 - theta.cos()) / (theta * theta), (theta - theta.sin()) / (theta * theta * theta))
    };
    Matrix3::identity() + hat * a + hat * hat * b
}

/// Composition: `a_from_b * b_from_c = a_from_c`.
impl Mul for Pose3 {
    type Output = Self;

    fn mul(self, rhs: Self) -> Self {
        Self { rotation: self.rotation * rhs.rotation, translation: self.transform(rhs.translation) }
    }
}

/// (tx, ty, tz, qx, qy, qz, qw), the order of the TUM format. The quaternion is normalised.
impl From<[f64; 7]> for Pose3 {
    fn from(v: [f64; 7]) -> Self {
        let q = nalgebra::Quaternion::new(v[6], v[3], v[4], v[5]);
        Self::new(UnitQuaternion::new_normalize(q), Vector3::new(v[0], v[1], v[2]))
    }
}

impl From<Pose3> for [f64; 7] {
    fn from(p: Pose3) -> Self {
        let (t, q) = (p.translation, p.rotation);
        [t.x, t.y, t.z, q.i, q.j, q.k, q.w]
    }
}

impl From<Pose3> for Isometry3<f64> {
    fn from(p: Pose3) -> Self {
        Self::from_parts(Translation3::from(p.translation), p.rotation)
    }
}

impl From<Isometry3<f64>> for Pose3 {
    fn from(iso: Isometry3<f64>) -> Self {
        Self::new(iso.rotation, iso.translation.vector)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn any_tangent() -> impl Strategy<Value = Vector6<f64>> {
        prop::array::uniform6(-1.7..1.7).prop_map(Vector6::from)
    }

    fn gap(a: Pose3, b: Pose3) -> f64 {
        (a.inverse() * b).log().norm()
    }

    proptest! {
        #[test]
        fn group_laws(a in any_tangent(), b in any_tangent(), c in any_tangent()) {
            let (a, b, c) = (Pose3::exp(a), Pose3::exp(b), Pose3::exp(c));
            prop_assert!(gap((a * b) * c, a * (b * c)) < 1e-12);
            prop_assert!(gap(a * a.inverse(), Pose3::identity()) < 1e-12);
        }

        #[test]
        fn log_undoes_exp(a in any_tangent()) {
            prop_assert!((Pose3::exp(a).log() - a).norm() < 1e-9);
        }

        #[test]
        fn plane_and_back(x in -9.0..9.0, y in -9.0..9.0, t in -3.1..3.1) {
            let pose = Pose2::new(x, y, t);
            let back = Pose3::from_pose2(pose).to_pose2();
            prop_assert!(back.distance(&pose) < 1e-12 && (back.theta - t).abs() < 1e-12);
        }
    }
}
