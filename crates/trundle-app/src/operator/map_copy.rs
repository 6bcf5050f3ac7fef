//! Copies of a growing map for views.

use super::run_view::MapView;
use std::sync::Arc;
use std::time::{Duration, Instant};
use trundle_core::OccupancyGrid;

/// Time between two copies of the map. Source: ours; the period of a robot's map.
const MAP_PERIOD: Duration = Duration::from_secs(1);

/// The last copy of a map that grows.
#[derive(Debug, Default)]
pub(crate) struct MapCopy {
    view: Option<Arc<MapView>>,
    copied: Option<Instant>,
}

impl MapCopy {
    /// Copies a map of `revision` scans if the last copy is old and of another number of scans, or of the same map before a correction.
    pub(crate) fn update(&mut self, revision: u64, is_corrected: bool, grid: impl FnOnce() -> OccupancyGrid) {
        let is_due = self.copied.is_none_or(|copied| copied.elapsed() >= MAP_PERIOD);
        let is_new = is_corrected || self.view.as_ref().is_none_or(|view| view.revision != revision);
        if is_due && is_new {
            self.view = Some(Arc::new(MapView { number: 0, revision, grid: grid() }));
            self.copied = Some(Instant::now());
        }
    }

    /// The last copy.
    pub(crate) fn view(&self) -> Option<Arc<MapView>> {
        self.view.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_is_copied_once_per_period_and_only_if_it_has_grown() {
        let mut copy = MapCopy::default();
        let grid = || OccupancyGrid::from_ascii(0.5, "#.").unwrap();
        copy.update(1, false, grid);
        assert_eq!(copy.view().unwrap().revision, 1);
        copy.update(2, true, || unreachable!("the last copy is new"));
        copy.copied = Instant::now().checked_sub(MAP_PERIOD);
        copy.update(1, false, || unreachable!("the map is the same"));
        copy.update(2, false, grid);
        assert_eq!(copy.view().unwrap().revision, 2);
    }
}
