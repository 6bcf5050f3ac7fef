use super::RgbdSlam;
use crate::closing::{LoopCloser, LoopClosure};

impl RgbdSlam {
    /// Goes on looking for the places of the newest keyframes among the old ones, a piece a frame; whether there was anything to
    /// do. A loop that is closed moves the camera along with the map.
    pub(super) fn look_back(&mut self) -> bool {
        let Some(mut search) = self.searches.pop_front() else { return false };
        let closer = LoopCloser {
            places: &self.active.places,
            sensor: &self.sensor,
            config: &self.config.loops,
            tracking: &self.config.tracking,
            mapping: &self.config.mapping,
            seed: self.seed(),
        };
        if !closer.look(&self.active.map, &mut search) {
            self.searches.push_front(search);
            return true;
        }
        if let Some(closed) = closer.close(&mut self.active.map, search, &mut self.surprise) {
            self.active.follow();
            let correction = self.follow_the_map().unwrap_or(closed.correction);
            self.closed_loop = Some(LoopClosure { correction, ..closed });
        }
        true
    }
}
