//! Small valid inputs of each target.

mod binary;
mod drivers;
mod fleet;
mod pictures;
mod saved;
mod text;

pub use binary::{bag, cdr, gltf, laser_log, recording, sqlite};
pub use drivers::{camera_stream, kinect2_dump, kinect2_usb, kobuki, mission};
pub use fleet::{home_command, vda5050};
pub(crate) use pictures::small_png;
pub use pictures::{color_image, depth_file, depth_image, map_picture};
pub(crate) use saved::small_camera;
pub use saved::{checkpoint, dbow2, visual_map, vocabulary};
pub(crate) use text::{MAP_YAML, SMALL_PGM};
pub use text::{
    camera, corridor_problem, drive_script, faults_toml, graph, image_list, map_yaml, odometry, places,
    relations, robot_toml, scene_toml, trajectory,
};

/// One file of each kind.
pub fn file_kind() -> Vec<Vec<u8>> {
    let kinds = [
        map_yaml,
        map_picture,
        graph,
        laser_log,
        trajectory,
        camera,
        gltf,
        robot_toml,
        color_image,
        recording,
        sqlite,
    ];
    kinds.iter().filter_map(|seeds| seeds().into_iter().next()).collect()
}

/// Texts as inputs.
fn texts(texts: &[&str]) -> Vec<Vec<u8>> {
    texts.iter().map(|text| text.as_bytes().to_vec()).collect()
}

#[cfg(test)]
mod tests {
    use crate::TARGETS;

    #[test]
    fn every_target_has_seeds() {
        for target in TARGETS {
            let seeds = (target.seeds)();
            assert!(!seeds.is_empty() && seeds.iter().all(|seed| !seed.is_empty()), "{}", target.name);
        }
    }
}
