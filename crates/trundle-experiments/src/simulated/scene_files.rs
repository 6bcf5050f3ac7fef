//! The files of a scene.

use std::path::{Path, PathBuf};
use trundle_app::read_map;
use trundle_sim::import::{GltfOptions, ImportError, RaisedMap, gltf, raise_map};
use trundle_sim::scenes::file::{BaseLoader, LoadError};
use trundle_sim::{Mesh, Solid};

/// The mesh of a glTF file; logs a warning for each note of the import.
///
/// # Errors
/// As [`gltf`].
pub fn import_mesh(file: &Path, options: &GltfOptions) -> Result<Mesh, ImportError> {
    let scene = gltf(file, options)?;
    for note in &scene.notes {
        tracing::warn!("{}: {note}", file.display());
    }
    Ok(scene.mesh)
}

/// Reads the files of a scene.
pub(super) struct SceneFiles {
    /// Folder to which the names are relative.
    pub(super) folder: PathBuf,
}

impl BaseLoader for SceneFiles {
    fn gltf(&self, path: &Path, options: &GltfOptions) -> Result<Mesh, LoadError> {
        Ok(import_mesh(&self.folder.join(path), options)?)
    }

    fn map(&self, path: &Path, wall_height: f64) -> Result<Vec<Solid>, LoadError> {
        let file = self.folder.join(path);
        let options = RaisedMap { wall_height, ..RaisedMap::default() };
        Ok(raise_map(&file.display().to_string(), &read_map(&file)?, &options)?)
    }
}
