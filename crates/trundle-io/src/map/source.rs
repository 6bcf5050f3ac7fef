//! The two files of a map or mask: the YAML, and the picture named in it.

use super::picture::Picture;
use super::yaml::MapYaml;
use crate::files::{read_bytes, read_text};
use crate::yaml_document::YamlDocument;
use crate::{Expected, IoError};
use std::path::{Path, PathBuf};
use trundle_core::GridGeometry;

/// A map or mask in the form of its files.
pub(super) struct MapSource {
    pub yaml_path: PathBuf,
    yaml_text: String,
    pub yaml: MapYaml,
    pub picture_path: PathBuf,
    pub picture: Picture,
}

impl MapSource {
    /// Reads the YAML and its picture.
    pub(super) fn read(yaml_path: &Path) -> Result<Self, IoError> {
        Expected::Map.check(yaml_path)?;
        let description = MapDescription::parse(yaml_path, read_text(yaml_path)?)?;
        let picture_path = description.picture_path();
        if !picture_path.exists() {
            let problem = format!("image is '{}', but there is no such file", picture_path.display());
            return Err(IoError::malformed(yaml_path, problem));
        }
        let bytes = read_bytes(picture_path)?;
        description.with_picture(&bytes)
    }

    /// The YAML, for further keys.
    pub(super) fn document(&self) -> Result<YamlDocument<'_>, IoError> {
        YamlDocument::parse(&self.yaml_path, &self.yaml_text)
    }

    /// Geometry of the picture before its rotation.
    pub(super) fn geometry(&self) -> Result<GridGeometry, IoError> {
        let (yaml, picture) = (&self.yaml, &self.picture);
        GridGeometry::new(yaml.resolution, yaml.origin, picture.width, picture.height)
            .map_err(IoError::field(&self.yaml_path))
    }
}

/// The YAML file of a map, before its picture is read: for a reader that decides which files it opens.
#[derive(Debug, Clone, PartialEq)]
pub struct MapDescription {
    yaml_path: PathBuf,
    yaml_text: String,
    yaml: MapYaml,
    picture_path: PathBuf,
}

impl MapDescription {
    /// The content of the YAML file at `yaml_path`.
    ///
    /// # Errors
    /// When a field is missing or not accepted.
    pub fn parse(yaml_path: &Path, yaml_text: String) -> Result<Self, IoError> {
        let yaml = MapYaml::parse(yaml_path, &yaml_text)?;
        let picture_path = yaml_path.parent().unwrap_or(Path::new("")).join(&yaml.image);
        Ok(Self { yaml_path: yaml_path.to_owned(), yaml_text, yaml, picture_path })
    }

    /// Path of the picture; any folder is allowed.
    #[must_use]
    pub fn picture_path(&self) -> &Path {
        &self.picture_path
    }

    pub(super) fn with_picture(self, picture: &[u8]) -> Result<MapSource, IoError> {
        let Self { yaml_path, yaml_text, yaml, picture_path } = self;
        let picture = Picture::parse(&picture_path, picture)?;
        Ok(MapSource { yaml_path, yaml_text, yaml, picture_path, picture })
    }
}
