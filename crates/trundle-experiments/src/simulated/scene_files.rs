//! The files that a scene is made of.

use std::path::{Path, PathBuf};
use trundle_io::read_map;
use trundle_sim::import::{GltfOptions, RaisedMap, gltf, raise_map};
use trundle_sim::scenes::file::{BaseLoader, LoadError};
use trundle_sim::{Mesh, Solid};

/// Reads the files that a scene is made of.
pub(super) struct SceneFiles {
    /// What their names are relative to.
    pub(super) folder: PathBuf,
}

impl BaseLoader for SceneFiles {
    fn gltf(&self, path: &Path, options: &GltfOptions) -> Result<Mesh, LoadError> {
        Ok(gltf(&self.folder.join(path), options)?)
    }

    fn map(&self, path: &Path, wall_height: f64) -> Result<Vec<Solid>, LoadError> {
        let file = self.folder.join(path);
        let options = RaisedMap { wall_height, ..RaisedMap::default() };
        Ok(raise_map(&file.display().to_string(), &read_map(&file)?, &options)?)
    }
}
