//! The base of a scene file: a built-in scene, a glTF file or a map.

use super::MAX_COORDINATE_M;
use super::error::{LoadError, SceneError};
use crate::import::{GltfOptions, UpAxis};
use crate::people::Person;
use crate::scenes::Scene;
use crate::world::{Lights, Mesh, Solid};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use trundle_core::{Invalid, Pose2, require_in};

/// The base of a scene: exactly one of `scene`, `gltf` and `map`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Base {
    /// A built-in scene, one of [`Scene::NAMES`].
    pub scene: Option<String>,
    /// Seed of its variation, and of the textures of all solids. Default: the seed of the run.
    pub seed: Option<u64>,
    /// A glTF or GLB file, relative to the scene file.
    pub gltf: Option<PathBuf>,
    /// The glTF's axis that points up. Default `y`, as glTF 2.0 has it.
    pub up: Option<UpAxis>,
    /// Metres per unit of the glTF, 0.0001 to 1000. Default 1.
    pub scale: Option<f64>,
    /// Height of the glTF's floor, m, -1000 to 1000, which is moved to z = 0. Default: the detected height.
    pub floor: Option<f64>,
    /// A map's YAML file, relative to the scene file.
    pub map: Option<PathBuf>,
    /// Height that occupied cells of the map are raised to, m, 0.1 to 20. Default 2.5.
    pub wall_height: Option<f64>,
}

/// Reads the files referred to by a scene file; paths are relative to the scene file, which the caller opens.
pub trait BaseLoader {
    /// A glTF or GLB file ([`crate::import::gltf()`]).
    ///
    /// # Errors
    /// The reader's error.
    fn gltf(&self, path: &Path, options: &GltfOptions) -> Result<Mesh, LoadError>;

    /// A map (YAML and PGM), its occupied cells raised to `wall_height` m, and its floor.
    ///
    /// # Errors
    /// The reader's error.
    fn map(&self, path: &Path, wall_height: f64) -> Result<Vec<Solid>, LoadError>;
}

/// A base as loaded.
pub(super) struct LoadedBase {
    pub(super) name: String,
    pub(super) solids: Vec<Solid>,
    pub(super) meshes: Vec<Mesh>,
    pub(super) lights: Lights,
    pub(super) people: Vec<Person>,
    pub(super) start: Option<Pose2>,
    pub(super) goal: Option<Pose2>,
}

impl Base {
    pub(super) fn load(&self, loader: &dyn BaseLoader, seed: u64) -> Result<LoadedBase, SceneError> {
        self.refuse_strays()?;
        match (&self.scene, &self.gltf, &self.map) {
            (Some(name), None, None) => built_in(name, seed),
            (None, Some(path), None) => {
                let scale = require_in("base.scale", self.scale.unwrap_or(1.0), "m per unit", 1e-4, 1e3)?;
                self.floor.map_or(Ok(0.0), |z| {
                    require_in("base.floor", z, "m", -MAX_COORDINATE_M, MAX_COORDINATE_M)
                })?;
                let up = self.up.unwrap_or_default();
                let options = GltfOptions { up, scale, floor: self.floor, ..GltfOptions::default() };
                let mesh = loader.gltf(path, &options).map_err(|e| SceneError::load("base.gltf", path, e))?;
                Ok(from_file(path, Vec::new(), vec![mesh]))
            }
            (None, None, Some(path)) => {
                let height = require_in("base.wall_height", self.wall_height.unwrap_or(2.5), "m", 0.1, 20.0)?;
                let solids = loader.map(path, height).map_err(|e| SceneError::load("base.map", path, e))?;
                Ok(from_file(path, solids, Vec::new()))
            }
            _ => {
                let given = [self.scene.is_some(), self.gltf.is_some(), self.map.is_some()];
                let count = given.into_iter().filter(|&given| given).count();
                Err(Invalid::new("base", count, "of scene, gltf, map", "exactly one").into())
            }
        }
    }

    /// Settings of another kind of base than this one.
    fn refuse_strays(&self) -> Result<(), Invalid> {
        let strays = [
            ("base.up", self.up.is_some(), self.gltf.is_some(), "only beside base.gltf"),
            ("base.scale", self.scale.is_some(), self.gltf.is_some(), "only beside base.gltf"),
            ("base.floor", self.floor.is_some(), self.gltf.is_some(), "only beside base.gltf"),
            ("base.wall_height", self.wall_height.is_some(), self.map.is_some(), "only beside base.map"),
        ];
        match strays.into_iter().find(|(_, given, fits, _)| *given && !fits) {
            Some((field, _, _, expected)) => Err(Invalid::new(field, "given", "", expected)),
            None => Ok(()),
        }
    }
}

fn built_in(name: &str, seed: u64) -> Result<LoadedBase, SceneError> {
    let scene =
        Scene::by_name(name, seed).map_err(|error| Invalid { field: "base.scene".into(), ..error })?;
    Ok(LoadedBase {
        solids: scene.world.solids().to_vec(),
        meshes: scene.world.meshes().to_vec(),
        name: scene.name,
        lights: scene.lights,
        people: scene.people,
        start: Some(scene.start),
        goal: Some(scene.goal),
    })
}

fn from_file(path: &Path, solids: Vec<Solid>, meshes: Vec<Mesh>) -> LoadedBase {
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let (lights, people) = (Lights::default(), Vec::new());
    LoadedBase { name, solids, meshes, lights, people, start: None, goal: None }
}
