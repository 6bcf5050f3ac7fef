use crate::{
    LocalizerConfig, VisualPose, VisualQuality,
    belief::{Belief, Measurement},
    planar::{adjoint, planar_covariance, symmetric},
};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use trundle_core::{Pose2, Pose3};

/// Where the visual frames lie in the map: `map_from_visual` of each visual map, laid when a pose in it is first seen, and then
/// estimated: as uncertain as the place was by which it was laid, and surer with each visual pose once other sources know the
/// place better. The first one, laid when the map began, is certain: it makes the map's frame.
#[derive(Debug, Clone)]
pub(crate) struct VisualFrame {
    base_from_camera: Pose3,
    /// By visual map. A map that begins while another is lost has a frame of its own.
    anchors: BTreeMap<u32, Anchor>,
    /// The visual map of the last pose.
    current: u32,
}

/// Where a visual map lies: at `exp(e) * map_from_visual` with `e` in the floor's plane, of zero mean and this covariance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VisualAnchor {
    /// The visual map's frame in the map.
    pub map_from_visual: Pose3,
    /// Symmetric; x (m), y (m), theta (rad). All 0: certain, it is not moved any more.
    pub covariance: [[f64; 3]; 3],
}

impl VisualAnchor {
    /// Whether all numbers are finite and no variance is negative.
    pub fn is_valid(&self) -> bool {
        let numbers = || self.covariance.iter().flatten();
        let is_symmetric = (0..3).all(|i| (0..i).all(|j| self.covariance[i][j] == self.covariance[j][i]));
        self.map_from_visual.is_finite()
            && numbers().all(|n| n.is_finite())
            && is_symmetric
            && Matrix3::from(self.covariance).symmetric_eigenvalues().min() > -1e-9
    }
}

#[derive(Debug, Clone, Copy)]
struct Anchor {
    map_from_visual: Pose3,
    covariance: Matrix3<f64>,
}

/// The place is known better than a frame when its variance is so much smaller.
const SURER: f64 = 0.25;

impl VisualFrame {
    pub(crate) fn new(base_from_camera: Pose3) -> Self {
        Self { base_from_camera, anchors: BTreeMap::new(), current: 0 }
    }

    /// Takes over where visual maps lie.
    pub(crate) fn lay(&mut self, maps: BTreeMap<u32, VisualAnchor>) {
        let anchor = |VisualAnchor { map_from_visual, covariance }| Anchor {
            map_from_visual,
            covariance: covariance.into(),
        };
        self.anchors = maps.into_iter().map(|(map, laid)| (map, anchor(laid))).collect();
    }

    /// Where every visual map lies, by its number.
    pub(crate) fn maps(&self) -> BTreeMap<u32, VisualAnchor> {
        let laid = |Anchor { map_from_visual, covariance }: &Anchor| VisualAnchor {
            map_from_visual: *map_from_visual,
            covariance: symmetric(*covariance).into(),
        };
        self.anchors.iter().map(|(map, anchor)| (*map, laid(anchor))).collect()
    }

    pub(crate) fn map_from_visual(&self) -> Option<Pose3> {
        Some(self.anchors.get(&self.current)?.map_from_visual)
    }

    /// Lays the visual frame so that a visual pose agrees with where the base is believed to be: gravity is along the base's z
    /// axis.
    pub(crate) fn anchor(&mut self, belief: &Belief, visual: &VisualPose) {
        let map_from_camera = Pose3::from_pose2(belief.pose) * self.base_from_camera;
        let map_from_visual = (map_from_camera * visual.visual_from_camera.inverse()).renormalized();
        let to_map = adjoint(&belief.pose);
        let covariance = symmetric(to_map * belief.covariance * to_map.transpose());
        self.anchors.insert(visual.map, Anchor { map_from_visual, covariance });
    }

    /// What a visual pose says of the base; `None` before its frame is anchored.
    ///
    /// Its noise is its own covariance and the configured one, both for weak poses larger, that of its frame, and how far out of
    /// the floor's plane it lies: a visual map that errs by so much upward errs by so much sideways too.
    pub(crate) fn measurement(
        &mut self,
        visual: &VisualPose,
        config: &LocalizerConfig,
    ) -> Option<Measurement> {
        self.current = visual.map;
        let anchor = self.anchors.get(&visual.map)?;
        let camera_from_base = self.base_from_camera.inverse();
        let map_from_base = anchor.map_from_visual * visual.visual_from_camera * camera_from_base;
        let factor = match visual.quality {
            VisualQuality::Ok => 1.0,
            VisualQuality::Weak => config.weak_factor * config.weak_factor,
        };
        let own = planar_covariance(&visual.covariance, &self.base_from_camera);
        let pose = map_from_base.to_pose2();
        let to_base = adjoint(&pose.inverse());
        let of_frame = to_base * anchor.covariance * to_base.transpose();
        let noise = (config.visual_noise() + own) * factor + out_of_plane(&map_from_base) + of_frame;
        let (doubt, frame) = (Matrix3::zeros(), of_frame.diagonal());
        Some(Measurement { pose, noise: symmetric(noise), doubt, frame })
    }

    /// What a measurement that was just believed says of the frame it was made in, where other sources know the place better than
    /// the frame is known: the part of the innovation that the frame's uncertainty explains moves the frame, the Kalman update of
    /// `e`. Before that, place and frame err alike, and nothing is learnt.
    pub(crate) fn refine(&mut self, before: &Belief, measurement: &Measurement) {
        let Some(anchor) = self.anchors.get_mut(&self.current) else { return };
        let of_frame = measurement.frame.xy().max();
        if before.position_variance() > SURER * of_frame || of_frame == 0.0 {
            return;
        }
        let (innovation, _) = before.innovation(measurement);
        let to_base = adjoint(&measurement.pose.inverse());
        let Some(spread) = symmetric(before.covariance + measurement.noise).cholesky() else { return };
        let gain = anchor.covariance * to_base.transpose() * spread.inverse();
        // A frame that lies too far ahead shows the base too far ahead.
        let off = Pose2::exp(-(gain * innovation));
        anchor.map_from_visual = (Pose3::from_pose2(off) * anchor.map_from_visual).renormalized();
        anchor.covariance = symmetric(anchor.covariance - gain * to_base * anchor.covariance);
    }
}

fn out_of_plane(map_from_base: &Pose3) -> Matrix3<f64> {
    let height = map_from_base.translation.z;
    let tilt = map_from_base.rotate(Vector3::z()).xy().norm();
    Matrix3::from_diagonal(&Vector3::new(height * height, height * height, tilt * tilt))
}
