//! Execution of one motion on measured poses.

use crate::contact_space::ContactSpace;
use crate::motion::limits::MotionLimits;
use crate::motion::manoeuvre::Motion;
use crate::positioner::config::PositionerConfig;
use crate::scene::blocker::Blocker;
use trundle_core::{Pose2, Twist2, wrap_angle};

/// A motion that is carried out on measured poses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionExecution {
    motion: Motion,
    from: Pose2,
    last_heading: f64,
    turned: f64,
    rate: f64,
}

/// Result of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Command {
    /// Continue with this twist.
    Go(Twist2),
    /// The motion is complete.
    Done,
    /// An obstacle blocks the motion.
    Blocked(Blocker),
}

impl MotionExecution {
    /// Starts a motion at a measured pose.
    pub fn new(motion: Motion, from: Pose2) -> Self {
        Self { motion, from, last_heading: from.theta, turned: 0.0, rate: 0.0 }
    }

    /// The motion.
    pub fn motion(&self) -> Motion {
        self.motion
    }

    /// The command for a base at `pose`, `dt` seconds after the last one.
    pub fn step(
        &mut self,
        pose: &Pose2,
        dt: f64,
        space: &mut ContactSpace<'_>,
        limits: &MotionLimits,
        config: &PositionerConfig,
    ) -> Command {
        self.turned += wrap_angle(pose.theta - self.last_heading);
        self.last_heading = pose.theta;
        let (top, acceleration, creep, done) = match self.motion {
            Motion::Turn(_) => {
                (limits.turn_rate, limits.angular_acceleration, config.creep_rate, self.turned)
            }
            Motion::Drive(_) => {
                let along = (pose.position() - self.from.position()).dot(&self.from.direction());
                (limits.speed, limits.acceleration, config.creep_speed, along)
            }
        };
        let whole = self.motion.amount();
        // The remaining motion at the time when the command takes effect.
        let left = (whole - done) * whole.signum() - self.rate.abs() * config.delay;
        if left <= 0.0 {
            return Command::Done;
        }
        let braking = config.braking * acceleration;
        let allowed = (2.0 * braking * left).sqrt().min(top).max(creep);
        let rate = allowed.min(self.rate.abs() + acceleration * dt);
        let stopping = (rate * rate / (2.0 * braking) + rate * config.delay).min(left);
        // The part of the motion needed to stop.
        let ahead = match self.motion {
            Motion::Turn(_) => Motion::Turn(stopping.copysign(whole)),
            Motion::Drive(_) => Motion::Drive(stopping.copysign(whole)),
        };
        if let Some(by) = space.blocker_of(pose, ahead) {
            return Command::Blocked(by);
        }
        self.rate = rate;
        Command::Go(match self.motion {
            Motion::Turn(_) => Twist2::new(0.0, rate.copysign(whole)),
            Motion::Drive(_) => {
                let off = wrap_angle(self.from.theta - pose.theta);
                Twist2::new(rate.copysign(whole), (config.heading_gain * off).clamp(-0.1, 0.1))
            }
        })
    }
}
