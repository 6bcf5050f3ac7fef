//! The pose of a frame: tracked from the last one, else relocalized in one of the maps.

use crate::atlas::map_collection::Atlas;
use crate::atlas::sub_map::SubMap;
use crate::config::SlamConfig;
use crate::frame::observation_model::ObservationModel;
use crate::frame::rgbd_frame::Frame;
use crate::ids::MapId;
use crate::map::odometry_factor::OdometryFactor;
use crate::matching::matched_pose::PosePriorKind;
use crate::place_recognition::bow::Bow;
use crate::place_recognition::place_hypothesis::{PlaceHypothesis, without_rival};
use crate::tracking::local_map::LocalMapQuery;
use crate::tracking::localized_frame::LocalizedFrame;
use crate::tracking::odometry_conflict::OdometryConflict;
use crate::tracking::pose_gate::PoseGate;
use crate::tracking::relocalisation::relocalize;
use crate::tracking::tracker::Tracker;
use crate::tracking::tracking_state::TrackingState;
use crate::tracking::tracking_status::Tracking;
use std::cell::OnceCell;
use trundle_core::{DepthImage, Pose3};

/// Number of successive frames that must give the same relocalisation without confirmation by odometry: 2. A single frame matched a
/// look-alike room in 0.7 of its view. Source: docs/experiments/slam-relocalisation.md.
const MIN_CONFIRMING_FRAMES: usize = 2;

/// A frame located in a map.
#[derive(Debug)]
pub(super) struct Localization {
    pub map: MapId,
    pub localized: LocalizedFrame,
}

/// Inputs of a frame's pose, besides the state of tracking.
#[derive(Debug, Clone, Copy)]
pub(super) struct Localizer<'a> {
    pub atlas: &'a Atlas,
    pub model: &'a ObservationModel,
    pub config: &'a SlamConfig,
    /// The motion since the newest keyframe of the active map.
    pub odometry: Option<OdometryFactor>,
    pub frame: &'a Frame,
    pub depth: &'a DepthImage,
    pub frame_number: u64,
    /// Whether the maps are fixed, so that only a match with the map corrects a pose.
    pub are_maps_fixed: bool,
}

/// Predicted pose, and the gate around it.
#[derive(Debug, Clone, Copy)]
struct Expectation {
    predicted: Pose3,
    gate: PoseGate,
}

impl Localizer<'_> {
    /// The pose of the frame by the last frame and the map; else by similar keyframes of that map; else by those of an inactive map, which
    /// take turns.
    pub fn localize(&self, state: &mut TrackingState, prior: Option<Pose3>) -> Option<Localization> {
        let stamp = self.frame.stamp;
        state.pending_relocalisations.record_frame(stamp, prior.is_some());
        let predicted = state.belief.predict(stamp, prior);
        let expected = Expectation { predicted, gate: state.gate(stamp, prior.is_some()) };
        let (bow, active) = (OnceCell::new(), &self.atlas.active);
        let tracker = self.tracker(active, &bow);
        if let Some(tracked) = track(&tracker, state, expected) {
            let localized = self.checked_by_map(state, &tracker, tracked, expected);
            let is_believed = state.odometry_conflict.accepts(stamp, localized.points_against_odometry());
            return is_believed.then_some(Localization { map: active.id, localized });
        }
        let found = relocalize(&tracker);
        state.odometry_conflict = OdometryConflict::default();
        if let Some(localized) = self.confirmed(state, active.id, found, expected) {
            let localized = localized.aligned(&tracker, PosePriorKind::Unknown);
            return Some(Localization { map: active.id, localized });
        }
        self.relocalize_elsewhere(state, &bow, expected)
    }

    /// The tracked frame, or a relocalisation if the tracked frame hardly agrees with a fixed map. Frames tracked from the last frame alone
    /// drift, and a fixed map is not extended to them. The count of relocalisations continues over weak frames.
    fn checked_by_map(
        &self,
        state: &mut TrackingState,
        tracker: &Tracker,
        tracked: LocalizedFrame,
        expected: Expectation,
    ) -> LocalizedFrame {
        if !self.are_maps_fixed || tracked.tracking(&self.config.tracking) == Tracking::Ok {
            state.pending_relocalisations = Default::default();
            return tracked;
        }
        let here = Expectation { predicted: tracked.pose(), ..expected };
        match self.confirmed(state, self.atlas.active.id, relocalize(tracker), here) {
            Some(found) if !tracked.by_map || found.points > tracked.points => {
                found.aligned(tracker, PosePriorKind::Unknown)
            }
            _ => tracked,
        }
    }

    /// The pose in one of the inactive maps, which take turns.
    fn relocalize_elsewhere(
        &self,
        state: &mut TrackingState,
        bow: &OnceCell<Bow>,
        expected: Expectation,
    ) -> Option<Localization> {
        let inactive = &self.atlas.inactive;
        let turn = self.frame_number as usize % inactive.len().max(1);
        let other = inactive.get(turn).filter(|_| expected.gate != PoseGate::Covariance)?;
        let tracker = self.tracker(other, bow);
        let anywhere = Expectation { gate: PoseGate::Open, ..expected };
        let localized = self.confirmed(state, other.id, relocalize(&tracker), anywhere)?;
        let localized = localized.aligned(&tracker, PosePriorKind::Unknown);
        Some(Localization { map: other.id, localized })
    }

    fn tracker<'a>(&'a self, sub_map: &'a SubMap, bow: &'a OnceCell<Bow>) -> Tracker<'a> {
        let is_active = sub_map.id == self.atlas.active.id;
        let (map, config) = (&sub_map.map, &self.config.tracking);
        let prior =
            |factor: OdometryFactor| Some(factor.prior(map.live_keyframe(factor.from)?.visual_from_camera));
        Tracker {
            map,
            place_index: &sub_map.place_index,
            model: self.model,
            local_map: LocalMapQuery::new(self.model, (self.depth, &self.config.depth), config),
            config,
            frame: self.frame,
            odometry_prior: self.odometry.filter(|_| is_active).and_then(prior),
            bow,
            seed: self.config.seed.wrapping_add(self.frame_number),
            is_map_fixed: self.are_maps_fixed,
        }
    }

    /// The confirmed relocalisation. Within the covariance gate one frame is enough; within the gate of a camera without odometry, two.
    /// After a brief gap a place within reach needs no large part of the view, since look-alike places are farther away.
    /// Outside the gate, `patience` successive frames must agree: odometry outweighs a look-alike room, but not a robot that was carried.
    /// Frames without a relocalisation do not reset the count.
    fn confirmed(
        &self,
        state: &mut TrackingState,
        map: MapId,
        mut found: Vec<LocalizedFrame>,
        Expectation { predicted, gate }: Expectation,
    ) -> Option<LocalizedFrame> {
        let covariance = state.belief.covariance;
        let is_near = |found: &LocalizedFrame| gate.allows(found.pose(), predicted, &covariance);
        if gate.is_brief() {
            found.iter_mut().filter(|found| is_near(found)).for_each(LocalizedFrame::accept_partial_view);
        }
        let needed = if found.iter().any(|found| found.is_certain && is_near(found)) {
            found.retain(is_near);
            if gate == PoseGate::Covariance { 1 } else { MIN_CONFIRMING_FRAMES }
        } else {
            // An uncertain near place makes a certain far one ambiguous.
            self.config.tracking.patience
        };
        let found = without_rival(found)?;
        let count = state.pending_relocalisations.record(map, (found.pose(), predicted));
        (count >= needed).then_some(())?;
        state.pending_relocalisations = Default::default();
        Some(found)
    }
}

/// The pose by the last frame, if within the gate.
fn track(
    tracker: &Tracker,
    state: &TrackingState,
    Expectation { predicted, gate }: Expectation,
) -> Option<LocalizedFrame> {
    let last = state.last.as_ref()?;
    let reference = last.anchored.reference.map(|id| tracker.map.resolve(id).0);
    let tracked = LocalizedFrame::from_last(tracker, last.as_reference(tracker.map), reference, predicted)?;
    gate.allows(tracked.pose(), predicted, &state.belief.covariance).then_some(tracked)
}
