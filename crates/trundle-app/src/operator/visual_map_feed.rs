//! Copies the visual map for views, from time to time.

use super::run_view::VisualMapView;
use std::sync::Arc;
use trundle_core::{Pose2, Pose3, Stamp, Vector3};
use trundle_slam::RgbdSlam;

/// Time between two copies of the visual map \[s\]. A copy of 6,000 landmarks takes 0.1 ms. Source: ours.
pub const VISUAL_MAP_PERIOD_S: f64 = 3.0;
/// Largest number of landmarks of a copy. Of more landmarks, every second or third one is copied. Source: ours.
const MAX_LANDMARKS: usize = 6000;

/// Copies the visual map for views.
#[derive(Debug, Default)]
pub(crate) struct VisualMapFeed {
    newest: Option<(Stamp, Arc<VisualMapView>)>,
}

impl VisualMapFeed {
    /// Copies the visual map if the last copy is old. While a perception job runs the map is unavailable, and the view has the last copy.
    pub(crate) fn update(&mut self, now: Stamp, slam: Option<&RgbdSlam>, map_from_visual: Option<Pose3>) {
        if self.newest.as_ref().is_some_and(|(copied, _)| now - *copied < VISUAL_MAP_PERIOD_S) {
            return;
        }
        let (Some(slam), Some(map_from_visual)) = (slam, map_from_visual) else { return };
        let stride = slam.landmarks().count().div_ceil(MAX_LANDMARKS).max(1);
        let landmarks = slam.landmarks().step_by(stride).map(|at| map_from_visual.transform(at)).collect();
        let keyframes = slam.keyframes().map(|(_, _, pose)| on_floor(&(map_from_visual * pose))).collect();
        self.newest = Some((now, Arc::new(VisualMapView { keyframes, landmarks })));
    }

    /// The newest copy.
    pub(crate) fn newest(&self) -> Option<Arc<VisualMapView>> {
        Some(Arc::clone(&self.newest.as_ref()?.1))
    }
}

/// A camera's pose on the floor, its heading that of the optical axis.
pub(crate) fn on_floor(map_from_camera: &Pose3) -> Pose2 {
    let axis = map_from_camera.rotate(Vector3::z());
    let at = map_from_camera.translation;
    Pose2::new(at.x, at.y, axis.y.atan2(axis.x))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_camera_that_looks_along_x_has_heading_zero() {
        // Columns: right is -y, down is -z, the optical axis is x.
        let forward = nalgebra::Matrix3::new(0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0);
        let pose = on_floor(&Pose3::from_matrix(forward, Vector3::new(1.0, 2.0, 0.5)));
        assert!(pose.distance(&Pose2::new(1.0, 2.0, 0.0)) < 1e-12 && pose.theta.abs() < 1e-6, "{pose:?}");
    }
}
