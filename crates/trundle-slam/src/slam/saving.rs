use super::RgbdSlam;
use crate::component::Component;
use crate::config::SlamConfig;
use crate::persist::{self, MapFileError};
use trundle_core::PinholeCamera;

impl RgbdSlam {
    /// All maps as bytes: versioned, with a checksum, and with what they were made with. The trajectory is no part of them.
    ///
    /// The same maps give the same bytes, before and after [`RgbdSlam::load`].
    pub fn save(&self) -> Vec<u8> {
        let mut maps: Vec<&Component> = self.resting.iter().chain([&self.active]).collect();
        maps.retain(|map| map.map.keyframe_count() > 0);
        maps.sort_by_key(|map| map.id);
        persist::save(&self.sensor.camera, &self.config, maps.into_iter().map(|map| (map.id, &map.map)))
    }

    /// Goes on with saved maps. Where the camera is in them is unknown until it recognises a place, or
    /// [`RgbdSlam::starting_at`] tells; until then it counts as lost, whatever the wheels say.
    ///
    /// # Errors
    /// When the configuration is invalid, or the bytes are no map, of another version, damaged, cut off, made with another
    /// camera or other features, or contradict themselves. No bytes make it panic.
    pub fn load(bytes: &[u8], camera: PinholeCamera, config: SlamConfig) -> Result<Self, MapFileError> {
        let mut slam = Self::new(camera, config)?;
        let maps = persist::load(bytes, &slam.sensor, &slam.config)?;
        let vocabulary = slam.active.places.vocabulary().clone();
        let mut maps = maps.into_iter().map(|(id, map)| Component::new(id, map, &vocabulary));
        if let Some(first) = maps.next() {
            slam.active = first;
            slam.resting = maps.collect();
            slam.kidnapped();
        }
        Ok(slam)
    }
}
