//! Features of the last image and closed loops, for views.

use super::run_view::{ClosedLoop, FeatureSpot, FeatureView, PerceptionView};
use super::{ImageFeed, VisualMapFeed};
use std::sync::Arc;
use trundle_core::{Pose2, Stamp};
use trundle_slam::{RgbdSlam, TrackReport};

/// Time between two copies of the features \[s\]. A copy of 1,000 features takes 5 us. Source: ours.
const FEATURES_PERIOD_S: f64 = 0.2;
/// Maximum number of closed loops in a view. Source: ours; a screen does not show more.
const MAX_LOOPS: usize = 20;

/// Keeps features of the last image and closed loops.
#[derive(Debug, Default)]
pub(crate) struct PerceptionFeed {
    features: Option<(Stamp, Arc<FeatureView>)>,
    loops: Vec<ClosedLoop>,
}

impl PerceptionFeed {
    /// Notes a loop that was closed, with `map_from_base` after it.
    pub(crate) fn note_loop(&mut self, track: &TrackReport, pose: Pose2) {
        if track.closed_loop.is_some() {
            self.loops.push(ClosedLoop { stamp: track.stamp, pose });
            let extra = self.loops.len().saturating_sub(MAX_LOOPS);
            self.loops.drain(..extra);
        }
    }

    /// Copies the features of an image that was tracked, if the last copy is old.
    pub(crate) fn update(&mut self, size_px: [usize; 2], track: &TrackReport, slam: &RgbdSlam) {
        if self.features.as_ref().is_some_and(|(copied, _)| track.stamp - *copied < FEATURES_PERIOD_S) {
            return;
        }
        let spots = slam.last_features().into_iter().map(|feature| FeatureSpot {
            at_px: [feature.keypoint.x.into(), feature.keypoint.y.into()],
            is_tracked: feature.tracked,
        });
        self.features = Some((track.stamp, Arc::new(FeatureView { size_px, features: spots.collect() })));
    }

    /// The newest features and loops, with the image, depth and visual map of their feeds; no dynamic obstacles and no station.
    pub(crate) fn view(&self, images: &ImageFeed, visual_map: &VisualMapFeed) -> PerceptionView {
        PerceptionView {
            image: images.image(),
            depth: images.depth(),
            visual_map: visual_map.newest(),
            features: self.features.as_ref().map(|(_, features)| Arc::clone(features)),
            loops: self.loops.clone(),
            ..PerceptionView::default()
        }
    }
}
