//! The fused trajectory of a sequence.

use super::frame::{MapPose, SequenceFrame};
use super::gap::Gap;
use super::map_layout::{MapLink, lay_out};
use super::odometry_path::OdometryPath;
use std::collections::BTreeMap;
use trundle_core::{CameraMotion, Pose3};

/// `world_from_camera` of each frame, m and rad; the world is the frame of the placed map with the lowest number. `None` for a frame that
/// measured motion does not connect with a placed map. Of groups of maps without odometry between them, the group with the largest number
/// of frames is placed.
///
/// A located frame keeps the exact pose in its map. The module describes the method.
pub fn fuse_frames(frames: &[SequenceFrame]) -> Vec<Option<Pose3>> {
    let maps = Maps::of(frames);
    let world_from_map = lay_out(&maps.counts(), &maps.links(frames));
    let place = |frame: &SequenceFrame| {
        let MapPose { map, map_from_camera } = frame.visual?;
        // Poses in the world's own map do not change.
        let world_from_map = world_from_map[maps.index(map)]?;
        let is_world = world_from_map == Pose3::identity();
        Some(if is_world { map_from_camera } else { (world_from_map * map_from_camera).renormalized() })
    };
    let mut poses: Vec<Option<Pose3>> = frames.iter().map(place).collect();
    fill_gaps(frames, &mut poses);
    poses
}

/// The maps of a sequence by rising number, with the number of frames in each.
struct Maps(BTreeMap<u32, usize>);

impl Maps {
    fn of(frames: &[SequenceFrame]) -> Self {
        let mut counts = BTreeMap::new();
        for visual in frames.iter().filter_map(|frame| frame.visual) {
            *counts.entry(visual.map).or_default() += 1;
        }
        Self(counts)
    }

    fn counts(&self) -> Vec<usize> {
        self.0.values().copied().collect()
    }

    fn index(&self, map: u32) -> usize {
        self.0.range(..map).count()
    }

    /// The odometry between the last frame in one map and the first in the next.
    fn links(&self, frames: &[SequenceFrame]) -> Vec<MapLink> {
        let located = frames.iter().enumerate().filter_map(|(i, frame)| Some((i, frame.visual?)));
        let located: Vec<(usize, MapPose)> = located.collect();
        let link = |pair: &[(usize, MapPose)]| {
            let [(i, left), (j, entered)] = *pair else { return None };
            if left.map == entered.map {
                return None;
            }
            let path = OdometryPath::over(frames[i + 1..=j].iter().map(|frame| frame.motion))?;
            let end = |pose: MapPose| (self.index(pose.map), pose.map_from_camera);
            MapLink::new(end(left), end(entered), &path)
        };
        located.windows(2).filter_map(link).collect()
    }
}

/// Places the frames that were not located, run by run.
fn fill_gaps(frames: &[SequenceFrame], poses: &mut [Option<Pose3>]) {
    let steps: Vec<Option<CameraMotion>> = frames.iter().map(|frame| frame.motion).collect();
    let mut start = 0;
    while let Some(first) = (start..poses.len()).find(|i| poses[*i].is_none()) {
        let end = (first..poses.len()).find(|i| poses[*i].is_some()).unwrap_or(poses.len());
        let gap = Gap {
            before: first.checked_sub(1).and_then(|before| poses[before]),
            after: poses.get(end).copied().flatten(),
            steps: &steps[first..(end + 1).min(steps.len())],
            frames: end - first,
        };
        poses[first..end].copy_from_slice(&gap.poses());
        start = end;
    }
}
