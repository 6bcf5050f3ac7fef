//! A feature of a frame, matched with a point of the map.

use crate::frame::aligned_feature::Aligned;
use crate::frame::rgbd_frame::Frame;
use crate::ids::LandmarkId;
use crate::map::landmark_map::LandmarkMap;
use trundle_core::Vector3;
use trundle_optim::PointObservation;

/// A feature of the frame, matched with a point of the visual frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PointMatch {
    pub feature: usize,
    /// Visual frame, m.
    pub point: Vector3,
    /// The landmark; `None` of a point that is only a depth of an earlier frame.
    pub landmark: Option<LandmarkId>,
    /// Factor of the standard deviations, because the point is not known exactly.
    pub sigma_factor: f64,
    /// Position of the feature after alignment to a reference patch, if that fits.
    pub aligned: Option<Aligned>,
}

impl PointMatch {
    /// A feature matched with a landmark, as certain as the landmark is; `None` if the landmark was removed.
    pub fn of_landmark(feature: usize, id: LandmarkId, map: &LandmarkMap) -> Option<Self> {
        let landmark = map.landmark(id)?;
        let (point, sigma_factor) = (landmark.position, landmark.sigma_factor());
        Some(Self { feature, point, landmark: Some(id), sigma_factor, aligned: None })
    }

    /// The observation of the feature, aligned if it is.
    pub fn observation(&self, frame: &Frame) -> PointObservation {
        let found = frame.observation(self.feature);
        let aligned = |Aligned { pixel, sigma, .. }| PointObservation { pixel, pixel_sigma: sigma, ..found };
        self.aligned.map_or(found, aligned)
    }
}
