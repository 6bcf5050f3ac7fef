use super::config::PositionerConfig;
use crate::limits::MotionLimits;
use crate::manoeuvre::Motion;
use crate::scene::Blocker;
use crate::space::Space;
use trundle_core::{Pose2, Twist2, wrap_angle};

/// A motion being carried out on measured poses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Following {
    motion: Motion,
    from: Pose2,
    last_heading: f64,
    turned: f64,
    rate: f64,
}

/// What to do in this step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Command {
    /// Go on like this.
    Go(Twist2),
    /// The motion is at its end.
    Done,
    /// Something is in the way.
    Blocked(Blocker),
}

impl Following {
    /// Begins a motion at a measured pose.
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
        space: &mut Space<'_>,
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
        // What is left when the command begins to show.
        let left = (whole - done) * whole.signum() - self.rate.abs() * config.delay;
        if left <= 0.0 {
            return Command::Done;
        }
        let braking = config.braking * acceleration;
        let allowed = (2.0 * braking * left).sqrt().min(top).max(creep);
        let rate = allowed.min(self.rate.abs() + acceleration * dt);
        let stopping = (rate * rate / (2.0 * braking) + rate * config.delay).min(left);
        // What is still to come, as far as it takes to stop.
        let ahead = match self.motion {
            Motion::Turn(_) => Motion::Turn(stopping.copysign(whole)),
            Motion::Drive(_) => Motion::Drive(stopping.copysign(whole)),
        };
        if let Some(by) = space.in_the_way(pose, ahead) {
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
