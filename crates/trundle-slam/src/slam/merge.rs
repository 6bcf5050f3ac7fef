use super::RgbdSlam;
use crate::claim::Claim;
use crate::closing::{Recognised, Verifier};
use crate::component::{Component, Renamed};
use crate::ids::KeyframeId;
use crate::local_bundle::{BundleSize, refine_around};
use crate::map::LandmarkMap;
use crate::places::SHARED;
use crate::report::{MapId, MapMerge};
use crate::trajectory::Anchored;
use trundle_core::Pose3;

/// Keyframes that the bundle adjustment along the seam moves.
const REFINED: usize = 40;

impl RgbdSlam {
    /// Makes one map of the active one and another one that its newest keyframe shows, once enough keyframes in a row show
    /// it at the same place. The older map keeps its frame \[Campos21, sec. VI-B\].
    pub(super) fn merge_maps(&mut self, keyframe: KeyframeId) -> Option<MapMerge> {
        let said_before = self.recognition.take();
        let (other, found) = self.recognise_another(keyframe)?;
        let here = self.active.map.keyframe(keyframe).visual_from_camera;
        let other_from_active = found.visual_from_camera * here.inverse();
        let pair = (self.resting[other].id, self.active.id);
        if self.begun.is_some_and(|begun| !begun.allows(pair, other_from_active, &self.config.loops)) {
            return None;
        }
        self.recognition = said_before;
        let poses = (found.visual_from_camera, here);
        let times = Claim::note(&mut self.recognition, self.resting[other].id, poses, 0.0);
        if times < self.config.loops.consistency {
            return None;
        }
        self.recognition = None;
        let merged = self.join(other, keyframe, found, other_from_active);
        Some(MapMerge {
            correction: self.active.map.keyframe(merged.keyframe).visual_from_camera * here.inverse(),
            ..merged
        })
    }

    /// The first of the other maps that the keyframe shows, by its place among them.
    fn recognise_another(&self, keyframe: KeyframeId) -> Option<(usize, Recognised)> {
        let own = self.active.places.worded(&self.active.map, keyframe)?;
        let recognise = |other: &Component| {
            let Component { map, places, .. } = other;
            let candidates = places.alike(map, own.words, |_| true, self.config.loops.candidates);
            let (config, tracking) = (&self.config.loops, &self.config.tracking);
            let verifier =
                Verifier { map, places, sensor: &self.sensor, tracking, config, seed: self.seed() };
            verifier.recognise(own, &candidates)
        };
        self.resting.iter().enumerate().find_map(|(i, other)| Some((i, recognise(other)?)))
    }

    /// Takes the newer of two maps over into the older one; that is then the active map.
    fn join(
        &mut self,
        other: usize,
        keyframe: KeyframeId,
        mut found: Recognised,
        other_from_active: Pose3,
    ) -> MapMerge {
        self.forget_the_way();
        let other = self.resting.remove(other);
        let is_older = other.id < self.active.id;
        let seam = |map: &LandmarkMap, id: KeyframeId| map.keyframe(id).covariance;
        let seam = seam(&other.map, found.candidate) + seam(&self.active.map, keyframe);
        let (absorbed, moved) = if is_older {
            (std::mem::replace(&mut self.active, other), other_from_active)
        } else {
            (other, other_from_active.inverse())
        };
        let renamed = self.active.absorb(&absorbed.map, moved, seam);
        self.rename_history(&absorbed, &renamed, moved);
        let keyframe = if is_older { renamed.keyframes[&keyframe] } else { keyframe };
        if !is_older {
            found.candidate = renamed.keyframes[&found.candidate];
            found.landmarks.iter_mut().for_each(|id| *id = renamed.landmarks[id]);
        }
        self.active.map.tie(found.candidate, keyframe);
        self.fuse(keyframe, &found);
        let (from, into) = (absorbed.id, self.active.id);
        MapMerge { from, into, keyframe, points: found.points, correction: Pose3::identity() }
    }

    /// Makes one of the landmarks that are there twice now, and refines what is around.
    fn fuse(&mut self, keyframe: KeyframeId, found: &Recognised) {
        let around = self.active.map.covisible(keyframe, SHARED).into_iter().map(|(id, _)| id);
        let targets: Vec<KeyframeId> =
            [keyframe].into_iter().chain(around.take(self.config.mapping.fused_keyframes)).collect();
        let mapper = Self::mapper(&self.sensor, &self.config);
        for target in targets {
            mapper.fuse_into(&mut self.active.map, target, &found.landmarks);
        }
        let size = BundleSize { local: REFINED, fixed: REFINED };
        refine_around(&mut self.active.map, keyframe, &self.sensor, size, &self.config.mapping.bundle);
        self.active.follow();
    }

    /// The frames that were located in a map go on in the one that took it over.
    fn rename_history(&mut self, absorbed: &Component, renamed: &Renamed, moved: Pose3) {
        let (from, into): (MapId, MapId) = (absorbed.id, self.active.id);
        for past in self.history.iter_mut().filter(|past| past.map == from) {
            let Anchored { stamp, reference, reference_from_camera } = past.anchored;
            let heir = reference.map(|id| absorbed.map.resolve(id));
            past.map = into;
            past.anchored = match heir {
                Some((heir, heir_from_reference)) => Anchored {
                    stamp,
                    reference: Some(renamed.keyframes[&heir]),
                    reference_from_camera: heir_from_reference * reference_from_camera,
                },
                None => Anchored { reference_from_camera: moved * reference_from_camera, ..past.anchored },
            };
        }
    }
}
