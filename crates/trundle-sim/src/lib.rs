//! Worlds, robot dynamics and sensors with noise and ground truth.
//!
//! [`Simulator`] is a Kobuki with a Kinect V2 in a [`Scene`], behind the same trait as hardware ([`trundle_core::RobotBody`]). It shares
//! only trundle-core with the evaluated code. Equal scene, seed and commands give equal bytes, for any number of threads.
//! `docs/algorithms/simulator.md` describes all parts.
//!
//! ```
//! use trundle_core::{RobotBody, SensorEvent, Twist2};
//! use trundle_sim::{Scene, SimConfig, Simulator};
//!
//! let mut robot = Simulator::new(Scene::by_name("demo", 1)?, SimConfig::default(), 1)?;
//! robot.command(Twist2::new(0.2, 0.0))?;
//! let first = robot.next_event()?;
//! assert!(matches!(first, Some(SensorEvent::Wheels(_))));
//! # Ok::<(), trundle_sim::SimError>(())
//! ```

mod camera;
mod charging_station;
mod config;
mod drive;
mod faults;
pub mod import;
mod kobuki;
mod laser;
mod materials;
mod people;
mod rng;
pub mod scenes;
mod simulator;
mod solid;
mod world;

pub use camera::{ColorNoise, DepthNoise, Exposure, Renderer, RgbdSensor, View, blend};
pub use charging_station::StationConfig;
pub use config::{Preset, SimConfig, camera_mount};
pub use drive::{CommandScript, Following, TimedCommand, WaypointFollower, WaypointFollowerConfig};
pub use faults::{Fault, FaultKind, FaultSchedule, WheelSide};
pub use kobuki::{KobukiConfig, TrueWheels};
pub use laser::LaserConfig;
pub use materials::{Finish, Paint};
pub use people::Person;
pub use scenes::{Scene, plain_room};
pub use simulator::{DetachedCamera, Shot, SimError, Simulator};
pub use world::{
    Cuboid, Cylinder, HeightBand, Hit, Lamp, Lights, Material, Mesh, Mover, Obstacles, SceneSnapshot, Shape,
    Solid, Target, Triangle, World,
};
