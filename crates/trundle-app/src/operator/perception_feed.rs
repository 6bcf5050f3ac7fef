//! Features of the last image and closed loops, for views.

use super::run_view::{ClosedLoop, FeatureSpot, FeatureView};
use std::sync::Arc;
use trundle_core::Stamp;
use trundle_runtime::{Robot, StepReport};

/// Time between two copies of the features \[s\]. A copy of 1,000 features takes 5 us. Source: ours.
const FEATURES_PERIOD_S: f64 = 0.2;
/// Number of closed loops that are kept. Source: ours; more are not seen on a screen.
const MAX_LOOPS: usize = 20;

/// Keeps features of the last image and closed loops.
#[derive(Debug, Default)]
pub(super) struct PerceptionFeed {
    features: Option<(Stamp, Arc<FeatureView>)>,
    loops: Vec<ClosedLoop>,
}

impl PerceptionFeed {
    /// Notes a loop that was closed.
    pub(super) fn note_loop(&mut self, robot: &Robot, report: &StepReport) {
        let closed = report.track.as_ref().filter(|track| track.closed_loop.is_some());
        if let Some(track) = closed {
            self.loops.push(ClosedLoop { stamp: track.stamp, pose: robot.estimate().pose });
            let extra = self.loops.len().saturating_sub(MAX_LOOPS);
            self.loops.drain(..extra);
        }
    }

    /// Copies the features of an image that was tracked, if the last copy is old.
    pub(super) fn update(&mut self, size_px: [usize; 2], robot: &Robot, report: &StepReport) {
        let (Some(track), Some(slam)) = (&report.track, robot.slam()) else { return };
        if self.features.as_ref().is_some_and(|(copied, _)| track.stamp - *copied < FEATURES_PERIOD_S) {
            return;
        }
        let spots = slam.last_features().iter().map(|feature| FeatureSpot {
            at_px: [feature.keypoint.x.into(), feature.keypoint.y.into()],
            is_tracked: feature.tracked,
        });
        self.features = Some((track.stamp, Arc::new(FeatureView { size_px, features: spots.collect() })));
    }

    /// The newest features.
    pub(super) fn features(&self) -> Option<Arc<FeatureView>> {
        Some(Arc::clone(&self.features.as_ref()?.1))
    }

    /// The last closed loops.
    pub(super) fn loops(&self) -> &[ClosedLoop] {
        &self.loops
    }
}
