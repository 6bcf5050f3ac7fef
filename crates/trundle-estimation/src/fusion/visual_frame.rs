//! Poses of the visual maps in the map frame.

use crate::{
    fusion::belief::{Belief, Measurement},
    fusion::config::LocalizerConfig,
    fusion::correction::{VisualPose, VisualQuality},
    planar::{planar_covariance, symmetric},
};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use trundle_core::{Pose2, Pose3};

/// The estimated `map_from_visual` of each visual map.
///
/// The first pose of a visual map anchors its frame, with the uncertainty of the base's pose at that stamp. Later visual poses refine the
/// anchor if other sources give the base's pose a smaller uncertainty. The anchor of the first visual map is certain: it defines the map's
/// frame.
#[derive(Debug, Clone)]
pub(crate) struct VisualFrame {
    base_from_camera: Pose3,
    /// Anchor of each visual map. A map that starts after tracking was lost has a separate frame.
    anchors: BTreeMap<u32, Anchor>,
    /// The visual map of the last pose.
    current: u32,
}

/// Pose of a visual map: `exp(e) * map_from_visual` with `e` in the floor's plane, of zero mean and this covariance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VisualAnchor {
    /// The visual map's frame in the map.
    pub map_from_visual: Pose3,
    /// Symmetric; x (m), y (m), theta (rad). With all 0 the anchor is certain and fixed.
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

impl Anchor {
    /// The anchor's covariance as that of a base pose in its map, right perturbation.
    fn covariance_at(&self, pose: &Pose2) -> Matrix3<f64> {
        let to_base = pose.inverse().adjoint();
        to_base * self.covariance * to_base.transpose()
    }
}

/// Ratio of the variances of base and anchor below which a visual pose refines the anchor. Above it both have a common error. Source: ours.
const MAX_VARIANCE_RATIO: f64 = 0.25;

impl VisualFrame {
    pub(crate) fn new(base_from_camera: Pose3) -> Self {
        Self { base_from_camera, anchors: BTreeMap::new(), current: 0 }
    }

    /// Replaces the anchors of all visual maps.
    pub(crate) fn set_anchors(&mut self, maps: BTreeMap<u32, VisualAnchor>) {
        let anchor = |VisualAnchor { map_from_visual, covariance }| Anchor {
            map_from_visual,
            covariance: covariance.into(),
        };
        self.anchors = maps.into_iter().map(|(map, stored)| (map, anchor(stored))).collect();
    }

    /// The anchor of every visual map, by its number.
    pub(crate) fn maps(&self) -> BTreeMap<u32, VisualAnchor> {
        let stored = |Anchor { map_from_visual, covariance }: &Anchor| VisualAnchor {
            map_from_visual: *map_from_visual,
            covariance: symmetric(*covariance).into(),
        };
        self.anchors.iter().map(|(map, anchor)| (*map, stored(anchor))).collect()
    }

    pub(crate) fn map_from_visual(&self) -> Option<Pose3> {
        Some(self.anchors.get(&self.current)?.map_from_visual)
    }

    /// The pose of the base by a visual pose; `None` before its frame is anchored.
    pub(crate) fn base(&self, visual: &VisualPose) -> Option<Pose2> {
        let map_from_visual = self.anchors.get(&visual.map)?.map_from_visual;
        Some((map_from_visual * visual.visual_from_camera * self.base_from_camera.inverse()).to_pose2())
    }

    /// Anchors the visual frame so that the visual pose agrees with the belief; gravity is along the base's z axis.
    pub(crate) fn anchor(&mut self, belief: &Belief, visual: &VisualPose) {
        let map_from_camera = Pose3::from_pose2(belief.pose) * self.base_from_camera;
        let map_from_visual = (map_from_camera * visual.visual_from_camera.inverse()).renormalized();
        let to_map = belief.pose.adjoint();
        let covariance = symmetric(to_map * belief.covariance() * to_map.transpose());
        self.current = visual.map;
        self.anchors.insert(visual.map, Anchor { map_from_visual, covariance });
    }

    /// The measurement of the base's pose by a visual pose; `None` before its frame is anchored.
    ///
    /// Noise is the sum of four covariances: that of the pose, the configured one (both larger for weak poses), that of the anchor, and the
    /// distance of the pose from the floor's plane. A visual map with a vertical error has a horizontal error of the same size.
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
        let anchor_covariance = anchor.covariance_at(&pose);
        let noise = (config.visual_noise() + own) * factor + out_of_plane(&map_from_base) + anchor_covariance;
        let (prior_inflation, scale_error) = (Matrix3::zeros(), Vector3::zeros());
        let variance_floor = (anchor_covariance + own).diagonal();
        Some(Measurement { pose, noise: symmetric(noise), prior_inflation, variance_floor, scale_error })
    }

    /// Refines the anchor by a measurement just accepted, if other sources give the base's pose a smaller uncertainty. The update of `e` is
    /// a Kalman update by the part of the innovation due to the anchor's uncertainty. Otherwise base and anchor have a common error, and
    /// the anchor does not change.
    pub(crate) fn refine(&mut self, before: &Belief, measurement: &Measurement) {
        let Some(anchor) = self.anchors.get_mut(&self.current) else { return };
        let anchor_variance = anchor.covariance_at(&measurement.pose).diagonal().xy().max();
        if before.position_variance() > MAX_VARIANCE_RATIO * anchor_variance || anchor_variance == 0.0 {
            return;
        }
        let (innovation, _) = before.innovation(measurement);
        let to_base = measurement.pose.inverse().adjoint();
        let Some(spread) = symmetric(before.covariance() + measurement.noise).cholesky() else { return };
        let gain = anchor.covariance * to_base.transpose() * spread.inverse();
        // An anchor with an error ahead gives measured poses the same error.
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
