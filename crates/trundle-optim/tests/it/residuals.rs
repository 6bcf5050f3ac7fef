//! Laws of point observations and of the loss of Huber.

use crate::support::camera;
use proptest::prelude::*;
use trundle_core::{Vector2, Vector3};
use trundle_optim::{CHI2_95_2, CHI2_95_3, Huber, InverseDepth, PointObservation};

fn any_point() -> impl Strategy<Value = Vector3> {
    (-1.0..1.0_f64, -1.0..1.0_f64, 0.3..8.0_f64).prop_map(|(x, y, z)| Vector3::new(x, y, z))
}

/// Measurement of a point by a camera without noise.
fn exact(point: Vector3) -> PointObservation {
    let depth = Some(InverseDepth { value: 1.0 / point.z, sigma: 0.003 });
    PointObservation { pixel: camera().project(point).unwrap(), pixel_sigma: 1.0, depth }
}

proptest! {
    #[test]
    fn the_residual_of_an_exact_observation_is_zero(point in any_point()) {
        prop_assert!(exact(point).chi2(&camera(), point) < 1e-12);
    }

    #[test]
    fn the_residual_is_the_error_in_standard_deviations(
        point in any_point(), u in -5.0..5.0_f64, v in -5.0..5.0_f64, d in -5.0..5.0_f64, sigma in 0.5..3.0_f64,
    ) {
        let good = exact(point);
        let depth = good.depth.map(|depth| InverseDepth { value: depth.value - d * depth.sigma, ..depth });
        let off = PointObservation { pixel: good.pixel - Vector2::new(u, v) * sigma, pixel_sigma: sigma, depth };
        let residual = off.residual(&camera(), point).unwrap();
        prop_assert!((residual - Vector3::new(u, v, d)).norm() < 1e-9);
        prop_assert!((off.chi2(&camera(), point) - residual.norm_squared()).abs() < 1e-9);
        prop_assert_eq!(off.linearize(&camera(), point).unwrap().residual, residual);
    }

    #[test]
    fn without_a_depth_a_point_may_lie_anywhere_on_its_ray(point in any_point(), scale in 0.2..5.0_f64) {
        let blind = PointObservation { depth: None, ..exact(point) };
        prop_assert!(blind.chi2(&camera(), point * scale) < 1e-12);
        let linear = blind.linearize(&camera(), point).unwrap();
        prop_assert!((linear.by_point * point).norm() < 1e-9);
    }

    #[test]
    fn the_loss_is_never_above_the_square_and_never_falls(bound in 0.1..50.0_f64, a in 0.0..1e4_f64, more in 0.0..1e3_f64) {
        let huber = Huber::beyond(bound);
        prop_assert!(huber.cost(a) <= a + 1e-9 && huber.cost(a + more) >= huber.cost(a) - 1e-9);
        prop_assert!(huber.weight(a) > 0.0 && huber.weight(a) <= 1.0 && huber.weight(a + more) <= huber.weight(a));
        prop_assert_eq!(huber.weight(bound * 0.999), 1.0);
    }
}

#[test]
fn a_depth_adds_a_degree_of_freedom_to_the_bound() {
    let with = exact(Vector3::z());
    assert_eq!(
        (with.chi2_bound(), PointObservation { depth: None, ..with }.chi2_bound()),
        (CHI2_95_3, CHI2_95_2)
    );
}

#[test]
fn a_point_in_the_lens_or_behind_it_has_no_residual() {
    let seen = exact(Vector3::z());
    for z in [0.019, 0.0, -1.0] {
        let point = Vector3::new(0.0, 0.0, z);
        assert_eq!(
            (seen.residual(&camera(), point), seen.chi2(&camera(), point)),
            (None, f64::INFINITY),
            "{z}"
        );
    }
    assert!(seen.residual(&camera(), Vector3::new(0.0, 0.0, 0.021)).is_some());
}
