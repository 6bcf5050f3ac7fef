//! Start and goals as a person writes them.

use super::request::NamedPose;
use crate::{AppError, PoseArg};
use std::path::Path;
use std::str::FromStr;
use trundle_io::read_places;

/// A pose on the command line, or the name of a place.
#[derive(Debug, Clone, PartialEq)]
pub enum PlaceArg {
    /// A pose `X,Y,DEG`.
    Pose(PoseArg),
    /// The name of a place in a file of places.
    Name(String),
}

impl PlaceArg {
    /// The poses of places, named ones looked up in the `file` of places.
    ///
    /// # Errors
    /// When the file cannot be read, or has no place of a name.
    pub fn poses<'a>(
        places: impl IntoIterator<Item = &'a Self>,
        file: Option<&Path>,
    ) -> Result<Vec<NamedPose>, AppError> {
        let known = file.map(read_places).transpose()?;
        let pose = |place: &Self| match place {
            Self::Pose(pose) => Ok(NamedPose { pose: pose.0, name: None }),
            Self::Name(name) => NamedPose::of_place(name, file, known.as_ref()),
        };
        places.into_iter().map(pose).collect()
    }
}

impl FromStr for PlaceArg {
    type Err = String;

    /// Text with a comma is a pose.
    fn from_str(text: &str) -> Result<Self, String> {
        match text.trim() {
            "" => Err("expected a pose X,Y,DEG (m, m, deg) or the name of a place".to_owned()),
            pose if pose.contains(',') => Ok(Self::Pose(pose.parse()?)),
            name => Ok(Self::Name(name.to_owned())),
        }
    }
}
