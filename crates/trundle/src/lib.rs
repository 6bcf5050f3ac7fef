//! Autonomy for a two-wheeled indoor robot with one RGB-D camera: localization, mapping, path planning, control, and an exact final
//! approach. The library needs no ROS.
//!
//! The whole robot is [`runtime::Robot`]: sensor events in, pose, map, plan and twist out.
//!
//! ```no_run
//! use trundle::core::RobotBody;
//! use trundle::runtime::{Robot, RobotConfig};
//! use trundle::sim::{Scene, SimConfig, Simulator};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = Scene::by_name("demo", 1)?;
//! let goal = scene.start_from_goal();
//! let mut body = Simulator::new(scene, SimConfig::default(), 1)?; // or a driver of yours
//! let mut robot = Robot::new(RobotConfig::default())?;
//! robot.drive_to(goal)?;
//! while let Some(event) = body.next_event()? {
//!     let report = robot.step(&event);
//!     if let Some(twist) = report.twist {
//!         body.command(twist)?;
//!     }
//!     if report.finished {
//!         break;
//!     }
//! }
//! # Ok(()) }
//! ```
//!
//! | to | use |
//! |---|---|
//! | run a robot with recording and report | [`app`], [`runtime`] |
//! | track a camera | [`slam`], features by [`vision`] |
//! | turn depth into scans and scans into a map | [`mapping`], cells by [`grid`] |
//! | fuse wheels, gyro and camera | [`estimation`] |
//! | plan a path | [`planning`] |
//! | follow it | [`control`] |
//! | settle in tight places | [`docking`] |
//! | drive real hardware | [`drivers`] |
//! | simulate, evaluate, draw | [`sim`], [`eval`], [`viz`] |
//! | read and write files | [`io`] |
//! | show a run in a browser | [`live`] |
//! | join a home or a fleet by MQTT | `fleet`, with the feature `mqtt` |
//! | show a run in Foxglove | `foxglove`, with the feature `foxglove` |
//! | speak ROS 2 | `ros2`, with the feature `ros2` |
//!
//! # Features
//!
//! `full` is the default: all but `ros2`, `mqtt` and `foxglove`. Without it, `slam`, `mapping`, `estimation`, `planning`, `control`, `docking`, `surface`,
//! `sim`, `drivers`, `io`, `eval` and `viz` are the modules of these names, with the modules that they need. `runtime` is the whole robot
//! without simulator. `core` is always there. No feature changes a result.
//!
//! `crates/trundle/examples` contains eight numbered examples.

#[cfg(feature = "full")]
pub use trundle_app as app;
#[cfg(any(feature = "planning", feature = "control", feature = "docking"))]
pub use trundle_collision as collision;
#[cfg(feature = "control")]
pub use trundle_control as control;
pub use trundle_core as core;
#[cfg(feature = "docking")]
pub use trundle_docking as docking;
#[cfg(feature = "drivers")]
pub use trundle_drivers as drivers;
#[cfg(feature = "estimation")]
pub use trundle_estimation as estimation;
#[cfg(feature = "eval")]
pub use trundle_eval as eval;
#[cfg(feature = "full")]
pub use trundle_experiments as experiments;
#[cfg(feature = "mqtt")]
pub use trundle_fleet as fleet;
#[cfg(feature = "foxglove")]
pub use trundle_foxglove as foxglove;
#[cfg(any(feature = "mapping", feature = "planning"))]
pub use trundle_grid as grid;
#[cfg(feature = "io")]
pub use trundle_io as io;
#[cfg(feature = "full")]
pub use trundle_live as live;
#[cfg(feature = "mapping")]
pub use trundle_mapping as mapping;
#[cfg(feature = "slam")]
pub use trundle_optim as optim;
#[cfg(feature = "planning")]
pub use trundle_planning as planning;
#[cfg(feature = "ros2")]
pub use trundle_ros2 as ros2;
#[cfg(feature = "runtime")]
pub use trundle_runtime as runtime;
#[cfg(feature = "sim")]
pub use trundle_sim as sim;
#[cfg(feature = "slam")]
pub use trundle_slam as slam;
#[cfg(feature = "surface")]
pub use trundle_surface as surface;
#[cfg(feature = "slam")]
pub use trundle_vision as vision;
#[cfg(feature = "viz")]
pub use trundle_viz as viz;
