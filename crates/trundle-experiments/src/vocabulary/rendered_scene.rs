//! A world with its lights, for rendering.

use crate::simulated::import_mesh;
use std::path::Path;
use trundle_app::AppError;
use trundle_io::FileKind;
use trundle_sim::import::GltfOptions;
use trundle_sim::{Lights, Scene, SceneSnapshot, World};

/// A world and its lights.
pub struct RenderedScene {
    /// Name of the scene, with its seed if any.
    pub name: String,
    /// The solids and meshes.
    pub world: World,
    lights: Lights,
}

impl RenderedScene {
    /// A built-in scene by its name and seed, or a glTF file.
    ///
    /// # Errors
    /// When no such scene exists, or the file cannot be read as glTF.
    pub fn open(name: &str, seed: u64, z_up: bool) -> Result<Self, AppError> {
        let file = Path::new(name);
        if matches!(FileKind::of(file), Ok(FileKind::Glb | FileKind::Gltf)) {
            let options = if z_up { GltfOptions::z_up() } else { GltfOptions::default() };
            let mesh = import_mesh(file, &options).map_err(|error| AppError::Input(error.to_string()))?;
            let world = World::with_meshes(Vec::new(), vec![mesh], seed)?;
            let name = file.file_stem().unwrap_or_default().to_string_lossy();
            return Ok(Self { name: format!("{name} {seed}"), world, lights: Lights::default() });
        }
        let Scene { world, lights, .. } = Scene::by_name(name, seed)?;
        Ok(Self { name: format!("{name} {seed}"), world, lights })
    }

    /// The renderer's input.
    pub fn snapshot(&self) -> SceneSnapshot<'_> {
        SceneSnapshot { world: &self.world, movers: &[], lights: &self.lights }
    }
}
