//! The trajectory of a tracked sequence: of all frames by images and odometry, or of the images' active map alone.

use super::scan_motion::ScanMotion;
use trundle_core::{CameraMotion, Invalid, Pose3, Stamp};
use trundle_estimation::{MapPose, SequenceFrame, fuse_frames};
use trundle_slam::{FramePose, RgbdSlam};

/// Share of the frames without a pose \[1\]. Above it the run missed its goal or a limit. Source: ours.
const MAX_MISSING_SHARE: f64 = 0.1;
/// Number of the map whose frame is level, with the first camera at its given pose: the first map of a tracker. Source: `trundle-slam`
/// numbers maps from 0.
const LEVEL_MAP: u32 = 0;

/// Poses of the frames of a sequence, `level_from_camera`.
#[derive(Debug, Clone, Default)]
pub struct SequenceTrajectory {
    /// Poses by rising stamps.
    pub poses: Vec<(Stamp, Pose3)>,
    /// Number of frames that were tracked.
    pub frames: usize,
    /// Number of frames whose pose an image gives.
    pub located: usize,
    /// Number of frames with a pose that odometry alone gives.
    pub by_odometry: usize,
    /// Pose of the tracker's active map in the frame of the poses.
    pub level_from_visual: Pose3,
    /// Whether odometry places the frames that no image located.
    pub is_fused: bool,
}

impl SequenceTrajectory {
    /// The frames of the tracker's active map.
    pub(super) fn visual(slam: &RgbdSlam) -> Self {
        let frames = slam.frames();
        Self {
            poses: slam.trajectory(),
            frames: frames.len(),
            located: count_located(&frames),
            by_odometry: 0,
            level_from_visual: Pose3::identity(),
            is_fused: false,
        }
    }

    /// All frames that images or odometry place. `motions`: to each frame from the one before; `start`: pose of the first camera.
    ///
    /// # Errors
    /// When the settings of the scan matching are not valid.
    pub(super) fn fused(
        slam: &RgbdSlam,
        motions: &[Option<CameraMotion>],
        start: Pose3,
        scans: Option<&ScanMotion<'_>>,
    ) -> Result<Self, Invalid> {
        let frames = slam.frames();
        let mut sequence = sequence_frames(&frames, motions, start);
        let mut poses = fuse_frames(&sequence);
        if let Some(scans) = scans
            && scans.replace_motions(&mut sequence, &poses)?
        {
            poses = fuse_frames(&sequence);
        }
        let level_from_visual = map_pose(&frames, &poses);
        let is_by_odometry = |(frame, pose): &(&FramePose, &Option<Pose3>)| {
            pose.is_some() && frame.visual_from_camera.is_none()
        };
        let by_odometry = frames.iter().zip(&poses).filter(is_by_odometry).count();
        let poses =
            sequence.iter().zip(poses).filter_map(|(frame, pose)| Some((frame.stamp, pose?))).collect();
        let (frames, located) = (frames.len(), count_located(&frames));
        Ok(Self { poses, frames, located, by_odometry, level_from_visual, is_fused: true })
    }

    /// The poses of the frames that an image located, each in the frame of its map.
    pub(super) fn located(slam: &RgbdSlam) -> Vec<(Stamp, Pose3)> {
        slam.frames().iter().filter_map(|frame| Some((frame.stamp, frame.visual_from_camera?))).collect()
    }

    /// Number of frames without a pose.
    #[must_use]
    pub fn missing(&self) -> usize {
        self.frames.saturating_sub(self.poses.len())
    }

    /// Number of frames with a pose that rests on their own image.
    #[must_use]
    pub fn by_images(&self) -> usize {
        self.poses.len().saturating_sub(self.by_odometry)
    }

    /// Share of the frames without a pose \[1\].
    #[must_use]
    pub fn missing_share(&self) -> f64 {
        self.missing() as f64 / self.frames.max(1) as f64
    }

    /// Reason why too few frames have a pose; `None` if enough have.
    pub(super) fn failure(&self) -> Option<String> {
        let (missing, frames) = (self.missing(), self.frames);
        (self.missing_share() > MAX_MISSING_SHARE).then(|| {
            let cause = if self.is_fused {
                "no image located them, and the odometry has gaps"
            } else {
                "no image located them in the last map, and no odometry places them"
            };
            format!("{missing} of {frames} frames have no pose, expected at most a tenth: {cause}")
        })
    }
}

/// `level_from_visual` of the map of the last frame; the identity where no frame of that map is located and has a pose.
fn map_pose(frames: &[FramePose], poses: &[Option<Pose3>]) -> Pose3 {
    let active = frames.last().map(|frame| frame.map);
    let in_active = |(frame, pose): (&FramePose, &Option<Pose3>)| {
        let visual_from_camera = frame.visual_from_camera.filter(|_| Some(frame.map) == active)?;
        Some(((*pose)? * visual_from_camera.inverse()).renormalized())
    };
    frames.iter().zip(poses).rev().find_map(in_active).unwrap_or_default()
}

fn count_located(frames: &[FramePose]) -> usize {
    frames.iter().filter(|frame| frame.visual_from_camera.is_some()).count()
}

/// The tracker's frames with their odometry. If no frame is in the level map, `start` is the pose of the first camera in it.
fn sequence_frames(
    frames: &[FramePose],
    motions: &[Option<CameraMotion>],
    start: Pose3,
) -> Vec<SequenceFrame> {
    let visual = |frame: &FramePose| {
        let map_from_camera = frame.visual_from_camera?;
        Some(MapPose { map: frame.map.number(), map_from_camera })
    };
    let frame = |(frame, motion): (&FramePose, &Option<CameraMotion>)| SequenceFrame {
        stamp: frame.stamp,
        visual: visual(frame),
        motion: *motion,
    };
    let mut sequence: Vec<SequenceFrame> = frames.iter().zip(motions).map(frame).collect();
    let is_level = |frame: &SequenceFrame| frame.visual.is_some_and(|pose| pose.map == LEVEL_MAP);
    if !sequence.iter().any(is_level)
        && let Some(first) = sequence.first_mut()
    {
        first.visual = Some(MapPose { map: LEVEL_MAP, map_from_camera: start });
    }
    sequence
}
