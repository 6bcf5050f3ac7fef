//! The rigid motion between two sets of points.

use nalgebra::{Matrix3, SVD};
use trundle_core::{Pose3, Vector3};

/// `b_from_a` with the least-squares fit of the first points of the pairs to the second points \[Umeyama91\], without scale. `None` for
/// fewer than three pairs, or for collinear points on either side.
pub(crate) fn rigid_motion(pairs: &[(Vector3, Vector3)]) -> Option<Pose3> {
    let count = pairs.len() as f64;
    (pairs.len() >= 3).then_some(())?;
    let (sum_a, sum_b) =
        pairs.iter().fold((Vector3::zeros(), Vector3::zeros()), |(a, b), pair| (a + pair.0, b + pair.1));
    let (mean_a, mean_b) = (sum_a / count, sum_b / count);
    let covariance: Matrix3<f64> = pairs.iter().map(|(a, b)| (b - mean_b) * (a - mean_a).transpose()).sum();
    let SVD { u: Some(u), v_t: Some(v_t), singular_values } =
        covariance.try_svd(true, true, f64::EPSILON, 100)?
    else {
        return None;
    };
    // With two observed directions the third follows.
    (singular_values[1] > 1e-9 * singular_values[0]).then_some(())?;
    let mut mirror = Matrix3::identity();
    mirror[(2, 2)] = (u * v_t).determinant().signum();
    let rotation = u * mirror * v_t;
    Some(Pose3::from_matrix(rotation, mean_b - rotation * mean_a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector6;
    use proptest::prelude::*;

    fn any_point() -> impl Strategy<Value = Vector3> {
        prop::array::uniform3(-3.0..3.0).prop_map(Vector3::from)
    }

    proptest! {
        #[test]
        fn a_motion_is_recovered(
            points in prop::collection::vec(any_point(), 3..8),
            tangent in prop::array::uniform6(-1.7..1.7).prop_map(Vector6::from),
        ) {
            let area = (points[1] - points[0]).cross(&(points[2] - points[0])).norm();
            prop_assume!(area > 0.1);
            let motion = Pose3::exp(tangent);
            let pairs: Vec<_> = points.iter().map(|p| (*p, motion.transform(*p))).collect();
            let found = rigid_motion(&pairs).unwrap();
            prop_assert!((found.inverse() * motion).log().norm() < 1e-7);
        }
    }

    #[test]
    fn too_few_points_give_no_motion() {
        let line: Vec<_> = (0..5).map(|i| Vector3::new(i as f64, 2.0, 1.0)).map(|p| (p, p)).collect();
        assert_eq!(rigid_motion(&line), None);
        assert_eq!(rigid_motion(&[(Vector3::x(), Vector3::x()), (Vector3::y(), Vector3::y())]), None);
        assert_eq!(rigid_motion(&[(Vector3::x(), Vector3::y()); 4]), None);
    }

    #[test]
    fn a_mirror_image_still_gives_a_rotation() {
        let points = [Vector3::zeros(), Vector3::x(), Vector3::y() * 2.0, Vector3::z() * 3.0];
        let pairs = points.map(|p| (p, Vector3::new(-p.x, p.y, p.z)));
        let found = rigid_motion(&pairs).unwrap();
        assert!((found.rotation_matrix().determinant() - 1.0).abs() < 1e-12);
    }
}
