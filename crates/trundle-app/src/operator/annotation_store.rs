//! Zones and named places of a run: the newest, and the file that keeps them.

use std::path::PathBuf;
use std::sync::Arc;
use trundle_core::MapAnnotations;

/// The newest annotations of a run, and the file that keeps them.
#[derive(Debug, Default)]
pub(super) struct AnnotationStore {
    pub(super) newest: Arc<MapAnnotations>,
    pub(super) file: Option<PathBuf>,
    /// Changes that were sent and that the robot has not obeyed yet.
    pub(super) waiting: u32,
}

impl AnnotationStore {
    /// The annotations of a run that begins.
    pub(super) fn new(newest: Arc<MapAnnotations>, file: Option<PathBuf>) -> Self {
        Self { newest, file, waiting: 0 }
    }

    /// Takes over what the robot obeys, where it is no change that was sent here: a replay, or another way to the robot.
    pub(super) fn note_obeyed(&mut self, annotations: &MapAnnotations) {
        if self.waiting > 0 {
            self.waiting -= 1;
        } else {
            self.newest = Arc::new(annotations.clone());
        }
    }

    /// Begins without annotations and without a file: those of the old map do not belong to the new one.
    pub(super) fn note_map_replaced(&mut self) {
        *self = Self { waiting: self.waiting, ..Self::default() };
    }
}
