//! A dynamic-window controller [Fox97], written plainly: a baseline for the table.
//!
//! Every 0.1 s it samples speeds and turn rates that the next tenth of a second can reach, follows each arc for a second,
//! drops those that touch something or could not stop, and takes the best by distance, heading and clearance. It ends with
//! a turn on the spot when it stands on the goal.

use trundle_core::{Footprint, Pose2, Twist2, wrap_angle};
use trundle_docking::corridor::Problem;
use trundle_docking::{MotionLimits, Scene};

const DT: f64 = 0.1;
const HORIZON: f64 = 1.0;
/// It gives up after this, s.
const PATIENCE: f64 = 60.0;

/// How a run ended: the time it took when it settled, s, whether anything was touched, and the longest control step, ms.
pub fn drive(problem: &Problem, scene: &Scene, limits: &MotionLimits) -> (Option<f64>, bool) {
    let (mut pose, mut twist, mut contact) = (problem.start, Twist2::ZERO, false);
    for i in 0..(PATIENCE / DT) as usize {
        let error = problem.goal.inverse() * pose;
        if error.position().norm() <= 0.01
            && error.theta.abs() <= 1_f64.to_radians()
            && twist.v.abs() + twist.omega.abs() < 0.02
        {
            return (Some(i as f64 * DT), contact);
        }
        twist = choose(problem, scene, limits, &pose, twist);
        for _ in 0..5 {
            pose = pose.advance(twist, DT / 5.0);
            contact |= touches(&problem.footprint, scene, &pose);
        }
    }
    (None, contact)
}

fn choose(problem: &Problem, scene: &Scene, limits: &MotionLimits, pose: &Pose2, now: Twist2) -> Twist2 {
    let mut best = (f64::INFINITY, Twist2::ZERO);
    for i in -4..=4 {
        for j in -6..=6 {
            let v =
                (now.v + limits.acceleration * DT * f64::from(i) / 4.0).clamp(-limits.speed, limits.speed);
            let rate = now.omega + limits.angular_acceleration * DT * f64::from(j) / 6.0;
            let twist = Twist2::new(v, rate.clamp(-limits.turn_rate, limits.turn_rate));
            let cost = cost(problem, scene, limits, pose, twist);
            if cost < best.0 {
                best = (cost, twist);
            }
        }
    }
    best.1
}

/// The usual sum: distance left, heading where it counts, nearness of obstacles.
fn cost(problem: &Problem, scene: &Scene, limits: &MotionLimits, pose: &Pose2, twist: Twist2) -> f64 {
    let (mut least, mut clearance) = (f64::INFINITY, 0.3_f64);
    // At least as long as it takes to stop.
    let stop = (twist.v.abs() / limits.acceleration).max(twist.omega.abs() / limits.angular_acceleration);
    let horizon = HORIZON.max(stop);
    for i in 1..=10 {
        let at = pose.advance(twist, horizon * f64::from(i) / 10.0);
        if touches(&problem.footprint, scene, &at) {
            let time = horizon * f64::from(i - 1) / 10.0;
            if time < stop + DT {
                return f64::INFINITY;
            }
            break;
        }
        clearance = clearance.min(scene.clearance(&problem.footprint, &at, 0.3).map_or(0.3, |(d, _)| d));
        let error = problem.goal.inverse() * at;
        let near = (-error.position().norm() / 0.15).exp();
        let bearing = wrap_angle((-error.position()).y.atan2((-error.position()).x) - error.theta);
        let facing = bearing.abs().min((std::f64::consts::PI - bearing.abs()).abs());
        let here = error.position().norm() + near * 0.15 * error.theta.abs() + (1.0 - near) * 0.1 * facing;
        least = least.min(here + 0.02 * f64::from(i) / 10.0);
    }
    least + 0.02 * (0.1 - clearance).max(0.0)
}

fn touches(footprint: &Footprint, scene: &Scene, pose: &Pose2) -> bool {
    scene.clearance(footprint, pose, 1e-3).is_some_and(|(distance, _)| distance == 0.0)
}
