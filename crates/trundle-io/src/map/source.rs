//! The two files of a map or mask: its YAML and the picture that this names.

use super::picture::Picture;
use super::yaml::MapYaml;
use crate::files::{read_bytes, read_text};
use crate::yaml_document::YamlDocument;
use crate::{Expected, IoError};
use std::path::{Path, PathBuf};
use trundle_core::GridGeometry;

/// A map or mask as its files hold it.
pub(super) struct MapSource {
    pub yaml_path: PathBuf,
    yaml_text: String,
    pub yaml: MapYaml,
    pub picture_path: PathBuf,
    pub picture: Picture,
}

impl MapSource {
    /// Reads the YAML and the picture that it names.
    pub(super) fn read(yaml_path: &Path) -> Result<Self, IoError> {
        Expected::Map.check(yaml_path)?;
        let yaml_text = read_text(yaml_path)?;
        let yaml = MapYaml::parse(yaml_path, &yaml_text)?;
        let picture_path = yaml_path.parent().unwrap_or(Path::new("")).join(&yaml.image);
        if !picture_path.exists() {
            let problem = format!("image is '{}', but there is no such file", picture_path.display());
            return Err(IoError::malformed(yaml_path, problem));
        }
        let picture = Picture::parse(&picture_path, &read_bytes(&picture_path)?)?;
        Ok(Self { yaml_path: yaml_path.to_owned(), yaml_text, yaml, picture_path, picture })
    }

    /// The YAML, for further keys.
    pub(super) fn document(&self) -> Result<YamlDocument<'_>, IoError> {
        YamlDocument::parse(&self.yaml_path, &self.yaml_text)
    }

    /// Where the picture lies, before it is turned.
    pub(super) fn geometry(&self) -> Result<GridGeometry, IoError> {
        let (yaml, picture) = (&self.yaml, &self.picture);
        GridGeometry::new(yaml.resolution, yaml.origin, picture.width, picture.height)
            .map_err(IoError::field(&self.yaml_path))
    }
}
