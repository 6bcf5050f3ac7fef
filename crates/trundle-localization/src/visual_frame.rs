use crate::{LocalizerConfig, VisualPose, VisualQuality, belief::Measurement, planar::planar_covariance};
use nalgebra::{Matrix3, Vector3};
use std::collections::BTreeMap;
use trundle_core::{Pose2, Pose3};

/// Where the visual frames lie in the map: `map_from_visual` of each visual map, set when a pose in it is first seen and
/// then kept.
#[derive(Debug, Clone)]
pub(crate) struct VisualFrame {
    base_from_camera: Pose3,
    /// By visual map. A map that begins while another is lost has a frame of its own.
    anchors: BTreeMap<u32, Pose3>,
    /// The visual map of the last pose.
    current: u32,
}

impl VisualFrame {
    pub(crate) fn new(base_from_camera: Pose3) -> Self {
        Self { base_from_camera, anchors: BTreeMap::new(), current: 0 }
    }

    pub(crate) fn map_from_visual(&self) -> Option<Pose3> {
        self.anchors.get(&self.current).copied()
    }

    /// Lays the visual frame so that a visual pose agrees with `map_from_base`: gravity is along the base's z axis.
    pub(crate) fn anchor(&mut self, map_from_base: Pose2, visual: &VisualPose) {
        let map_from_camera = Pose3::from_pose2(map_from_base) * self.base_from_camera;
        let map_from_visual = (map_from_camera * visual.visual_from_camera.inverse()).renormalized();
        self.anchors.insert(visual.map, map_from_visual);
    }

    /// What a visual pose says of the base; `None` before its frame is anchored.
    ///
    /// Its noise is its own covariance and the configured one, both for weak poses larger, and how far out of the floor's
    /// plane it lies: a visual map that errs by so much upward errs by so much sideways too.
    pub(crate) fn measurement(
        &mut self,
        visual: &VisualPose,
        config: &LocalizerConfig,
    ) -> Option<Measurement> {
        self.current = visual.map;
        let camera_from_base = self.base_from_camera.inverse();
        let map_from_base = self.map_from_visual()? * visual.visual_from_camera * camera_from_base;
        let factor = match visual.quality {
            VisualQuality::Ok => 1.0,
            VisualQuality::Weak => config.weak_factor * config.weak_factor,
        };
        let own = planar_covariance(&visual.covariance, &self.base_from_camera);
        let noise = (config.visual_noise() + own) * factor + out_of_plane(&map_from_base);
        Some(Measurement { pose: map_from_base.to_pose2(), noise, doubt: Matrix3::zeros() })
    }
}

fn out_of_plane(map_from_base: &Pose3) -> Matrix3<f64> {
    let height = map_from_base.translation.z;
    let tilt = map_from_base.rotate(Vector3::z()).xy().norm();
    Matrix3::from_diagonal(&Vector3::new(height * height, height * height, tilt * tilt))
}
