//! The simulated body of a robot, and scenes by name or file.

mod body;
mod camera_server;
mod demo;
mod emulated_robot;
mod fault_file;
mod free_start;
mod real_time_body;
mod scene;
mod scene_files;

pub use body::{require_free, simulated_body, simulated_real_time_body, time_limit};
pub use demo::DemoRequest;
pub use emulated_robot::{EmulatedRobot, EmulationCounts};
pub use fault_file::read_faults;
pub use real_time_body::SimulatedRealTimeBody;
pub use scene::{MeshOptions, SceneOptions, list_scenes, load_scene, load_simulator};
pub(crate) use scene_files::import_mesh;
