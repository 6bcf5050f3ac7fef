//! Consistency of the filter: normalised estimation error squared (Bar-Shalom, Li, Kirubarajan 2001, ch. 5.4).

use nalgebra::{Matrix3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trundle_core::{Odometry, Pose2, Pose3, Stamp, Twist2};
use trundle_estimation::{Localizer, LocalizerConfig, PoseUncertainty, ScanPose};

/// Sigmas of a step of odometry and of a measurement.
const STEP: [f64; 3] = [0.003, 0.001, 0.002];
const MEASURED: [f64; 3] = [0.02, 0.02, 0.0105];

fn normal(rng: &mut ChaCha8Rng, sigmas: [f64; 3]) -> Vector3<f64> {
    let mut one = || {
        let (u, v): (f64, f64) = (rng.random_range(1e-12..1.0), rng.random());
        (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
    };
    Vector3::new(one() * sigmas[0], one() * sigmas[1], one() * sigmas[2])
}

fn squares(sigmas: [f64; 3]) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::from(sigmas).map(|s| s * s))
}

fn adjoint(pose: &Pose2) -> Matrix3<f64> {
    let (s, c) = pose.theta.sin_cos();
    Matrix3::new(c, -s, pose.y, s, c, -pose.x, 0.0, 0.0, 1.0)
}

/// Mean of the normalised squared error over runs of 20 s. Errors of the measurements are correlated: each is `correlation` times
/// the previous one plus new noise, and all have the sigmas above.
fn mean_squared_error(config: &LocalizerConfig, correlation: f64, runs: u64) -> f64 {
    let mut sum = 0.0;
    let mut count = 0.0;
    for seed in 0..runs {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut localizer = Localizer::new(config.clone(), Pose3::identity()).unwrap();
        let (mut truth, mut pose, mut covariance) = (Pose2::IDENTITY, Pose2::IDENTITY, Matrix3::zeros());
        let mut error = normal(&mut rng, MEASURED);
        for step in 0..1000_i64 {
            let twist = Twist2::new(0.5, (step as f64 * 0.01).sin());
            let stamp = Stamp::from_nanos(step * 20_000_000);
            if step > 0 {
                let motion = Pose2::IDENTITY.advance(twist, 0.02);
                truth = truth * motion;
                let measured = motion * Pose2::exp(normal(&mut rng, STEP));
                pose = pose * measured;
                let back = adjoint(&measured.inverse());
                covariance = back * covariance * back.transpose() + squares(STEP);
            }
            localizer.predict(&Odometry { stamp, pose, twist, covariance });
            if step % 3 == 0 {
                error = error * correlation
                    + normal(&mut rng, MEASURED) * (1.0 - correlation * correlation).sqrt();
                localizer.correct_scan(&ScanPose {
                    stamp,
                    map_from_base: truth * Pose2::exp(error),
                    covariance: Matrix3::zeros(),
                    map: PoseUncertainty::default(),
                });
            }
            if step > 100 && step % 20 == 0 {
                let estimate = localizer.estimate();
                let off = (estimate.pose.inverse() * truth).log();
                sum += off.dot(&(estimate.covariance.try_inverse().unwrap() * off));
                count += 1.0;
            }
        }
    }
    sum / count
}

#[test]
fn white_errors_match_the_covariance() {
    let mut config = LocalizerConfig::default();
    config.scan_position_sigma = MEASURED[0];
    config.scan_heading_sigma_deg = MEASURED[2].to_degrees();
    config.min_position_sigma = 0.0;
    config.min_heading_sigma_deg = 0.0;
    config.gate = 10.0;
    let error = mean_squared_error(&config, 0.0, 20);
    assert!(error > 2.6 && error < 3.4, "3 degrees of freedom: {error}");
}

#[test]
fn correlated_errors_do_not_make_the_filter_overconfident() {
    let usual = LocalizerConfig::default();
    // Errors are correlated over 0.6 s: ten measurements.
    let error = mean_squared_error(&usual, 0.9, 20);
    assert!(error < 6.0, "{error}");
    let mut trusting = usual;
    trusting.min_position_sigma = 0.0;
    trusting.min_heading_sigma_deg = 0.0;
    assert!(mean_squared_error(&trusting, 0.9, 20) > 1.5 * error, "without the sigma floor");
}
