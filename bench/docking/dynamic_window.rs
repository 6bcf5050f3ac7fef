//! A dynamic-window controller [Fox97], written plainly: a baseline for the table.
//!
//! Every 0.1 s it samples speeds and turn rates that the next tenth of a second can reach, and follows each arc for a second.
//! It drops those that touch something or could not stop, and takes the best by distance, heading and clearance, forward or
//! backward. At the goal's position it stops and turns to the goal's heading, as navigation stacks do.

use trundle_core::{Footprint, Pose2, Twist2, wrap_angle};
use trundle_docking::corridor::Problem;
use trundle_docking::{MotionLimits, ObstacleScene};

/// The period of control, s. Source: ours.
pub const DT: f64 = 0.1;
const HORIZON: f64 = 1.0;
/// On the goal's place it turns; it drives again when it is off by twice as much, m. Source: ours.
const PLACE: f64 = 0.008;

/// Decision for the next tenth of a second, and whether the robot is at the goal's position.
pub struct DynamicWindow<'a> {
    pub problem: &'a Problem,
    pub scene: &'a ObstacleScene,
    pub limits: MotionLimits,
    pub last: Twist2,
    pub turning: bool,
    /// Kept from obstacles, m: see [`kept`].
    pub kept: f64,
}

impl DynamicWindow<'_> {
    /// The next command at a pose.
    pub fn command(&mut self, pose: &Pose2) -> Twist2 {
        let error = self.problem.goal.inverse() * *pose;
        let place = if self.turning { 2.0 * PLACE } else { PLACE };
        self.turning = error.position().norm() <= place;
        self.kept = kept(&self.problem.footprint, self.scene, pose);
        let mut best = (f64::INFINITY, Twist2::ZERO);
        let (speed_step, rate_step) = (self.limits.acceleration * DT, self.limits.angular_acceleration * DT);
        for i in -4..=4 {
            for j in -6..=6 {
                let v = self.last.v + speed_step * f64::from(i) / 4.0;
                let omega = self.last.omega + rate_step * f64::from(j) / 6.0;
                let twist = Twist2::new(
                    if self.turning { 0.0 } else { v.clamp(-self.limits.speed, self.limits.speed) },
                    omega.clamp(-self.limits.turn_rate, self.limits.turn_rate),
                );
                let cost = self.cost(pose, twist);
                if cost < best.0 {
                    best = (cost, twist);
                }
            }
        }
        self.last = best.1;
        best.1
    }

    /// The usual sum: distance left, heading to the goal's place, nearness of obstacles; on the place the heading alone.
    fn cost(&self, pose: &Pose2, twist: Twist2) -> f64 {
        let (mut min, mut clearance) = (f64::INFINITY, 0.3_f64);
        let (brake, turn_brake) = (self.limits.acceleration, self.limits.angular_acceleration);
        let stop = (twist.v.abs() / brake).max(twist.omega.abs() / turn_brake);
        let horizon = HORIZON.max(stop);
        for i in 1..=10 {
            let time = horizon * f64::from(i) / 10.0;
            let at = pose.advance(twist, time);
            if is_near(&self.problem.footprint, self.scene, &at, self.kept) {
                if horizon * f64::from(i - 1) / 10.0 < stop + DT {
                    return f64::INFINITY;
                }
                break;
            }
            clearance = clearance
                .min(self.scene.clearance(&self.problem.footprint, &at, 0.1).map_or(0.1, |(d, _)| d));
            min = min.min(self.left(&at) + 0.02 * time);
        }
        // Too fast to stop at the goal is as bad as passing it.
        let over = (twist.v * twist.v / (2.0 * brake)
            - (self.problem.goal.position() - pose.position()).norm())
        .max(0.0);
        let spin = (twist.omega * twist.omega / (2.0 * turn_brake)
            - wrap_angle(self.problem.goal.theta - pose.theta).abs())
        .max(0.0);
        min + 0.02 * (0.1 - clearance).max(0.0) + 2.0 * over + if self.turning { spin } else { 0.0 }
    }

    fn left(&self, at: &Pose2) -> f64 {
        let gap = self.problem.goal.position() - at.position();
        if self.turning {
            return wrap_angle(self.problem.goal.theta - at.theta).abs();
        }
        let bearing = wrap_angle(gap.y.atan2(gap.x) - at.theta).abs();
        let facing = bearing.min(std::f64::consts::PI - bearing);
        gap.norm() + 0.15 * facing * (gap.norm() / 0.02).min(1.0)
    }
}

/// Distance that a baseline keeps from obstacles in closed loop, m: three standard deviations of the pose's noise, or half of what there
/// is where it stands.
pub fn kept(footprint: &Footprint, scene: &ObstacleScene, pose: &Pose2) -> f64 {
    scene.clearance(footprint, pose, 0.012).map_or(0.006, |(distance, _)| distance / 2.0)
}

/// Whether a footprint at a pose comes nearer to something than `kept` (m).
pub fn is_near(footprint: &Footprint, scene: &ObstacleScene, pose: &Pose2, kept: f64) -> bool {
    scene.clearance(footprint, pose, kept + 1e-3).is_some_and(|(distance, _)| distance <= kept)
}
