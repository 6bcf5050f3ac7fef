use crate::camera::{Renderer, RgbdSensor, View};
use crate::config::SimConfig;
use crate::kobuki::{Kobuki, STEPS_PER_SECOND};
use crate::scenes::Scene;
use crate::world::{HeightBand, Obstacles};
use std::collections::VecDeque;
use trundle_core::{
    Footprint, Invalid, PinholeCamera, Pose2, Pose3, RgbdImage, RobotBody, SensorEvent, Stamp, Touch, Twist2,
};

/// What can go wrong with a simulated robot.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SimError {
    /// A number of the configuration or the scene.
    #[error(transparent)]
    Invalid(#[from] Invalid),
    /// The robot would stand in something.
    #[error(
        "start of scene '{scene}' at ({x:.3}, {y:.3}) m is {penetration:.3} m inside an obstacle, expected a free place"
    )]
    StartInObstacle {
        /// The scene's name.
        scene: String,
        /// Metres, world frame.
        x: f64,
        /// Metres, world frame.
        y: f64,
        /// Metres.
        penetration: f64,
    },
    /// A command that is not a number; the robot was told to stop instead.
    #[error(
        "command at {stamp} s is v = {v} m/s, omega = {omega} rad/s, expected finite numbers; the robot stops"
    )]
    CommandNotFinite {
        /// When it came.
        stamp: Stamp,
        /// Forward speed asked for, m/s.
        v: f64,
        /// Turn rate asked for, rad/s.
        omega: f64,
    },
}

/// A Kobuki with an RGB-D camera in a scene, behind the trait that hardware is behind.
///
/// Events come in the order of their stamps, at equal stamps wheels, gyro, touch, truth, image. The first set is of time
/// 0. Truth comes with every wheel reading and every image. It never ends by itself. The same scene, seed and commands
/// give the same bytes on any number of threads.
#[derive(Debug)]
pub struct Simulator {
    scene: Scene,
    config: SimConfig,
    obstacles: Obstacles,
    body: Kobuki,
    renderer: Renderer,
    sensor: RgbdSensor,
    view: View,
    /// Steps of 1 ms since the start.
    now: u64,
    wheel_clock: Clock,
    gyro_clock: Clock,
    camera_clock: Clock,
    touch: Option<bool>,
    queue: VecDeque<SensorEvent>,
    refused_commands: u32,
}

impl Simulator {
    /// A robot at the scene's start; `seed` is that of all noise.
    ///
    /// # Errors
    /// When a number is outside its range or not finite, or the robot would stand in an obstacle.
    pub fn new(scene: Scene, config: SimConfig, seed: u64) -> Result<Self, SimError> {
        let config = config.validated()?;
        let footprint = Footprint::disc(config.kobuki.footprint_radius)?;
        let band = HeightBand::new(config.kobuki.step_over, config.kobuki.height)?;
        let clearance = scene.world.clearance(&footprint, scene.start, band)?;
        if clearance <= 0.0 {
            let Pose2 { x, y, .. } = scene.start;
            return Err(SimError::StartInObstacle { scene: scene.name, x, y, penetration: -clearance });
        }
        let renderer = Renderer::new(config.camera)?;
        scene.world.paint();
        let mut simulator = Self {
            obstacles: scene.world.obstacles(band),
            body: Kobuki::new(&config.kobuki, scene.start, seed),
            sensor: RgbdSensor::new(config.depth_noise.clone(), config.color_noise.clone(), seed)?,
            view: renderer.blank(),
            renderer,
            now: 0,
            wheel_clock: Clock::new(config.kobuki.wheel_rate_hz),
            gyro_clock: Clock::new(config.kobuki.gyro_rate_hz),
            camera_clock: Clock::new(config.camera_rate_hz),
            touch: None,
            queue: VecDeque::new(),
            refused_commands: 0,
            scene,
            config,
        };
        simulator.read_sensors()?;
        Ok(simulator)
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The configuration.
    pub fn config(&self) -> &SimConfig {
        &self.config
    }

    /// The camera.
    pub fn camera(&self) -> &PinholeCamera {
        self.renderer.camera()
    }

    /// The moment that the dynamics have reached: that of the newest event made.
    pub fn stamp(&self) -> Stamp {
        Stamp::from_nanos(self.now as i64 * 1_000_000)
    }

    /// How often the robot touched something: separate touches.
    pub fn contacts(&self) -> u32 {
        self.body.contacts()
    }

    /// `world_from_base`.
    pub fn true_pose(&self) -> Pose2 {
        self.body.pose()
    }

    /// Metres driven.
    pub fn path_length(&self) -> f64 {
        self.body.path_length()
    }

    /// Metres between the robot and the nearest thing it could touch.
    pub fn clearance(&self) -> f64 {
        self.obstacles
            .clearance(&Footprint::Disc { radius: self.config.kobuki.footprint_radius }, self.true_pose())
    }

    /// Commands that were not finite.
    pub fn refused_commands(&self) -> u32 {
        self.refused_commands
    }

    fn step(&mut self) {
        self.now += 1;
        if let Some(is_pressed) = self.body.step(&self.obstacles) {
            self.touch = Some(is_pressed);
        }
    }

    /// Queues what is due now, in the fixed order.
    fn read_sensors(&mut self) -> Result<(), SimError> {
        let stamp = self.stamp();
        let wheels_due = self.wheel_clock.is_due(self.now);
        let image_due = self.camera_clock.is_due(self.now);
        if wheels_due {
            self.queue.push_back(SensorEvent::Wheels(self.body.read_wheels(stamp)));
        }
        if self.gyro_clock.is_due(self.now) {
            self.queue.push_back(SensorEvent::Gyro(self.body.read_gyro(stamp)));
        }
        if let Some(pressed) = self.touch.take() {
            self.queue.push_back(SensorEvent::Touch(Touch { stamp, pressed }));
        }
        if wheels_due || image_due {
            self.queue.push_back(SensorEvent::Truth { stamp, pose: self.body.pose() });
        }
        if image_due {
            let image = self.take_image(stamp)?;
            self.queue.push_back(SensorEvent::Rgbd(image));
        }
        Ok(())
    }

    fn take_image(&mut self, stamp: Stamp) -> Result<RgbdImage, SimError> {
        let world_from_camera = Pose3::from_pose2(self.body.pose()) * self.config.base_from_camera;
        self.renderer.render(&self.scene.stage(), &world_from_camera, &mut self.view);
        Ok(self.sensor.expose(&self.view, stamp, self.camera_clock.ticks() - 1)?)
    }
}

impl RobotBody for Simulator {
    type Error = SimError;

    /// The next event; never `None`.
    fn next_event(&mut self) -> Result<Option<SensorEvent>, SimError> {
        while self.queue.is_empty() {
            self.step();
            self.read_sensors()?;
        }
        Ok(self.queue.pop_front())
    }

    /// Drives with `twist` once the command delay is over.
    ///
    /// # Errors
    /// When the command is not finite; the robot then stops.
    fn command(&mut self, twist: Twist2) -> Result<(), SimError> {
        if twist.is_finite() {
            self.body.command(twist);
            return Ok(());
        }
        self.refused_commands += 1;
        self.body.command(Twist2::ZERO);
        Err(SimError::CommandNotFinite { stamp: self.stamp(), v: twist.v, omega: twist.omega })
    }
}

/// When a sensor is due: the n-th reading at the step nearest to n / rate.
#[derive(Debug)]
struct Clock {
    steps: f64,
    ticks: u64,
}

impl Clock {
    fn new(rate_hz: f64) -> Self {
        Self { steps: STEPS_PER_SECOND / rate_hz, ticks: 0 }
    }

    fn is_due(&mut self, now: u64) -> bool {
        let due = now >= (self.ticks as f64 * self.steps).round() as u64;
        self.ticks += u64::from(due);
        due
    }

    fn ticks(&self) -> u64 {
        self.ticks
    }
}
