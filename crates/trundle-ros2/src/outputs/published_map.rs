//! The map of the topic `map`, for the services that save or send it.

use std::sync::{Arc, Mutex, PoisonError};
use trundle_app::operator::MapView;
use trundle_core::Stamp;

/// A map and its stamp on the ROS clock.
type StampedMap = (Arc<MapView>, Stamp);

/// The newest map published as a whole. Clones share it.
#[derive(Debug, Clone, Default)]
pub struct PublishedMap(Arc<Mutex<Option<StampedMap>>>);

impl PublishedMap {
    /// Keeps a map that is about to be published.
    pub fn set(&self, map: Arc<MapView>, at: Stamp) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some((map, at));
    }

    /// The newest map; `None` before the first.
    #[must_use]
    pub fn newest(&self) -> Option<(Arc<MapView>, Stamp)> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}
