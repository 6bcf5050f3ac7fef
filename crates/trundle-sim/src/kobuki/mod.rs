//! The robot's body: wheels, dynamics, contact, encoders, gyro, cliff sensors.

mod bumper;
mod cliff;
mod config;
mod contact_scene;
mod drivetrain;
mod dynamics_step;
mod encoders;
mod gyro;
mod slip;
mod tolerance;

pub use config::KobukiConfig;
pub(crate) use contact_scene::ContactScene;
pub(crate) use dynamics_step::{STEP_S, STEPS_PER_SECOND};

use crate::world::World;
use bumper::Bumper;
use cliff::CliffSensors;
use drivetrain::Drivetrain;
use encoders::Encoders;
use gyro::Gyro;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use slip::Slip;
use tolerance::tolerance;
use trundle_core::{Footprint, GyroRate, Invalid, Pose2, Stamp, Twist2, WheelTicks};

/// Random streams derived from the seed: each kind of noise is independent of the number of other draws.
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

/// The true geometry of a base, the target of a calibration: for evaluation only.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrueWheels {
    /// Radius of the left wheel, m.
    pub left_radius: f64,
    /// Radius of the right wheel, m.
    pub right_radius: f64,
    /// Distance between the wheels, m.
    pub wheelbase: f64,
}

/// A two-wheeled base in a world, stepped at 1 kHz.
#[derive(Debug)]
pub(crate) struct Kobuki {
    drivetrain: Drivetrain,
    slip: Slip,
    encoders: Encoders,
    gyro: Gyro,
    bumper: Bumper,
    cliff: CliffSensors,
    wheels: TrueWheels,
    /// True over nominal radius, left and right.
    radius_ratio: (f64, f64),
    /// Fraction of each wheel's distance that moves the body, left and right: 1 without a fault.
    grip: (f64, f64),
    pose: Pose2,
    /// Turned so far, rad, not wrapped.
    turned: f64,
    path_length: f64,
}

impl Kobuki {
    /// A base standing at `pose`, `world_from_base`; the configuration is valid.
    ///
    /// # Errors
    /// When the outline is invalid.
    pub(crate) fn new(config: &KobukiConfig, pose: Pose2, seed: u64) -> Result<Self, Invalid> {
        let mut rng = generator(seed, Stream::Build);
        let mut ratio = |sigma: f64| 1.0 + sigma * tolerance(&mut rng);
        let radius_ratio = (ratio(config.wheel_radius_error), ratio(config.wheel_radius_error));
        let wheels = TrueWheels {
            left_radius: config.drive.wheel_radius * radius_ratio.0,
            right_radius: config.drive.wheel_radius * radius_ratio.1,
            wheelbase: config.drive.wheelbase * ratio(config.wheelbase_error),
        };
        Ok(Self {
            drivetrain: Drivetrain::new(config),
            slip: Slip::new(config, generator(seed, Stream::Slip)),
            encoders: Encoders::new(config.drive, (rng.next_u32() as u16, rng.next_u32() as u16)),
            gyro: Gyro::new(config, generator(seed, Stream::Gyro)),
            bumper: Bumper::new(config.outline()?),
            cliff: CliffSensors::new(&config.cliff_sensors, config.step_over, config.cliff_depth),
            wheels,
            radius_ratio,
            grip: (1.0, 1.0),
            pose,
            turned: 0.0,
            path_length: 0.0,
        })
    }

    pub(crate) fn command(&mut self, twist: Twist2) {
        self.drivetrain.command(twist);
    }

    /// Goes on by [`STEP_S`]; returns the bumper's state when it changed.
    pub(crate) fn step(&mut self, around: &ContactScene<'_>) -> Option<bool> {
        let (left, right) = self.drivetrain.step();
        let (left, right) = (left * STEP_S, right * STEP_S);
        self.encoders.roll(left, right);
        let (slip_left, slip_right) = self.slip.step();
        let left = left * self.radius_ratio.0 * self.grip.0 * (1.0 + slip_left);
        let right = right * self.radius_ratio.1 * self.grip.1 * (1.0 + slip_right);
        let motion = Twist2::new((left + right) / 2.0, (right - left) / self.wheels.wheelbase);
        let (pose, touch) = self.bumper.resolve(self.pose, self.pose.advance(motion, 1.0), around);
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

    /// Whether any cliff sensor has no floor below, when that changed.
    pub(crate) fn look_for_cliffs(&mut self, world: &World) -> Option<bool> {
        self.cliff.update(self.pose, world)
    }

    /// Sets the fraction of each wheel's distance that moves the body, left and right.
    pub(crate) fn set_grip(&mut self, grip: (f64, f64)) {
        self.grip = grip;
    }

    /// Adds ticks to the encoders' counters without a motion, left and right.
    pub(crate) fn jump_ticks(&mut self, left: i32, right: i32) {
        self.encoders.jump(left, right);
    }

    /// Puts the body at `pose`, `world_from_base`, which must be free; no sensor of the body measures it.
    pub(crate) fn put(&mut self, pose: Pose2) {
        self.pose = pose;
        self.bumper.lift();
    }

    pub(crate) fn wheels(&self) -> TrueWheels {
        self.wheels
    }

    pub(crate) fn footprint(&self) -> &Footprint {
        self.bumper.footprint()
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
