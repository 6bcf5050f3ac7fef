//! The files of a surface in their places: by themselves, or in the folder of the results.

use super::{SurfaceFiles, SurfaceRequest};
use crate::AppError;
use trundle_io::{InputFiles, IoError, OutputFile, OutputFolder};

/// Name of the map's picture in the folder of a sequence, which no picture of heights may have.
const MAP_PICTURE: &str = "map.png";

impl SurfaceRequest {
    /// Refuses files that cannot be written beside `inputs` and the results in `folder`. Nothing is written.
    ///
    /// # Errors
    /// Names the file and the remedy.
    pub fn require_places(&self, folder: &OutputFolder, inputs: &InputFiles) -> Result<(), AppError> {
        self.paths().try_for_each(|path| match folder.name_of(&path).as_deref() {
            Some(MAP_PICTURE) => Err(AppError::Input(format!(
                "{}: this is the picture of the map, expected another name, as {}",
                path.display(),
                path.with_file_name("heights.png").display()
            ))),
            Some(_) => Ok(()),
            None => Ok(OutputFile::check(inputs, &path)?),
        })
    }
}

impl SurfaceFiles {
    pub(super) fn failed(failure: String) -> Self {
        Self { failure: Some(failure), ..Self::default() }
    }

    /// Writes the files: those of `folder` with it, the others at once. A file that cannot be written is left out, and the commit of `folder`
    /// reports it.
    pub fn write(&self, folder: &OutputFolder, inputs: &InputFiles) {
        for (path, bytes) in &self.files {
            let written = match folder.name_of(path) {
                Some(name) => folder.write(&name, bytes),
                None => OutputFile::create_apart_from(inputs, path).and_then(|file| file.write(bytes)),
            };
            written.unwrap_or_else(|problem: IoError| folder.leave_out(problem));
        }
    }
}
