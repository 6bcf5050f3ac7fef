use super::{Located, RgbdSlam, begun::Begun, doubts::Doubts};
use crate::component::Component;
use crate::frame::Frame;
use crate::ids::KeyframeId;
use crate::keyframe_policy::with_depth;
use crate::map::LandmarkMap;
use crate::motion::Belief;
use crate::report::{MapId, Mode, TrackReport, Tracking};
use crate::search::Likeness;
use nalgebra::Matrix6;
use std::sync::Arc;
use trundle_core::{CameraMotion, DepthImage, Pose3};
use trundle_vision::match_mutual;

/// Keyframes of a map that is worth keeping when the camera is lost in it.
const LEAST_KEYFRAMES: usize = 4;

/// What a frame that was not located can begin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Beginning {
    /// Nothing: better wait to see a known landmark again.
    None,
    /// The first keyframe of the map.
    First,
    /// A keyframe where the camera is believed to be.
    Onward,
    /// Another map, since nobody knows where in this one the camera is.
    Another,
}

/// After a way in the dark that is less certain (one sigma, m and rad) another map begins: in this one all that comes after would
/// be off by as much, and off alike, while whoever has other senses may know the place better and lays the new one there.
const ASTRAY: (f64, f64) = (0.2, 0.2);

/// So many features, or landmarks, are much.
const MUCH: usize = 200;
/// Frames less apart follow each other without a gap, s.
const AT_A_STRETCH: f64 = 0.5;

impl RgbdSlam {
    /// Goes on without a found pose; begins a map at the believed pose where there is none to be found again.
    pub(super) fn miss(
        &mut self,
        frame: Frame,
        depth: &DepthImage,
        prior: Option<CameraMotion>,
    ) -> TrackReport {
        self.belief.missed(frame.stamp, prior, &self.config.motion);
        self.misses += 1;
        self.blind |= prior.is_none();
        self.torn |= self.is_torn(&frame, depth);
        self.show(&frame, &vec![None; frame.len()]);
        let begins = self.beginning(&frame, depth, prior);
        if begins == Beginning::Another {
            self.begin_map();
        }
        let reference = (begins != Beginning::None).then(|| self.begin(&frame, begins));
        let tracking = match begins {
            Beginning::First | Beginning::Another => Tracking::Ok,
            _ if prior.is_some() && self.placed => Tracking::DeadReckoning,
            _ => Tracking::Lost,
        };
        let known = || self.last.as_ref().and_then(|last| last.anchored.reference);
        let anchored = self.remember(frame.stamp, reference.or_else(known), tracking);
        let report = TrackReport { new_keyframe: reference.is_some(), ..self.report(frame.len()) };
        if let Some(id) = reference {
            let landmarks = self.active.map.keyframe(id).landmarks.clone();
            self.go_on_from(Located { frame, landmarks, anchored });
            (self.misses, self.blind, self.torn, self.doubts) = (0, false, false, Doubts::default());
            self.missed = None;
        } else {
            self.missed = Some(frame);
        }
        report
    }

    fn beginning(&self, frame: &Frame, depth: &DepthImage, prior: Option<CameraMotion>) -> Beginning {
        let is_able = with_depth(frame).count() >= self.config.mapping.min_points;
        if !is_able || self.mode == Mode::Localisation {
            Beginning::None
        } else if self.active.map.keyframe_count() == 0 {
            Beginning::First
        } else if self.is_lost() && self.misses >= self.config.tracking.patience {
            Beginning::Another
        } else if !self.is_lost()
            && prior.is_some()
            && !self.contradiction.is_going_on()
            && self.is_beyond_the_map(depth)
            && self.shows_the_same_again(frame)
        {
            if self.is_astray() { Beginning::Another } else { Beginning::Onward }
        } else {
            Beginning::None
        }
    }

    /// Whether what wheels tell of the way says nothing of where in the active map the camera is.
    fn is_lost(&self) -> bool {
        self.blind || !self.placed || self.torn
    }

    /// Whether a frame shows much, and nothing of the much that it should show, right after one that was located: whatever moved the
    /// camera was not what the wheels counted, and what it sees next is not what lies beyond the map.
    fn is_torn(&self, frame: &Frame, depth: &DepthImage) -> bool {
        let is_next = |last: &Located| frame.stamp - last.frame.stamp < AT_A_STRETCH;
        let expected = || self.view(depth).landmarks(&self.active.map, self.belief.visual_from_camera).len();
        self.misses == 1
            && frame.len() >= MUCH
            && self.last.as_ref().is_some_and(is_next)
            && expected() >= MUCH
    }

    fn is_astray(&self) -> bool {
        let sigma = |i: usize| self.belief.covariance[(i, i)].sqrt();
        (0..3).any(|i| sigma(i) > ASTRAY.0) || (3..6).any(|i| sigma(i) > ASTRAY.1)
    }

    /// Whether there is no use in waiting to see a known landmark again: none should be in view, or none was found for
    /// too long.
    fn is_beyond_the_map(&self, depth: &DepthImage) -> bool {
        let config = &self.config.tracking;
        let expected = self.view(depth).landmarks(&self.active.map, self.belief.visual_from_camera).len();
        expected < config.min_inliers || self.misses >= config.patience
    }

    /// Whether it shows what the frame before it showed, which was not located either: corners that noise makes of a bare wall no later
    /// frame shows again, and from a keyframe of such ones nothing is followed.
    fn shows_the_same_again(&self, frame: &Frame) -> bool {
        let Likeness { max_distance, ratio } = self.config.tracking.free_likeness();
        let again = |before: &Frame| {
            match_mutual(&before.features.descriptors, &frame.features.descriptors, max_distance, ratio).len()
        };
        self.missed.as_ref().is_some_and(|before| again(before) >= self.config.tracking.weak_inliers)
    }

    /// The first keyframe of the active map, or one that goes on from it.
    fn begin(&mut self, frame: &Frame, begins: Beginning) -> KeyframeId {
        if begins != Beginning::Onward {
            self.belief.covariance = Matrix6::zeros();
        }
        let id = self.insert(frame.clone(), self.belief.visual_from_camera, &vec![None; frame.len()]);
        self.active.map.set_covariance(id, self.belief.covariance);
        id
    }

    /// Leaves the active map for an empty one, at its origin. One that is hardly begun is forgotten: a camera that finds
    /// nothing begins such maps for ever, and nobody would know one again.
    fn begin_map(&mut self) {
        let way = (!self.is_lost()).then_some((self.belief.visual_from_camera, self.belief.covariance));
        let before = self.active.id;
        // No number is given twice: whoever knows where a map lies knows it by its number.
        let newest = self.resting.iter().map(|map| map.id.0).fold(self.active.id.0, u32::max);
        self.newest_map = self.newest_map.max(newest).saturating_add(1);
        let id = MapId(self.newest_map);
        let vocabulary = Arc::clone(self.active.places.vocabulary());
        let empty = Component::new(id, LandmarkMap::default(), &vocabulary);
        let left = std::mem::replace(&mut self.active, empty);
        if left.map.keyframe_count() >= LEAST_KEYFRAMES {
            self.resting.push(left);
        }
        self.resting.sort_by_key(|map| map.id);
        self.belief = Belief { stamp: self.belief.stamp, ..Belief::at(Pose3::identity()) };
        self.placed = true;
        (self.last, self.recognition, self.surprise) = (None, None, None);
        self.forget_the_way();
        let begun =
            way.map(|(before_from_map, covariance)| Begun { map: id, before, before_from_map, covariance });
        // Where the map before is forgotten, the way leads on from the one before that.
        let is_forgotten = self.resting.iter().all(|map| map.id != before);
        self.begun = if is_forgotten { self.begun.zip(begun).and_then(|(a, b)| a.then(b)) } else { begun };
    }
}
