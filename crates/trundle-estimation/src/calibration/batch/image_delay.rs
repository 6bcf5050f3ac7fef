//! Delay of the image stamps against the gyro.
//!
//! Problem: the difference between the stamp of an image and its exposure. Idea: camera and gyro measure the same turns. The delay is the
//! time shift of the gyro at which both agree. A search over shifts finds the start; each shift is scored by the correlation of the turns.
//! Gauss-Newton refines delay, gyro scale and gyro bias together \[Furgale13\] (the same model, without splines). Cost: one pass over the
//! images for each of 200 shifts.
//!
//! | symbol | name here | unit |
//! |---|---|---|
//! | d | `delay` | s |
//! | s | `gyro_scale`: true over measured rate | |
//! | b | `gyro_bias` of the measured rate | rad/s |
//!
//! `turn(i, i+1) = s (angle(t[i+1] - d) - angle(t[i] - d)) - s b (t[i+1] - t[i])`

use super::error::CalibrationError;
use super::estimate::Estimate;
use super::gyro_angle::GyroAngle;
use super::linear_fit::{LinearFit, LinearSolution};
use super::turn_axis::{Turn, turns};
use nalgebra::{Vector2, Vector3};
use trundle_core::{Pose3, Stamp};

/// Delay of the image stamps, with the gyro's scale and bias.
#[derive(Debug, Clone, PartialEq)]
pub struct ImageDelay {
    /// Stamp of an image minus the time of its exposure, s; negative for a stamp that is too early.
    pub delay: Estimate,
    /// True over measured turn rate.
    pub gyro_scale: Estimate,
    /// Rate that the gyro measures at rest, rad/s.
    pub gyro_bias: Estimate,
    /// Correlation of the turns by camera and gyro at that delay, -1 to 1.
    pub correlation: f64,
    /// Root mean square of camera turn minus gyro turn from image to image, rad.
    pub residual: f64,
    /// Number of pairs of images.
    pub pairs: usize,
}

/// Longest delay searched: 0.5 s either way. Source: ours, five times a slow USB camera.
const MAX_DELAY_S: f64 = 0.5;
/// Step of the search: 5 ms, a quarter of the period of a gyro at 50 Hz. Source: ours.
const SEARCH_STEP_S: f64 = 0.005;
/// Longest time between two images of a pair: 0.5 s. Source: ours.
const MAX_PAIR_S: f64 = 0.5;
/// Smallest number of pairs: 30, 2 s of images at 15 Hz. Source: ours.
const MIN_PAIRS: usize = 30;
/// Smallest correlation of camera and gyro: 0.8. Source: ours; recordings of the simulator reach 0.99.
const MIN_CORRELATION: f64 = 0.8;
/// Largest standard deviation of an observed delay: 5 ms. Source: ours.
const MAX_SIGMA_S: f64 = 0.005;
/// Smallest noise of a camera's turn from image to image: 0.05 mrad. Source: ours.
const MIN_TURN_SIGMA_RAD: f64 = 5e-5;
/// Number of Gauss-Newton rounds. Source: ours; the delay changes by less than 0.01 ms after four.
const NEWTON_ROUNDS: usize = 6;

/// The delay by the camera's poses (`visual_from_camera`, by rising stamp), the vertical `axis` in the camera's frame
/// ([`crate::turn_axis`]) and the gyro.
///
/// # Errors
/// When too few images or gyro readings are given, the turn rate changes too little, or camera and gyro contradict each other.
pub fn estimate_image_delay(
    poses: &[(Stamp, Pose3)],
    axis: Vector3<f64>,
    gyro: &GyroAngle,
) -> Result<ImageDelay, CalibrationError> {
    require("the gyro", gyro.len(), "record with a gyro, and with its driver running")?;
    let turns: Vec<Turn> = turns(poses, axis).filter(|turn| turn.to - turn.from <= MAX_PAIR_S).collect();
    require("the camera", turns.len(), "record 10 s or more while the robot turns both ways")?;
    let (start, correlation) = best_shift(&turns, gyro);
    if correlation < MIN_CORRELATION {
        return Err(contradiction(correlation));
    }
    let delay = refined(&turns, gyro, start, correlation)?;
    if delay.delay.sigma > MAX_SIGMA_S || delay.delay.value.abs() >= MAX_DELAY_S {
        return Err(not_observable(&delay));
    }
    Ok(delay)
}

fn require(sensor: &'static str, found: usize, advice: &'static str) -> Result<(), CalibrationError> {
    let expected = MIN_PAIRS;
    if found < expected {
        return Err(CalibrationError::TooFewReadings { sensor, found, expected, advice });
    }
    Ok(())
}

fn contradiction(found: f64) -> CalibrationError {
    CalibrationError::Contradiction {
        what: "turns by the camera and by the gyro",
        quantity: "the correlation at the best delay",
        found,
        expected: format!("{MIN_CORRELATION} or more"),
        advice: "turn the robot both ways at 0.5 rad/s or more, in view of walls with texture",
    }
}

fn not_observable(delay: &ImageDelay) -> CalibrationError {
    CalibrationError::NotObservable {
        what: "the image delay",
        quantity: "its standard deviation",
        found: delay.delay.sigma * 1e3,
        unit: "ms",
        expected: format!("{} ms or less, at a delay below {MAX_DELAY_S} s", MAX_SIGMA_S * 1e3),
        advice: "start and stop turning on the spot five times or more: a constant turn rate shows no delay",
    }
}

/// Turn by the gyro over the time of a camera's turn, with exposures `delay` s before the images' stamps.
fn gyro_turn(turn: &Turn, gyro: &GyroAngle, delay: f64) -> Option<f64> {
    gyro.turn(turn.from.after(-delay), turn.to.after(-delay))
}

/// The delay at which the turns of camera and gyro correlate best, s, and the correlation.
fn best_shift(turns: &[Turn], gyro: &GyroAngle) -> (f64, f64) {
    let steps = (MAX_DELAY_S / SEARCH_STEP_S).round() as i64;
    let scored = (-steps..=steps).map(|i| {
        let delay = i as f64 * SEARCH_STEP_S;
        (delay, correlation(turns, gyro, delay))
    });
    scored.fold((0.0, f64::MIN), |best, next| if next.1 > best.1 { next } else { best })
}

/// Pearson correlation of the turn rates; -1 if the gyro covers less than half of the turns.
fn correlation(turns: &[Turn], gyro: &GyroAngle, delay: f64) -> f64 {
    let rate = |turn: &Turn| {
        let seconds = turn.to - turn.from;
        gyro_turn(turn, gyro, delay).map(|angle| Vector2::new(turn.angle, angle) / seconds)
    };
    let rates: Vec<Vector2<f64>> = turns.iter().filter_map(rate).collect();
    if rates.len() * 2 < turns.len() {
        return -1.0;
    }
    let mean = rates.iter().sum::<Vector2<f64>>() / rates.len() as f64;
    let (mut product, mut squares) = (0.0, Vector2::zeros());
    for rate in &rates {
        let d = rate - mean;
        product += d.x * d.y;
        squares += d.component_mul(&d);
    }
    product / (squares.x * squares.y).sqrt().max(f64::MIN_POSITIVE)
}

/// Gauss-Newton over delay, scale and scale times bias from a start.
fn refined(
    turns: &[Turn],
    gyro: &GyroAngle,
    start: f64,
    correlation: f64,
) -> Result<ImageDelay, CalibrationError> {
    let (mut delay, mut scale) = (start, 1.0);
    let mut pairs = 0;
    let mut last: Option<LinearSolution<3>> = None;
    for _ in 0..NEWTON_ROUNDS {
        let fit = linearized(turns, gyro, delay, scale);
        pairs = fit.1;
        require("camera and gyro together", pairs, "record both for 10 s or more")?;
        let Some(solution) = fit.0.solve() else { break };
        delay += solution.x[0].clamp(-2.0 * SEARCH_STEP_S, 2.0 * SEARCH_STEP_S);
        scale = solution.x[1];
        last = Some(solution);
    }
    let flat = || contradiction(correlation);
    let LinearSolution { x, covariance, sigma } = last.ok_or_else(flat)?;
    let deviation = |i: usize| covariance[(i, i)].sqrt();
    Ok(ImageDelay {
        delay: Estimate::new(delay, deviation(0)),
        gyro_scale: Estimate::new(scale, deviation(1)),
        gyro_bias: Estimate::new(x[2] / scale, deviation(2) / scale),
        correlation,
        residual: sigma,
        pairs,
    })
}

/// The equations in (change of the delay, scale, scale times bias) about a delay and a scale, and their number.
fn linearized(turns: &[Turn], gyro: &GyroAngle, delay: f64, scale: f64) -> (LinearFit<3>, usize) {
    let mut fit = LinearFit::new(MIN_TURN_SIGMA_RAD);
    let mut count = 0;
    for turn in turns {
        let angle = gyro_turn(turn, gyro, delay);
        let rates = gyro.rate(turn.from.after(-delay)).zip(gyro.rate(turn.to.after(-delay)));
        if let Some((angle, (first, last))) = angle.zip(rates) {
            // d/dd of s (angle(t' - d) - angle(t - d)) = -s (rate(t' - d) - rate(t - d)).
            fit.add(Vector3::new(-scale * (last - first), angle, turn.from - turn.to), turn.angle);
            count += 1;
        }
    }
    (fit, count)
}
