//! Scenes from files, as a value that serde reads. The caller handles text and folders.

mod base;
mod error;
mod prop;
mod prop_kind;

pub use base::{Base, BaseLoader};
pub use error::{LoadError, SceneError};
pub use prop::Prop;
pub use prop_kind::{PaintName, PropKind};

use super::Scene;
use crate::people::Person;
use crate::world::{Lights, World};
use error::within;
use serde::{Deserialize, Serialize};
use trundle_core::{Pose2, require_finite, require_in};

/// Largest distance of any object from the origin, m. Source: ours.
const MAX_COORDINATE_M: f64 = 1000.0;

/// A scene file: a base, and additions to it. `docs/formats.md` describes the format.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// The scene's name. Default: the base's.
    pub name: Option<String>,
    /// The base of the scene.
    pub base: Base,
    /// Start and goal of the robot.
    #[serde(default)]
    pub robot: RobotPlaces,
    /// Props in addition to the base.
    #[serde(default)]
    pub props: Vec<Prop>,
    /// Walking people in addition to the base's people.
    #[serde(default)]
    pub people: Vec<Person>,
    /// Lights. Default: those of the base.
    pub lights: Option<Lights>,
}

/// Start and goal of the robot.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RobotPlaces {
    /// Default: the built-in scene's; needed for a base from a file.
    pub start: Option<ScenePose>,
    /// Default: the built-in scene's, or the start.
    pub goal: Option<ScenePose>,
}

/// A pose in the world frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScenePose {
    /// Metres.
    pub x: f64,
    /// Metres.
    pub y: f64,
    /// Degrees from x, counter-clockwise. Default 0.
    #[serde(default)]
    pub heading_deg: f64,
}

impl SceneFile {
    /// The scene. `loader` reads the files of the base; `seed` is used for a base without a seed, and for the textures of props.
    ///
    /// # Errors
    /// Names the item that is wrong (`props[3].size`), or the file and its reader's error.
    pub fn build(&self, loader: &dyn BaseLoader, seed: u64) -> Result<Scene, SceneError> {
        let seed = self.base.seed.unwrap_or(seed);
        let mut base = self.base.load(loader, seed)?;
        for (i, prop) in self.props.iter().enumerate() {
            base.solids.extend(prop.solids(&format!("props[{i}]"), seed, i)?);
        }
        for (i, person) in self.people.iter().enumerate() {
            let person =
                person.clone().validated().map_err(|error| within(&format!("people[{i}]"), error))?;
            base.people.push(person);
        }
        let lights = self.lights.clone().map_or(Ok(base.lights), Lights::validated)?;
        let place = |field: &str, place: Option<ScenePose>| place.map(|place| place.pose(field)).transpose();
        let start = place("robot.start", self.robot.start)?.or(base.start);
        let start = start.ok_or_else(|| SceneError::missing("robot.start", "x, y and heading_deg"))?;
        let goal = place("robot.goal", self.robot.goal)?.or(base.goal).unwrap_or(start);
        Ok(Scene {
            name: self.name.clone().unwrap_or(base.name),
            world: World::with_meshes(base.solids, base.meshes, seed)?,
            lights,
            people: base.people,
            start,
            goal,
            station: None,
        })
    }
}

impl ScenePose {
    fn pose(self, field: &str) -> Result<Pose2, SceneError> {
        require_in(&format!("{field}.x"), self.x, "m", -MAX_COORDINATE_M, MAX_COORDINATE_M)?;
        require_in(&format!("{field}.y"), self.y, "m", -MAX_COORDINATE_M, MAX_COORDINATE_M)?;
        require_finite(&format!("{field}.heading_deg"), self.heading_deg, "deg")?;
        Ok(Pose2::new(self.x, self.y, self.heading_deg.to_radians()))
    }
}
