//! A window against a dense batch solution: independent residuals, numeric derivatives, dense matrices.

use super::super::error_process::ErrorStart;
use super::super::fixed_lag::Smoother;
use super::super::state::{BORDER_SIZE, BorderState, CHAIN_SIZE, ChainState};
use super::fixture::driven;
use nalgebra::{DMatrix, DVector, Matrix3, SVector, Vector3};
use trundle_core::{Pose2, wrap_angle};

/// Values of all unknowns.
#[derive(Clone)]
struct Values {
    chain: Vec<ChainState>,
    border: BorderState,
}

impl Values {
    fn moved(&self, step: &DVector<f64>) -> Self {
        let part = |k: usize| SVector::<f64, CHAIN_SIZE>::from(step.fixed_rows::<CHAIN_SIZE>(k * CHAIN_SIZE));
        let chain = self.chain.iter().enumerate().map(|(k, state)| state.moved(&part(k))).collect();
        let border =
            SVector::<f64, BORDER_SIZE>::from(step.fixed_rows::<BORDER_SIZE>(self.chain.len() * CHAIN_SIZE));
        Self { chain, border: self.border.moved(&border) }
    }
}

/// Divides a residual by its standard deviations.
fn whitened(residual: Vector3<f64>, covariance: &Matrix3<f64>) -> Vec<f64> {
    let lower = covariance.cholesky().unwrap().l();
    lower.solve_lower_triangular(&residual).unwrap().iter().copied().collect()
}

/// All residuals in units of their standard deviations.
fn residuals(smoother: &Smoother, values: &Values) -> DVector<f64> {
    let mut all = prior(smoother, values);
    let keyframes = &smoother.window.as_ref().unwrap().keyframes;
    for (k, keyframe) in keyframes.iter().enumerate() {
        if let Some(visual) = keyframe.visual {
            let state = &values.chain[k];
            let exposed = state.pose * Pose2::exp(visual.velocity * -values.border.delay);
            let expected = values.border.anchors[visual.slot].inverse() * exposed;
            let off = visual.pose.position() - expected.position() - state.error.xy();
            let turn = wrap_angle(visual.pose.theta - expected.theta - state.error.z);
            all.extend(whitened(Vector3::new(off.x, off.y, turn), &visual.noise));
        }
        if let Some(scan) = keyframe.scan {
            all.extend(whitened((values.chain[k].pose.inverse() * scan.pose).log(), &scan.noise));
        }
        if k > 0 {
            all.extend(link(smoother, values, k));
        }
    }
    DVector::from_vec(all)
}

fn prior(smoother: &Smoother, values: &Values) -> Vec<f64> {
    let (odometry, first, border) = (smoother.motions.config(), &values.chain[0], &values.border);
    let mut all: Vec<f64> = first.pose.log().iter().chain(first.error.iter()).map(|x| x / 1e-5).collect();
    all.push(first.bias / odometry.gyro_bias_sigma);
    all.push((border.scale - 1.0) / odometry.gyro_scale_sigma);
    all.push((border.wheels.x - 1.0) / odometry.wheel_radius_sigma);
    all.push((border.wheels.y - 1.0) / odometry.wheel_radius_sigma);
    all.push((border.wheels.z - 1.0) / smoother.config.noise.wheelbase_sigma);
    all.push(border.delay / smoother.config.noise.delay_sigma);
    all.extend(border.anchors.iter().flat_map(|anchor| anchor.log().data.0[0]).map(|x| x / 1e3));
    all
}

/// Residuals between keyframes k - 1 and k: motion, comparison of wheels and gyro, bias, gyro at rest, error of the visual poses.
fn link(smoother: &Smoother, values: &Values, k: usize) -> Vec<f64> {
    let window = smoother.window.as_ref().unwrap();
    let (keyframe, odometry) = (&window.keyframes[k], smoother.motions.config());
    let (from, to, border) = (&values.chain[k - 1], &values.chain[k], &values.border);
    let at = [from.bias, border.scale, border.wheels.x, border.wheels.y, border.wheels.z].into();
    // Integrated at the values themselves, without derivatives by the calibration.
    let motion = smoother.motions.between(window.keyframes[k - 1].stamp, keyframe.stamp, at);
    let off = (motion.motion.inverse() * from.pose.inverse() * to.pose).log();
    let mut all = whitened(off, &keyframe.motion.noise());
    let compared = wrap_angle(motion.wheels.turn - (to.pose.theta - from.pose.theta));
    all.push(compared / keyframe.motion.wheels.comparison_variance().unwrap().sqrt());
    all.push((to.bias - from.bias) / (odometry.gyro_bias_walk.powi(2) * motion.duration + 1e-12).sqrt());
    if motion.rest.readings > 0.0 {
        let sigma = odometry.gyro_rate_noise / motion.rest.readings.sqrt();
        all.push((motion.rest.turn / motion.rest.time - from.bias) / sigma);
    }
    let step = &keyframe.error;
    let (distance, turn) = step.correlation;
    let keep = match step.start {
        Some(_) => 0.0,
        None => {
            let correlated = (-keyframe.motion.distance / distance - keyframe.motion.turned / turn).exp();
            1.0 - window.keyframes[k - 1].trust * (1.0 - correlated)
        }
    };
    let correlated = (-keyframe.motion.distance / distance - keyframe.motion.turned / turn).exp();
    // A rotated part of the map shifts a displaced pose.
    let shift = step.displacement - Pose2::new(0.0, 0.0, -from.error.z).rotate(step.displacement);
    let expected = (from.error + Vector3::new(shift.x, shift.y, 0.0)) * keep;
    let noise = match step.start {
        Some(ErrorStart::NewMap) => Matrix3::from_diagonal_element(1e-8),
        Some(ErrorStart::Place(_)) => step.covariance(&keyframe.motion),
        None => step.stationary * (1.0 - correlated * correlated).max(1e-4),
    };
    all.extend(whitened(to.error - expected, &noise));
    all
}

fn derivatives(smoother: &Smoother, values: &Values) -> DMatrix<f64> {
    let size = values.chain.len() * CHAIN_SIZE + BORDER_SIZE;
    let rows = residuals(smoother, values).len();
    let mut jacobian = DMatrix::zeros(rows, size);
    for column in 0..size {
        let mut step = DVector::zeros(size);
        step[column] = 1e-6;
        let slope = residuals(smoother, &values.moved(&step)) - residuals(smoother, &values.moved(&-step));
        jacobian.set_column(column, &(slope / 2e-6));
    }
    jacobian
}

#[test]
fn a_window_agrees_with_the_dense_solution_of_all_factors() {
    let mut smoother = driven(160);
    assert!(smoother.places().count() == 1, "a recognised place is among the factors");
    for _ in 0..5 {
        smoother.solve();
    }
    let window = smoother.window.as_ref().unwrap();
    assert!(window.keyframes.len() > 12 && window.keyframes.iter().any(|k| k.scan.is_some()));
    let start = Values { chain: window.keyframes.iter().map(|k| k.state).collect(), border: window.border };
    let mut values = start.clone();
    let mut inverse = DMatrix::zeros(0, 0);
    for _ in 0..6 {
        let (jacobian, residual) = (derivatives(&smoother, &values), residuals(&smoother, &values));
        let scaled = jacobian.transpose() * &jacobian;
        inverse = scaled.clone().cholesky().unwrap().inverse();
        values = values.moved(&-(&inverse * jacobian.transpose() * residual));
    }
    for (k, (found, expected)) in start.chain.iter().zip(&values.chain).enumerate() {
        let off = found.since(expected);
        let covariance = smoother.window.as_ref().unwrap().estimated(k).covariance;
        for i in 0..CHAIN_SIZE {
            let sigma = inverse[(k * CHAIN_SIZE + i, k * CHAIN_SIZE + i)].sqrt();
            assert!(off[i].abs() < 0.01 * sigma, "keyframe {k}, unknown {i}: {} of {sigma}", off[i]);
            let ratio = covariance[(i, i)].sqrt() / sigma;
            assert!((ratio - 1.0).abs() < 0.01, "keyframe {k}, unknown {i}: sigma {ratio}");
        }
    }
}
