//! The robot's body: wheels, dynamics, contact, encoders, gyro.

mod bumper;
mod config;
mod drivetrain;
mod encoders;
mod gyro;
mod slip;

pub use config::KobukiConfig;

use crate::chance::normal;
use crate::world::Obstacles;
use bumper::Bumper;
use drivetrain::Drivetrain;
use encoders::Encoders;
use gyro::Gyro;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use slip::Slip;
use trundle_core::{GyroRate, Pose2, Stamp, Twist2, WheelTicks};

/// Length of a step of the dynamics, s.
pub(crate) const STEP: f64 = 1e-3;

/// Steps a second.
pub(crate) const STEPS_PER_SECOND: f64 = 1e3;

/// Streams of the one seed, so that each kind of noise is independent of how often the others are drawn.
#[derive(Clone, Copy)]
enum Stream {
    Build,
    Slip,
    Gyro,
}

fn generator(seed: u64, stream: Stream) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(stream as u64);
    rng
}

/// A deviate of a standard normal, cut at 2.5 sigma: what leaves a factory.
fn tolerance(rng: &mut ChaCha8Rng) -> f64 {
    normal(rng.next_u64()).clamp(-2.5, 2.5)
}

/// A two-wheeled base in a world, stepped at 1 kHz.
#[derive(Debug)]
pub(crate) struct Kobuki {
    drivetrain: Drivetrain,
    slip: Slip,
    encoders: Encoders,
    gyro: Gyro,
    bumper: Bumper,
    /// True over nominal radius, left and right.
    radius_ratio: (f64, f64),
    /// True distance between the wheels, m.
    wheelbase: f64,
    pose: Pose2,
    /// Turned so far, rad, not wrapped.
    turned: f64,
    path_length: f64,
}

impl Kobuki {
    /// A base standing at `pose`, `world_from_base`; the configuration is valid.
    pub(crate) fn new(config: &KobukiConfig, pose: Pose2, seed: u64) -> Self {
        let mut rng = generator(seed, Stream::Build);
        let mut ratio = |sigma: f64| 1.0 + sigma * tolerance(&mut rng);
        let radius_ratio = (ratio(config.wheel_radius_error), ratio(config.wheel_radius_error));
        let wheelbase = config.drive.wheelbase * ratio(config.wheelbase_error);
        Self {
            drivetrain: Drivetrain::new(config),
            slip: Slip::new(config, generator(seed, Stream::Slip)),
            encoders: Encoders::new(config.drive, (rng.next_u32() as u16, rng.next_u32() as u16)),
            gyro: Gyro::new(config, generator(seed, Stream::Gyro)),
            bumper: Bumper::new(config.footprint_radius),
            radius_ratio,
            wheelbase,
            pose,
            turned: 0.0,
            path_length: 0.0,
        }
    }

    pub(crate) fn command(&mut self, twist: Twist2) {
        self.drivetrain.command(twist);
    }

    /// Goes on by [`STEP`]; returns the bumper's state when it changed.
    pub(crate) fn step(&mut self, obstacles: &Obstacles) -> Option<bool> {
        let (left, right) = self.drivetrain.step();
        let (left, right) = (left * STEP, right * STEP);
        self.encoders.roll(left, right);
        let (slip_left, slip_right) = self.slip.step();
        let left = left * self.radius_ratio.0 * (1.0 + slip_left);
        let right = right * self.radius_ratio.1 * (1.0 + slip_right);
        let motion = Twist2::new((left + right) / 2.0, (right - left) / self.wheelbase);
        let (pose, touch) = self.bumper.resolve(self.pose, self.pose.advance(motion, 1.0), obstacles);
        self.turned += trundle_core::difference_of_angles(pose.theta, self.pose.theta);
        self.path_length += pose.distance(&self.pose);
        self.pose = pose;
        touch
    }

    pub(crate) fn read_wheels(&self, stamp: Stamp) -> WheelTicks {
        let (left, right) = self.encoders.read();
        WheelTicks { stamp, left, right }
    }

    pub(crate) fn read_gyro(&mut self, stamp: Stamp) -> GyroRate {
        GyroRate { stamp, omega: self.gyro.read(stamp, self.turned) }
    }

    pub(crate) fn pose(&self) -> Pose2 {
        self.pose
    }

    pub(crate) fn path_length(&self) -> f64 {
        self.path_length
    }

    pub(crate) fn contacts(&self) -> u32 {
        self.bumper.contacts()
    }
}
