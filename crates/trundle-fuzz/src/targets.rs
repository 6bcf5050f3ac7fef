//! The readers, each as a function of bytes.

mod drivers;
mod fleet;
mod logs;
mod maps;
mod saved;
mod sequences;
mod settings;

pub use drivers::{camera_stream, kinect2_dump, kinect2_usb, kobuki, mission};
pub use fleet::{home_command, vda5050};
pub use logs::{bag, cdr, file_kind, laser_log, recording};
pub use maps::{graph, map_picture, map_yaml, places};
pub use saved::{checkpoint, dbow2, visual_map, vocabulary};
pub use sequences::{
    camera, color_image, depth_file, depth_image, image_list, odometry, relations, trajectory,
};
pub use settings::{corridor_problem, drive_script, faults_toml, gltf, robot_toml, scene_toml};
