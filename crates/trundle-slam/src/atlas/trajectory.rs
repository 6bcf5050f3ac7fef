//! The poses of past frames, which follow corrections of the map.

use crate::atlas::map_collection::Atlas;
use crate::atlas::sub_map::{IdMap, SubMap};
use crate::ids::MapId;
use crate::map::anchored_pose::AnchoredPose;
use crate::report::FramePose;
use crate::tracking::tracking_status::Tracking;
use std::collections::VecDeque;
use trundle_core::{Pose3, Stamp};

/// The pose of a past frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FrameRecord {
    pub anchored: AnchoredPose,
    pub map: MapId,
    pub tracking: Tracking,
}

/// The newest frames, the last one at the back.
#[derive(Debug)]
pub(crate) struct Trajectory {
    records: VecDeque<FrameRecord>,
    /// Maximum number of records.
    capacity: usize,
    /// Number of all frames recorded, including dropped ones.
    frame_count: u64,
}

impl Trajectory {
    pub fn new(capacity: usize) -> Self {
        Self { records: VecDeque::new(), capacity, frame_count: 0 }
    }

    pub fn record(&mut self, record: FrameRecord) {
        if self.records.len() == self.capacity {
            self.records.pop_front();
        }
        self.records.push_back(record);
        self.frame_count += 1;
    }

    pub fn last(&self) -> Option<&FrameRecord> {
        self.records.back()
    }

    pub fn frame_count(&self) -> u64 {
        self.frame_count
    }

    /// Seed of the random samples drawn for the next frame.
    pub fn seed(&self, seed: u64) -> u64 {
        seed.wrapping_add(self.frame_count)
    }

    /// `visual_from_camera` of every located or dead-reckoned frame of the active map, by the present map.
    pub fn poses(&self, active: &SubMap) -> Vec<(Stamp, Pose3)> {
        let is_in_map = |record: &&FrameRecord| record.map == active.id && record.tracking != Tracking::Lost;
        let pose =
            |record: &FrameRecord| (record.anchored.stamp, record.anchored.visual_from_camera(&active.map));
        self.records.iter().filter(is_in_map).map(pose).collect()
    }

    /// Every frame by the present maps.
    pub fn frames(&self, atlas: &Atlas) -> Vec<FramePose> {
        let maps = atlas.maps();
        let pose = |record: &FrameRecord| {
            let located = record.tracking.is_located();
            let map = maps.iter().find(|sub_map| sub_map.id == record.map);
            let in_map = map.map(|sub_map| record.anchored.visual_from_camera(&sub_map.map));
            let visual_from_camera = in_map.or(record.anchored.fixed_pose()).filter(|_| located);
            FramePose { stamp: record.anchored.stamp, map: record.map, visual_from_camera }
        };
        self.records.iter().map(pose).collect()
    }

    /// Fixes the poses of a dropped map's frames.
    pub fn fix_poses(&mut self, dropped: &SubMap) {
        for record in self.records.iter_mut().filter(|record| record.map == dropped.id) {
            let reference_from_camera = record.anchored.visual_from_camera(&dropped.map);
            record.anchored = AnchoredPose { reference: None, reference_from_camera, ..record.anchored };
        }
    }

    /// Drops all records but the last one and those `wanted`.
    pub fn retain(&mut self, wanted: impl Fn(Stamp) -> bool) {
        let last = self.records.back().map(|record| record.anchored.stamp);
        self.records.retain(|record| Some(record.anchored.stamp) == last || wanted(record.anchored.stamp));
    }

    /// Moves the frames of an absorbed map into map `into`: `ids` are the new ids, and the pose is that of the absorbed map.
    pub fn move_into(&mut self, into: MapId, absorbed: &SubMap, ids: &IdMap, into_from_absorbed: Pose3) {
        for record in self.records.iter_mut().filter(|record| record.map == absorbed.id) {
            let AnchoredPose { stamp, reference, reference_from_camera } = record.anchored;
            record.map = into;
            record.anchored = match reference.map(|id| absorbed.map.resolve(id)) {
                Some((successor, successor_from_reference)) => AnchoredPose {
                    stamp,
                    reference: Some(ids.keyframes[&successor]),
                    reference_from_camera: successor_from_reference * reference_from_camera,
                },
                None => AnchoredPose {
                    reference_from_camera: into_from_absorbed * reference_from_camera,
                    ..record.anchored
                },
            };
        }
    }
}
