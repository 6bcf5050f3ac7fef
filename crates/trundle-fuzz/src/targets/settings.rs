//! Robot files, scenes, faults, scripts and problems.

use crate::scratch::with_file;
use std::io::{Error, ErrorKind};
use trundle::docking::corridor;
use trundle::experiments::simulated::read_faults;
use trundle::runtime::settings::RobotFile;
use trundle::sim::import::{GltfOptions, gltf_from_bytes};
use trundle::sim::scenes::file::{BaseLoader, LoadError, SceneFile};
use trundle::sim::{CommandScript, Mesh, Solid, WaypointFollower};

/// A robot file.
pub fn robot_toml(bytes: &[u8]) {
    let _ = std::str::from_utf8(bytes).map(|text| RobotFile::parse(text, &[]));
}

/// A scene file. The files of its base are absent.
pub fn scene_toml(bytes: &[u8]) {
    let file = std::str::from_utf8(bytes).ok().and_then(|text| toml::from_str::<SceneFile>(text).ok());
    let _ = file.map(|file| file.build(&NoFiles, 1));
}

/// A disk without files.
struct NoFiles;

impl BaseLoader for NoFiles {
    fn gltf(&self, _: &std::path::Path, _: &GltfOptions) -> Result<Mesh, LoadError> {
        Err(Error::from(ErrorKind::NotFound).into())
    }

    fn map(&self, _: &std::path::Path, _: f64) -> Result<Vec<Solid>, LoadError> {
        Err(Error::from(ErrorKind::NotFound).into())
    }
}

/// A schedule of faults.
pub fn faults_toml(bytes: &[u8]) {
    let _ = with_file("faults.toml", bytes, read_faults);
}

/// Commands by the clock, and way-points.
pub fn drive_script(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let _ = CommandScript::parse(text);
    let _ = WaypointFollower::parse(text);
}

/// Docking problems.
pub fn corridor_problem(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let _ = corridor::parse(text);
    let _ = corridor::parse_answers(text);
}

/// A glTF file. Its separate files are absent.
pub fn gltf(bytes: &[u8]) {
    let absent = |_: &str| Err(Error::from(ErrorKind::NotFound));
    let _ = gltf_from_bytes("room.glb", bytes, &GltfOptions::default(), &absent);
}
