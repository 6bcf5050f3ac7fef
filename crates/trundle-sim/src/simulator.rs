//! The simulator: a Kobuki with camera and laser in a scene, as a robot body.

mod camera;
mod camera_rig;
mod clock;
mod error;
mod latency_queue;
mod track;

use crate::charging_station::StationSensing;
use crate::config::SimConfig;
use crate::faults::Faults;
use crate::kobuki::{ContactScene, Kobuki, STEP_S, TrueWheels};
use crate::laser::Laser;
use crate::people::Crowd;
use crate::scenes::Scene;
use crate::world::{HeightBand, Obstacles, SceneSnapshot};
pub use camera::{DetachedCamera, Shot};
use camera_rig::CameraRig;
use clock::Clock;
pub use error::SimError;
use latency_queue::LatencyQueue;
use std::collections::VecDeque;
use std::sync::Arc;
use track::Track;
use trundle_core::{
    BodyEvent, Cliff, PinholeCamera, Pose2, RobotBody, SensorEvent, Stamp, Touch, Twist2, require_finite,
};

/// Heights between which a person needs free space to walk \[m\]. Source: ours.
const PERSON_HEIGHT_BAND_M: (f64, f64) = (0.05, 1.75);

/// A Kobuki with an RGB-D camera and optionally a laser in a scene, behind the same trait as hardware.
///
/// Events are in the order of their stamps; at equal stamps wheels, gyro, touch, cliff, station, truth, scan, image. Only an image delayed
/// by a fault comes after later events. The first set has stamp 0. Truth comes with every wheel reading, scan and image, also with dropped
/// ones. The simulation has no end. The same scene, configuration, seed and commands give the same bytes on any number of threads.
#[derive(Debug)]
pub struct Simulator {
    scene: Arc<Scene>,
    config: SimConfig,
    obstacles: Obstacles,
    crowd: Crowd,
    body: Kobuki,
    camera: CameraState,
    laser: Option<Laser>,
    /// None in a scene without a charging station.
    station: Option<StationSensing>,
    faults: Faults,
    track: Track,
    /// Steps of 1 ms since the start.
    now: u64,
    clocks: Clocks,
    last_readings: LastReadings,
    outgoing: Outgoing,
    refused_commands: u32,
}

/// The camera of the simulator.
#[derive(Debug)]
struct CameraState {
    /// `None` after the camera was detached.
    rig: Option<CameraRig>,
    /// Shots not yet taken by the detached camera.
    shots: Vec<Shot>,
}

/// Events on their way out of the simulator.
#[derive(Debug, Default)]
struct Outgoing {
    /// Events that arrived, in order.
    queue: VecDeque<SensorEvent>,
    /// Delayed events.
    latency: LatencyQueue,
}

/// Due times of the sensors.
#[derive(Debug)]
struct Clocks {
    wheels: Clock,
    gyro: Clock,
    camera: Clock,
    laser: Clock,
}

/// The last reading of each sensor that reports changes only.
#[derive(Debug, Default)]
struct LastReadings {
    /// Whether the bumper is truly pressed.
    is_touching: bool,
    is_pressed: bool,
    /// The wheels' counters, left and right.
    counters: Option<(u16, u16)>,
    turn_rate: Option<f64>,
}

impl Simulator {
    /// A robot at the scene's start; `seed` is the seed of all noise.
    ///
    /// # Errors
    /// When a number is outside its range or not finite, the robot would start or be moved into an obstacle, or a person's path crosses
    /// one.
    pub fn new(scene: Scene, config: SimConfig, seed: u64) -> Result<Self, SimError> {
        let config = config.validated()?;
        let band = HeightBand::new(config.kobuki.step_over, config.kobuki.height)?;
        let crowd = Crowd::new(&scene.people, band)?;
        if !scene.people.is_empty() {
            crowd.check_ways(
                &scene.world.obstacles(HeightBand::new(PERSON_HEIGHT_BAND_M.0, PERSON_HEIGHT_BAND_M.1)?),
            )?;
        }
        let obstacles = scene.world.obstacles(band);
        require_free(&scene, &config, &obstacles, &crowd)?;
        if config.has_camera {
            scene.world.prepare_textures();
            crowd.prepare_textures();
        }
        let clocks = Clocks {
            wheels: Clock::new(config.kobuki.wheel_rate_hz),
            gyro: Clock::new(config.kobuki.gyro_rate_hz),
            camera: if config.has_camera { Clock::new(config.camera_rate_hz) } else { Clock::never() },
            laser: config.laser.as_ref().map_or(Clock::never(), |laser| Clock::new(laser.rate_hz)),
        };
        let mut simulator = Self {
            obstacles,
            crowd,
            body: Kobuki::new(&config.kobuki, scene.start, seed)?,
            camera: CameraState { rig: Some(CameraRig::new(&config, seed)?), shots: Vec::new() },
            laser: config.laser.clone().map(|laser| Laser::new(laser, seed)),
            station: scene.station.map(|station| StationSensing::new(config.station, station, seed)),
            faults: Faults::new(config.faults.clone(), seed),
            track: Track::new(scene.start, config.memory()),
            now: 0,
            clocks,
            last_readings: LastReadings::default(),
            outgoing: Outgoing::default(),
            refused_commands: 0,
            scene: Arc::new(scene),
            config,
        };
        simulator.break_things();
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
        &self.config.camera
    }

    /// The time reached by the dynamics: that of the newest event.
    pub fn stamp(&self) -> Stamp {
        Stamp::from_nanos(self.now as i64 * 1_000_000)
    }

    /// Number of separate contacts.
    pub fn contacts(&self) -> u32 {
        self.body.contacts()
    }

    /// `world_from_base`.
    pub fn true_pose(&self) -> Pose2 {
        self.body.pose()
    }

    /// The base's true geometry.
    pub fn true_wheels(&self) -> TrueWheels {
        self.body.wheels()
    }

    /// Poses of all persons, in the order of the scene: `world_from_person`, x forward; for evaluation.
    pub fn people(&self) -> Vec<Pose2> {
        self.crowd.poses()
    }

    /// Metres driven.
    pub fn path_length(&self) -> f64 {
        self.body.path_length()
    }

    /// Distance between the robot and the nearest obstacle or person, m.
    pub fn clearance(&self) -> f64 {
        let (footprint, pose) = (self.body.footprint(), self.true_pose());
        self.obstacles.clearance(footprint, pose).min(self.crowd.clearance(footprint, pose))
    }

    /// Commands that were not finite.
    pub fn refused_commands(&self) -> u32 {
        self.refused_commands
    }

    fn step(&mut self) {
        self.now += 1;
        self.break_things();
        self.crowd.step(STEP_S, self.body.footprint(), self.body.pose());
        let around = ContactScene { fixed: &self.obstacles, moving: &self.crowd };
        if let Some(is_touching) = self.body.step(&around) {
            self.last_readings.is_touching = is_touching;
        }
        self.track.add(self.body.pose());
    }

    /// Lets the schedule act on the body.
    fn break_things(&mut self) {
        if self.config.faults.faults.is_empty() {
            return;
        }
        self.faults.at(self.stamp().as_secs());
        self.body.set_grip(self.faults.grip());
        if let Some((left, right)) = self.faults.jump() {
            self.body.jump_ticks(left, right);
        }
        let is_free = |pose| self.crowd.clearance(self.body.footprint(), pose) > 0.0;
        if let Some(pose) = self.faults.kidnapping(is_free) {
            self.body.put(pose);
            self.track.restart(pose);
        }
    }

    /// Queues the readings that are due now, in the fixed order.
    fn read_sensors(&mut self) -> Result<(), SimError> {
        let stamp = self.stamp();
        let (wheels, gyro) = (self.clocks.wheels.due(self.now), self.clocks.gyro.due(self.now));
        let (scan, image) = (self.clocks.laser.due(self.now), self.clocks.camera.due(self.now));
        if wheels.is_some() {
            self.read_wheels(stamp);
        }
        if gyro.is_some() {
            self.read_gyro(stamp);
        }
        self.read_bumper(stamp);
        if wheels.is_some()
            && let Some(over_edge) = self.body.look_for_cliffs(&self.scene.world)
        {
            self.outgoing.queue.push_back(SensorEvent::Cliff(Cliff { stamp, over_edge }));
        }
        if wheels.is_some() {
            self.read_station(stamp);
        }
        if wheels.or(scan).or(image).is_some() {
            self.outgoing.queue.push_back(SensorEvent::Truth { stamp, pose: self.body.pose() });
        }
        if let Some(scan) = scan {
            self.read_laser(stamp, scan)?;
        }
        if let Some(frame) = image {
            self.read_camera(stamp, frame)?;
        }
        self.outgoing.latency.arrive(self.now, &mut self.outgoing.queue);
        Ok(())
    }

    fn read_wheels(&mut self, stamp: Stamp) {
        let mut ticks = self.body.read_wheels(stamp);
        if self.faults.are_encoders_stuck() {
            (ticks.left, ticks.right) = self.last_readings.counters.unwrap_or((ticks.left, ticks.right));
        }
        self.last_readings.counters = Some((ticks.left, ticks.right));
        self.outgoing.queue.push_back(SensorEvent::Wheels(ticks));
    }

    fn read_gyro(&mut self, stamp: Stamp) {
        let mut rate = self.body.read_gyro(stamp);
        if self.faults.is_gyro_stuck() {
            rate.omega = self.last_readings.turn_rate.unwrap_or(rate.omega);
        }
        self.last_readings.turn_rate = Some(rate.omega);
        self.outgoing.queue.push_back(SensorEvent::Gyro(rate));
    }

    fn read_bumper(&mut self, stamp: Stamp) {
        let pressed = self.faults.bumper().unwrap_or(self.last_readings.is_touching);
        if pressed != self.last_readings.is_pressed {
            self.last_readings.is_pressed = pressed;
            self.outgoing.queue.push_back(SensorEvent::Touch(Touch { stamp, pressed }));
        }
    }

    /// Light and charger; no event in a scene without a station.
    fn read_station(&mut self, stamp: Stamp) {
        let Some(station) = &mut self.station else { return };
        let movers = self.crowd.movers();
        let snapshot =
            SceneSnapshot { world: &self.scene.world, movers: &movers, lights: &self.scene.lights };
        let kinds = station.read(self.body.pose(), self.body.footprint(), &snapshot);
        let event = |kind| SensorEvent::Body(BodyEvent::new(stamp, kind));
        self.outgoing.queue.extend(kinds.into_iter().map(event));
    }

    fn read_laser(&mut self, stamp: Stamp, scan: u64) -> Result<(), SimError> {
        let Some(laser) = self.laser.as_ref().filter(|_| !self.faults.is_laser_gone()) else { return Ok(()) };
        let movers = self.crowd.movers();
        let snapshot =
            SceneSnapshot { world: &self.scene.world, movers: &movers, lights: &self.scene.lights };
        let scan = laser.measure(&snapshot, |age| self.track.back(age), stamp, scan)?;
        self.outgoing.queue.push_back(SensorEvent::Scan(scan));
        Ok(())
    }

    fn read_camera(&mut self, stamp: Stamp, frame: u64) -> Result<(), SimError> {
        let fault = self.faults.camera(frame);
        if fault.is_dropped {
            return Ok(());
        }
        let shot = Shot { people: self.crowd.view(), track: self.track.clone(), stamp, frame, fault };
        let Some(rig) = &mut self.camera.rig else {
            self.camera.shots.push(shot);
            return Ok(());
        };
        let image = shot.expose(rig, &self.scene)?;
        self.outgoing.latency.send(SensorEvent::Rgbd(image), self.now, fault.delay, &mut self.outgoing.queue);
        Ok(())
    }
}

/// Refuses a start and kidnappings into things, and a start into people.
fn require_free(
    scene: &Scene,
    config: &SimConfig,
    obstacles: &Obstacles,
    crowd: &Crowd,
) -> Result<(), SimError> {
    let footprint = config.kobuki.outline()?;
    let name = || scene.name.clone();
    let Pose2 { x, y, theta } = scene.start;
    for (field, value, unit) in [("pose x", x, "m"), ("pose y", y, "m"), ("pose theta", theta, "rad")] {
        require_finite(field, value, unit)?;
    }
    require_inside(scene, "start", scene.start)?;
    let clearance = obstacles.clearance(&footprint, scene.start);
    let clearance = clearance.min(crowd.clearance(&footprint, scene.start));
    if clearance <= 0.0 {
        return Err(SimError::StartInObstacle { scene: name(), x, y, penetration: -clearance });
    }
    for (time, pose) in config.faults.kidnappings() {
        require_inside(scene, &format!("kidnapping at {time} s"), pose)?;
        let penetration = -obstacles.clearance(&footprint, pose);
        if penetration >= 0.0 {
            let Pose2 { x, y, .. } = pose;
            return Err(SimError::KidnappedIntoObstacle { scene: name(), time, x, y, penetration });
        }
    }
    Ok(())
}

/// Refuses a pose outside of the scene.
fn require_inside(scene: &Scene, what: &str, Pose2 { x, y, .. }: Pose2) -> Result<(), SimError> {
    let (low, high) = scene.world.bounds();
    if (low.x..=high.x).contains(&x) && (low.y..=high.y).contains(&y) {
        return Ok(());
    }
    let (what, name) = (what.to_owned(), scene.name.clone());
    Err(SimError::OutsideScene { what, scene: name, x, y, low: [low.x, low.y], high: [high.x, high.y] })
}

impl RobotBody for Simulator {
    type Error = SimError;

    /// The next event; never `None`.
    fn next_event(&mut self) -> Result<Option<SensorEvent>, SimError> {
        while self.outgoing.queue.is_empty() {
            self.step();
            self.read_sensors()?;
        }
        Ok(self.outgoing.queue.pop_front())
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

    fn contact_count(&self) -> Option<u32> {
        Some(self.contacts())
    }
}
