//! Odometry errors: covariance of a step, learnt scale and bias.

use crate::particle_config::MotionConfig;
use crate::rbpf::motion_model::{motion_covariance, unknown_motion_covariance};
use crate::rbpf::odometry_bias::OdometryBias;
use crate::rbpf::odometry_noise::{Innovation, OdometryNoise};
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use trundle_core::Pose2;

fn any_motion() -> impl Strategy<Value = Pose2> {
    (-2.0..2.0_f64, -0.5..0.5_f64, -1.5..1.5_f64).prop_map(|(x, y, theta)| Pose2::new(x, y, theta))
}

fn any_innovation() -> impl Strategy<Value = Innovation> {
    let off = prop::array::uniform3(-30.0..30.0_f64);
    let open = prop::array::uniform3(1e-6..50.0_f64);
    (off, open).prop_map(|(off, open)| Innovation { off: off.into(), open: open.into() })
}

proptest! {
    #[test]
    fn a_longer_motion_in_any_direction_is_less_certain(motion in any_motion(), factor in 1.0..3.0_f64) {
        let config = MotionConfig::default();
        let covariance = |m: Pose2| motion_covariance(&config, m).diagonal();
        let longer = Pose2 { x: motion.x * factor, y: motion.y * factor, theta: motion.theta * factor };
        prop_assert!((covariance(longer) - covariance(motion)).min() >= 0.0);
        let back = Pose2 { x: -motion.x, y: -motion.y, theta: -motion.theta };
        prop_assert_eq!(covariance(back), covariance(motion));
        prop_assert!(covariance(motion).min() > 0.0 && unknown_motion_covariance().diagonal().min() > 0.0);
    }

    /// For any matches, the learnt errors are between the minimum and the configured ones.
    #[test]
    fn learnt_errors_stay_within_the_configured_ones(
        innovations in prop::collection::vec(any_innovation(), 0..80), doubt_count in 0..5_usize,
    ) {
        let configured = Matrix3::from_diagonal(&Vector3::new(2.0, 1.0, 0.01));
        let mut noise = OdometryNoise::default();
        innovations.iter().for_each(|innovation| noise.learn(innovation, &configured));
        (0..doubt_count).for_each(|_| noise.doubt());
        let scaled = noise.scaled(&configured);
        for k in 0..3 {
            let ratio = scaled[(k, k)] / configured[(k, k)];
            prop_assert!((0.15_f64.powi(2) - 1e-12..=1.0 + 1e-12).contains(&ratio), "{ratio}");
        }
        prop_assert_eq!(OdometryNoise::from_numbers(noise.numbers()), noise);
    }

    /// The prior bounds the bias for any sequence of matches.
    #[test]
    fn a_learnt_bias_is_a_small_part_of_the_motion(
        steps in prop::collection::vec((any_motion(), any_innovation()), 1..60), motion in any_motion(),
    ) {
        let mut bias = OdometryBias::default();
        for (step, innovation) in &steps {
            bias.learn(*step, innovation, Vector3::new(0.5, 0.5, 0.02), 0.05);
        }
        let corrected = bias.corrected(motion);
        prop_assert!(corrected.is_finite());
        prop_assert_eq!(OdometryBias::from_numbers(bias.numbers()), bias);
        let still = bias.corrected(Pose2::IDENTITY);
        prop_assert!(still.position().norm() == 0.0 && still.theta == 0.0, "a robot at rest has no bias");
    }
}

#[test]
fn matches_that_agree_with_the_odometry_leave_it_unchanged() {
    let mut bias = OdometryBias::default();
    let agrees = Innovation { off: Vector3::zeros(), open: Vector3::repeat(0.01) };
    for k in 0..100 {
        bias.learn(Pose2::new(0.3, 0.0, 0.01 * f64::from(k % 7)), &agrees, Vector3::repeat(0.1), 0.05);
    }
    let motion = Pose2::new(0.4, 0.1, -0.3);
    assert!(bias.corrected(motion).distance(&motion) < 1e-12);
    assert!((bias.corrected(motion).theta - motion.theta).abs() < 1e-12);
}

#[test]
fn stored_numbers_that_cannot_be_are_replaced_by_the_prior() {
    assert_eq!(OdometryNoise::from_numbers([1.0, 0.0, 4.0, 1.0, 1.0, 4.0]), OdometryNoise::default());
    assert_eq!(OdometryNoise::from_numbers([f64::NAN; 6]), OdometryNoise::default());
    assert_eq!(OdometryBias::from_numbers([-1.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0]), OdometryBias::default());
}
