use crate::ids::{KeyframeId, LandmarkId};
use crate::map::LandmarkMap;
use crate::map_bundle::MapBundle;
use crate::motion::carried;
use crate::sensor::Sensor;
use std::collections::BTreeMap;
use trundle_core::{Pose3, Vector3};
use trundle_optim::BundleConfig;

/// Landmarks that two keyframes must share to hold each other in place \[MurArtal17\].
const SHARED: u16 = 15;
/// Units of work of taking up one observation.
const WORK_GATHER: usize = 5;

/// Bundle adjustment of the whole map, in slices between frames \[MurArtal17, sec. III-D\].
///
/// Landmarks are taken up slice by slice, then the solver runs slice by slice, then all is moved at once; keyframes and
/// landmarks that came meanwhile go along with their parent in the spanning tree, and with the keyframe that saw them
/// first. At the end the covariances of all keyframes are worked out: with all that ties them together, each landmark
/// counted once.
#[derive(Debug, Clone, Default)]
pub(crate) struct GlobalBundle {
    bundle: MapBundle,
    /// The next landmark to take up, by index; `None` once the solver runs.
    next: Option<usize>,
    /// Landmarks that each two keyframes share, by their places.
    shared: BTreeMap<(usize, usize), u16>,
    /// The place of the keyframe that holds each one's part of the map in place.
    holds: Vec<usize>,
}

impl GlobalBundle {
    pub fn of(map: &LandmarkMap) -> Self {
        let bundle = MapBundle::of(map, map.keyframe_ids().map(|id| (id, true)));
        Self { bundle, next: Some(0), ..Self::default() }
    }

    /// Goes on for about `work` units; whether it is done.
    pub fn advance(
        &mut self,
        map: &LandmarkMap,
        sensor: &Sensor,
        config: &BundleConfig,
        work: usize,
    ) -> bool {
        let Some(next) = self.next else { return self.bundle.advance(work) };
        let (bound, mut left, mut index) = (map.landmark_bound(), work, next);
        while index < bound && left > 0 {
            let seen = self.bundle.add(map, LandmarkId::from_index(index), sensor);
            if seen > 0 {
                self.count_shared();
            }
            left = left.saturating_sub(WORK_GATHER * seen + 1);
            index += 1;
        }
        self.next = Some(index).filter(|index| *index < bound);
        if self.next.is_none() {
            self.hold();
            self.bundle.begin(sensor, config);
        }
        false
    }

    fn count_shared(&mut self) {
        let seers: Vec<usize> = self.bundle.newest_seers().collect();
        for (i, a) in seers.iter().enumerate() {
            for b in &seers[i + 1..] {
                *self.shared.entry((*a.min(b), *a.max(b))).or_insert(0) += 1;
            }
        }
    }

    /// The oldest keyframe holds still, of every part of the map that shares too little with the rest.
    fn hold(&mut self) {
        self.holds = (0..self.bundle.keyframes().count()).collect();
        let find = |holds: &[usize], mut i: usize| {
            while holds[i] != i {
                i = holds[i];
            }
            i
        };
        for ((a, b), _) in self.shared.iter().filter(|(_, count)| **count >= SHARED) {
            let (a, b) = (find(&self.holds, *a), find(&self.holds, *b));
            self.holds[a.max(b)] = a.min(b);
        }
        self.holds = (0..self.holds.len()).map(|i| find(&self.holds, i)).collect();
        let holds = &self.holds;
        self.bundle.fix(|i| holds[i] == i);
    }

    /// Takes the result over.
    pub fn apply(&self, map: &mut LandmarkMap) {
        let moved = self.corrections(map);
        let others = self.other_landmarks(map, &moved);
        self.bundle.move_landmarks(map);
        for (id, position) in others {
            if let Some(landmark) = map.landmark_mut(id) {
                landmark.position = position;
            }
        }
        for (id, correction) in &moved {
            let pose = *correction * map.keyframe(*id).visual_from_camera;
            map.move_keyframe(*id, pose.renormalized());
        }
        self.bundle.take_back(map);
        self.set_covariances(map);
    }

    /// How each keyframe of the map moves; a newer one as its parent does.
    fn corrections(&self, map: &LandmarkMap) -> BTreeMap<KeyframeId, Pose3> {
        let mut moved: BTreeMap<KeyframeId, Pose3> = BTreeMap::new();
        for (id, keyframe) in map.keyframes() {
            // Parents are older than their children, except where a forgotten one was between.
            let by_parent = || {
                let mut parent = keyframe.tree.parent;
                while let Some(id) = parent {
                    if let Some(known) = self.bundle.correction(id) {
                        return known;
                    }
                    parent = map.keyframe(id).tree.parent;
                }
                Pose3::identity()
            };
            moved.insert(id, self.bundle.correction(id).unwrap_or_else(by_parent));
        }
        moved
    }

    /// Where the landmarks go that are not in the bundle.
    fn other_landmarks(
        &self,
        map: &LandmarkMap,
        moved: &BTreeMap<KeyframeId, Pose3>,
    ) -> Vec<(LandmarkId, Vector3)> {
        let others = map.landmarks().filter(|(id, _)| !self.bundle.has(*id));
        others
            .filter_map(|(id, landmark)| {
                let (first, _) = landmark.observations.iter().min()?;
                Some((id, moved.get(first)?.transform(landmark.position)))
            })
            .collect()
    }

    fn set_covariances(&self, map: &mut LandmarkMap) {
        let factor = self.bundle.variance_factor();
        let keyframes: Vec<KeyframeId> = self.bundle.keyframes().map(|(id, _)| id).collect();
        for (place, id) in keyframes.iter().enumerate().filter(|(place, _)| self.holds[*place] != *place) {
            let Some((whole, ground)) = self.bundle.covariances(place) else { continue };
            let Some(holding) = map.live_keyframe(keyframes[self.holds[place]]) else { continue };
            let Some(keyframe) = map.live_keyframe(*id) else { continue };
            let offset = holding.visual_from_camera.inverse() * keyframe.visual_from_camera;
            let held = carried(&holding.covariance, offset);
            map.set_covariances(*id, held + whole * factor, held + ground * factor);
        }
    }
}
