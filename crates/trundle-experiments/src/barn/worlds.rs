//! The worlds of the BARN challenge, read from its tables and built as scenes.

use crate::csv_rows::rows;
use crate::data_sets::BARN;
use crate::shards::points;
use serde::{Deserialize, Serialize};
use std::path::Path;
use trundle_app::AppError;
use trundle_core::{Invalid, Pose2, Vector2, Vector3};
use trundle_sim::{Cuboid, Cylinder, Finish, Lights, Paint, Scene, Shape, Solid, World};

/// A world of the BARN challenge.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct BarnWorld {
    /// Number of the world in the challenge.
    pub id: usize,
    /// The shortest path at 2 m/s, s.
    pub optimal_time: f64,
    /// Centres of the cylinders, m.
    #[serde(with = "points")]
    pub cylinders: Vec<Vector2>,
}

/// Radius of every cylinder, m. Source: \[Perille20\].
const CYLINDER_RADIUS_M: f64 = 0.075;
/// Height of every cylinder, m. Source: ours, above the plane of the laser.
const CYLINDER_HEIGHT_M: f64 = 1.0;

impl BarnWorld {
    /// Start of the challenge, world frame.
    pub fn start() -> Pose2 {
        Pose2::new(-2.0, 3.0, std::f64::consts::FRAC_PI_2)
    }

    /// Goal of the world, world frame.
    pub fn goal() -> Pose2 {
        Pose2::new(-2.0, 13.0, std::f64::consts::FRAC_PI_2)
    }

    /// The simulated scene: the cylinders on a floor.
    pub fn scene(&self) -> Result<Scene, Invalid> {
        let finish = || Finish::all(Paint::Flat { color: [150, 150, 150] });
        let floor =
            Cuboid { center: Vector3::new(-2.25, 7.0, -0.05), size: Vector3::new(20.0, 24.0, 0.1), yaw: 0.0 };
        let mut solids = vec![Solid { shape: Shape::Cuboid(floor), finish: finish() }];
        solids.extend(self.cylinders.iter().map(|at| {
            let base = Vector3::new(at.x, at.y, 0.0);
            let shape =
                Shape::Cylinder(Cylinder { base, radius: CYLINDER_RADIUS_M, height: CYLINDER_HEIGHT_M });
            Solid { shape, finish: finish() }
        }));
        Ok(Scene {
            name: format!("barn {}", self.id),
            world: World::new(solids, 1)?,
            lights: Lights::default(),
            people: Vec::new(),
            start: Self::start(),
            goal: Self::goal(),
            station: None,
        })
    }
}

/// Reads `worlds.csv` and `obstacles.csv` of a folder.
///
/// # Errors
/// When a file is missing or a line is invalid; the error names file and line.
pub fn read(folder: &Path) -> Result<Vec<BarnWorld>, AppError> {
    let mut worlds = Vec::new();
    for row in rows(&folder.join("worlds.csv"), 4, &BARN)? {
        worlds.push(BarnWorld { id: row.number(0)?, optimal_time: row.number(3)?, cylinders: Vec::new() });
    }
    for row in rows(&folder.join("obstacles.csv"), 5, &BARN)? {
        let id: usize = row.number(0)?;
        let at = Vector2::new(row.number(3)?, row.number(4)?);
        if let Some(world) = worlds.iter_mut().find(|world| world.id == id) {
            world.cylinders.push(at);
        }
    }
    Ok(worlds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_read_and_a_bad_cell_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
        write("worlds.csv", "world,obstacles,length,time\n7,1,12.0,6.0\n");
        write("obstacles.csv", "world,name,kind,x,y\n7,a,cylinder,-1.5,4.25\n8,a,cylinder,0,0\n");
        let worlds = read(folder.path()).unwrap();
        assert_eq!((worlds.len(), worlds[0].id, worlds[0].optimal_time), (1, 7, 6.0));
        assert_eq!(worlds[0].cylinders, vec![Vector2::new(-1.5, 4.25)]);
        assert!(worlds[0].scene().unwrap().world.bounds().1.z >= 1.0);
        write("obstacles.csv", "world,name,kind,x,y\n7,a,cylinder,-1.5,oops\n");
        let error = read(folder.path()).err().unwrap().to_string();
        assert!(error.contains("line 2, column 5: 'oops'"), "{error}");
    }
}
