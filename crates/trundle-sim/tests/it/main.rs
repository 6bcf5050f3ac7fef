//! The simulator against closed forms, and its promises.
#![expect(clippy::unwrap_used, clippy::print_stderr, reason = "helpers of tests")]

mod blur;
mod contact;
mod depth;
mod drive;
mod events;
mod faults;
mod import;
mod laser;
mod meshes;
mod noise;
mod people;
mod scenes;
mod textures;

use trundle_core::{Pose2, Vector3};
use trundle_sim::{Cuboid, Finish, Lights, Paint, Scene, Shape, SimConfig, Solid, World};

/// A plain grey box from its middle and full size, m, rotated by `yaw` rad.
fn block(center: [f64; 3], size: [f64; 3], yaw: f64) -> Solid {
    let shape = Shape::Cuboid(Cuboid { center: Vector3::from(center), size: Vector3::from(size), yaw });
    Solid { shape, finish: Finish::all(Paint::Flat { color: [150; 3] }) }
}

/// A plain hall, 6 x 6 m around the origin, with a wall at x = 3.
fn hall(start: Pose2) -> Scene {
    let floor = block([0.0, 0.0, -0.05], [6.4, 6.4, 0.1], 0.0);
    let walls = [(3.1, 0.0, 0.2, 6.4), (-3.1, 0.0, 0.2, 6.4), (0.0, 3.1, 6.4, 0.2), (0.0, -3.1, 6.4, 0.2)]
        .map(|(x, y, sx, sy)| block([x, y, 1.0], [sx, sy, 2.0], 0.0));
    let solids = walls.into_iter().chain([floor]).collect();
    Scene {
        name: "hall".into(),
        world: World::new(solids, 1).unwrap(),
        lights: Lights::default(),
        people: Vec::new(),
        start,
        goal: Pose2::IDENTITY,
        station: None,
    }
}

/// A robot with a slow camera of few pixels, for tests of the wheels.
fn almost_blind() -> SimConfig {
    let camera = trundle_core::PinholeCamera::from_field_of_view((16, 8), (1.2, 0.8)).unwrap();
    let mut config = SimConfig::default();
    config.camera = camera;
    config.camera_rate_hz = 1.0;
    config
}

/// A file of the shared data; prints a note and returns `None` if absent.
fn shared_data(name: &str) -> Option<std::path::PathBuf> {
    let path = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data")).join(name);
    if path.exists() {
        return Some(path);
    }
    eprintln!("skipped: {} is absent", path.display());
    None
}
