//! Zones and named places of a run: the newest, and the file that keeps them.

use super::request::OperatorRequest;
use std::path::PathBuf;
use std::sync::Arc;
use trundle_core::MapAnnotations;
use trundle_runtime::OperatorCommand;

/// The newest annotations of a run, and the file that keeps them.
#[derive(Debug, Default)]
pub(super) struct AnnotationStore {
    pub(super) newest: Arc<MapAnnotations>,
    pub(super) file: Option<PathBuf>,
    /// Number of changes that were sent and not yet applied by the robot.
    pub(super) waiting: u32,
    /// Number of the last request sent before the map was replaced; 0 before any replacement. Changes up to this number belong to an
    /// earlier map.
    pub(super) last_of_earlier_map: u64,
    /// Zones and places of a map that was sent, and the number of that request.
    pub(super) of_sent_map: Option<(u64, MapAnnotations)>,
}

impl AnnotationStore {
    /// The annotations of a run that begins.
    pub(super) fn new(newest: Arc<MapAnnotations>, file: Option<PathBuf>) -> Self {
        Self { newest, file, ..Self::default() }
    }

    /// Adopts the annotations that the robot applied, unless the change was sent here: the change came from a replay or another front end.
    pub(super) fn note_executed(&mut self, annotations: &MapAnnotations) {
        if self.waiting > 0 {
            self.waiting -= 1;
        } else {
            self.newest = Arc::new(annotations.clone());
        }
    }

    /// Clears annotations and file: those of the old map do not belong to the new one. `last`: number of the last request sent.
    pub(super) fn note_map_replaced(&mut self, last: u64) {
        *self = Self { waiting: self.waiting, last_of_earlier_map: last, ..Self::default() };
    }

    /// Zones and places of the map of the executed request `id`, if it had some. They are forgotten here.
    pub(super) fn take_of_sent_map(&mut self, id: u64) -> Option<MapAnnotations> {
        let (_, annotations) = self.of_sent_map.take_if(|(sent, _)| *sent == id)?;
        Some(annotations)
    }

    /// Whether a request changes the zones or places of an earlier map; the robot must not apply such a request to the present map.
    pub(super) fn is_of_earlier_map(&self, request: &OperatorRequest) -> bool {
        matches!(request.command, OperatorCommand::Annotate(_)) && request.id <= self.last_of_earlier_map
    }
}
