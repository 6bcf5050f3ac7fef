//! Laws of the directions that a scan determines.

use super::room;
use crate::scan_match::held_directions::HeldDirections;
use crate::scan_match::likelihood::ScanEquations;
use crate::units::in_cells;
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use trundle_core::Pose2;

/// Equations of hits whose information is `information`: cells, rad.
fn equations(information: Matrix3<f64>, weight: f64) -> ScanEquations {
    let mut equations = ScanEquations { weight, ..ScanEquations::default() };
    equations.normal.information = information;
    equations.normal.rhs = Vector3::new(1.0, -2.0, 3.0);
    equations
}

fn any_information() -> impl Strategy<Value = Matrix3<f64>> {
    prop::array::uniform9(-3.0..3.0_f64).prop_map(|values| {
        let root = Matrix3::from_row_slice(&values);
        root * root.transpose()
    })
}

fn any_pose() -> impl Strategy<Value = Pose2> {
    (-0.8..0.8_f64, 0.0..1.2_f64, -3.1..3.1_f64).prop_map(|(x, y, theta)| Pose2::new(x, y, theta))
}

fn is_projection(held: &Matrix3<f64>) -> bool {
    (held * held - held).amax() < 1e-9 && (held - held.transpose()).amax() < 1e-9
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// The held directions and the degenerate ones are together all three.
    #[test]
    fn the_held_part_is_a_projection(pose in any_pose(), information in any_information(), min in 0.0..0.9_f64) {
        let models = room::models();
        let shape = room::points(&models, pose);
        let weight = information.trace();
        let held = HeldDirections::new(&shape, in_cells(&models.config, pose), &equations(information, weight), min);
        prop_assert!(is_projection(&held.held), "{}", held.held);
        prop_assert!((held.held.trace() - (3 - held.degenerate) as f64).abs() < 1e-9);
    }

    /// A higher threshold makes no direction held.
    #[test]
    fn a_higher_threshold_holds_fewer_directions(
        pose in any_pose(), information in any_information(), low in 0.0..0.5_f64, more in 0.0..0.5_f64,
    ) {
        let models = room::models();
        let shape = room::points(&models, pose);
        let count = |min: f64| {
            let equations = equations(information, information.trace());
            HeldDirections::new(&shape, in_cells(&models.config, pose), &equations, min).degenerate
        };
        prop_assert!(count(low) <= count(low + more));
    }

    /// Without a degenerate direction, information and gradient of the hits are those of the pose.
    #[test]
    fn a_full_scan_loses_no_information(pose in any_pose(), information in any_information()) {
        let models = room::models();
        let shape = room::points(&models, pose);
        let equations = equations(information + Matrix3::identity(), 1.0);
        let held = HeldDirections::new(&shape, in_cells(&models.config, pose), &equations, 0.0);
        prop_assert_eq!(held.degenerate, 0);
        let in_y = held.in_y(&equations.normal.information);
        prop_assert!((held.information(&equations) - in_y).amax() < 1e-6 * in_y.amax());
        // The cost of a step is the same in both coordinates.
        let step = Vector3::new(0.3, -0.2, 0.1);
        let (in_pose, in_step) = (held.pose_from_y * step, held.rhs(&equations).dot(&step));
        prop_assert!((equations.normal.rhs.dot(&in_pose) - in_step).abs() < 1e-6 * (1.0 + in_step.abs()));
    }
}

#[test]
fn no_hits_determine_no_direction() {
    let models = room::models();
    let shape = room::points(&models, Pose2::new(0.1, 0.3, 0.5));
    let held = HeldDirections::new(&shape, Pose2::IDENTITY, &ScanEquations::default(), 0.05);
    assert_eq!((held.degenerate, held.held), (3, Matrix3::zeros()));
}
