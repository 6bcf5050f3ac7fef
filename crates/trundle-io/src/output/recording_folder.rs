//! Recordings of an output folder, started by another thread than its owner's.

use crate::{IoError, Recorder};
use std::fs::File;
use std::io::BufWriter;
use std::path::PathBuf;

/// Place of an [`crate::OutputFolder`]'s recordings.
#[derive(Debug, Clone)]
pub struct RecordingFolder {
    stage: PathBuf,
    target: PathBuf,
}

impl RecordingFolder {
    pub(super) fn new(stage: PathBuf, target: PathBuf) -> Self {
        Self { stage, target }
    }

    /// Starts a recording as the file `name`; finish it before the commit of the folder.
    ///
    /// # Errors
    /// When the file cannot be created.
    pub fn recorder(&self, name: &str) -> Result<Recorder<BufWriter<File>>, IoError> {
        let target = self.target.join(name);
        let file = File::create(self.stage.join(name)).map_err(IoError::system(&target, "create"))?;
        Recorder::new(BufWriter::with_capacity(1 << 20, file), &target)
    }
}
