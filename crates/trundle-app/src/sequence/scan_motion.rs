//! The motion along frames that no image located, by scan matching.

use crate::laser_map::{DepthLog, depth_filter};
use std::ops::Range;
use trundle_core::{CameraMotion, Invalid, Pose2, Pose3, Scan, Stamp};
use trundle_estimation::{OdometryConfig, SequenceFrame};
use trundle_mapping::{MotionConfig, ParticleConfig, ParticleMapper, propagate_trajectory};
use trundle_runtime::LevelMap;

/// Number of obstacle points in a scan below which it is not matched. Source: ours.
const MIN_SCAN_HITS: usize = 30;
/// Length of a run of frames that no image located, below which wheels are more exact than scans \[m\]. Source: ours; a scan match is
/// 2 cm off, and wheels are that after 1 m (`distance_noise`).
const MIN_SCAN_PATH_M: f64 = 1.0;
/// Time between two scans up to which the later one is matched with the map of the earlier ones \[s\]. After a longer time another map
/// begins. Source: ours, five scans.
const MAX_SCAN_GAP_S: f64 = 1.0;
/// Variance of a motion by scans as a share of that by wheels \[1\]. Source: ours.
const SCAN_VARIANCE_SHARE: f64 = 0.1;

/// Scans of a sequence, and the robot that took them.
#[derive(Debug, Clone, Copy)]
pub(super) struct ScanMotion<'a> {
    pub(super) map: &'a LevelMap,
    pub(super) depth: &'a DepthLog,
    /// `base_from_camera` of a base under the camera, whose frame the scans are in.
    pub(super) base_from_camera: Pose3,
    pub(super) noise: &'a OdometryConfig,
    pub(super) seed: u64,
}

impl ScanMotion<'_> {
    /// Replaces the motion along each long run of frames that no image located by that of scan matches, where scans follow each other
    /// closely. `poses`: `level_from_camera` of the frames by images and wheels. Returns whether a motion was replaced.
    ///
    /// # Errors
    /// When the filter's settings are not valid.
    pub(super) fn replace_motions(
        &self,
        frames: &mut [SequenceFrame],
        poses: &[Option<Pose3>],
    ) -> Result<bool, Invalid> {
        let runs = long_runs(frames, poses);
        let camera_from_base = self.base_from_camera.inverse();
        let base = |(frame, pose): (&SequenceFrame, &Option<Pose3>)| {
            Some((frame.stamp, ((*pose)? * camera_from_base).to_pose2()))
        };
        let odometry: Vec<(Stamp, Pose2)> = frames.iter().zip(poses).filter_map(base).collect();
        let mut is_replaced = false;
        for series in self.scan_series(&odometry) {
            let (Some((first, _)), Some((last, _))) = (series.first(), series.last()) else { continue };
            let is_covered = |frame: &SequenceFrame| (*first..=*last).contains(&frame.stamp);
            if !runs.iter().any(|run| frames[run.clone()].iter().any(is_covered)) {
                continue;
            }
            let matched = propagate_trajectory(&self.mapped(&series)?, &odometry);
            let covered = matched.iter().filter(|(stamp, _)| (*first..=*last).contains(stamp));
            let matched: Vec<(Stamp, Pose2)> = covered.copied().collect();
            for run in &runs {
                is_replaced |= self.replace_in(&mut frames[run.clone()], &matched);
            }
        }
        Ok(is_replaced)
    }

    /// Frames with scans that can be matched, with their poses: series in which no two are farther apart in time than
    /// [`MAX_SCAN_GAP_S`].
    fn scan_series(&self, odometry: &[(Stamp, Pose2)]) -> Vec<Vec<(Stamp, Pose2)>> {
        let has_scan = |(stamp, _): &&(Stamp, Pose2)| self.scan(*stamp).is_some();
        let usable: Vec<(Stamp, Pose2)> = odometry.iter().filter(has_scan).copied().collect();
        let is_near = |(a, _): &(Stamp, Pose2), (b, _): &(Stamp, Pose2)| *b - *a <= MAX_SCAN_GAP_S;
        usable.chunk_by(is_near).map(<[_]>::to_vec).collect()
    }

    /// The filter's poses at the scans of a series that it processed.
    fn mapped(&self, series: &[(Stamp, Pose2)]) -> Result<Vec<(Stamp, Pose2)>, Invalid> {
        let config = depth_filter(self.depth, MotionConfig::default(), ParticleConfig::default());
        let mut mapper = ParticleMapper::new(config, self.seed)?;
        for (stamp, odom_from_base) in series {
            if let Some(scan) = self.scan(*stamp) {
                mapper.update(*odom_from_base, scan);
            }
        }
        mapper.finish();
        Ok(mapper.trajectory())
    }

    /// The scan of a frame, if there is one that can be matched.
    fn scan(&self, stamp: Stamp) -> Option<&Scan> {
        self.map.scan(stamp).filter(|scan| scan.hits().count() >= MIN_SCAN_HITS)
    }

    /// Replaces the motions to these frames by those between the poses of `matched`, where both ends have one. Returns whether there
    /// was one.
    fn replace_in(&self, frames: &mut [SequenceFrame], matched: &[(Stamp, Pose2)]) -> bool {
        let mut is_replaced = false;
        for frame in frames {
            let at = matched.partition_point(|(stamp, _)| *stamp < frame.stamp);
            let [before, after] = [at.checked_sub(1), Some(at)].map(|i| i.and_then(|i| matched.get(i)));
            if let (Some((_, before)), Some((_, after))) =
                (before, after.filter(|pose| pose.0 == frame.stamp))
            {
                let motion = before.inverse() * *after;
                let noise = self.noise.by_wheels(&motion) * SCAN_VARIANCE_SHARE;
                frame.motion = Some(CameraMotion::of_base((motion, noise), self.base_from_camera));
                is_replaced = true;
            }
        }
        is_replaced
    }
}

/// Runs of frames that no image located, each with the frame after it, along a long path.
fn long_runs(frames: &[SequenceFrame], poses: &[Option<Pose3>]) -> Vec<Range<usize>> {
    let is_open = |i: &usize| frames[*i].visual.is_none() && poses[*i].is_some();
    let mut runs = Vec::new();
    let mut start = 0;
    while let Some(first) = (start..frames.len()).find(is_open) {
        let end = (first..frames.len()).find(|i| !is_open(i)).unwrap_or(frames.len());
        let run = first..(end + 1).min(frames.len());
        if path_length(&frames[run.clone()]) >= MIN_SCAN_PATH_M {
            runs.push(run);
        }
        start = end;
    }
    runs
}

/// Length of the path along these frames by their motions, m.
fn path_length(frames: &[SequenceFrame]) -> f64 {
    frames.iter().filter_map(|frame| frame.motion).map(|motion| motion.motion.translation.norm()).sum()
}
