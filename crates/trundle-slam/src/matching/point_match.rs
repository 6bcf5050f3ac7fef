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
    /// The landmark; `None` for a point that is a depth of an earlier frame.
    pub landmark: Option<LandmarkId>,
    /// Factor of the standard deviations for the point's own uncertainty.
    pub sigma_factor: f64,
    /// Position of the feature after alignment to a reference patch, if that fits.
    pub aligned: Option<Aligned>,
}

impl PointMatch {
    /// A feature matched with a landmark, with the landmark's uncertainty; `None` if the landmark was removed.
    pub fn of_landmark(feature: usize, id: LandmarkId, map: &LandmarkMap) -> Option<Self> {
        let landmark = map.landmark(id)?;
        let (point, sigma_factor) = (landmark.position, landmark.sigma_factor());
        Some(Self { feature, point, landmark: Some(id), sigma_factor, aligned: None })
    }

    /// The observation of the feature, at its aligned position if it has one.
    pub fn observation(&self, frame: &Frame) -> PointObservation {
        let found = frame.observation(self.feature);
        let aligned = |Aligned { pixel, sigma, .. }| PointObservation { pixel, pixel_sigma: sigma, ..found };
        self.aligned.map_or(found, aligned)
    }
}
