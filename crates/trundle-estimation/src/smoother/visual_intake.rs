//! Visual poses: keyframe, anchor, gate, switch.

use super::error_process::{ErrorStart, ErrorStep, PlaceSwitch};
use super::factors::{VisualFactor, rotation};
use super::fixed_lag::Smoother;
use super::innovation::Innovation;
use super::intake::{Located, Target};
use super::keyframe::Keyframe;
use super::measurement::MeasurementUse;
use super::prediction::Predicted;
use super::state::{ANCHOR, CHAIN, ERROR};
use super::visual_maps::SlotFor;
use super::window::Window;
use crate::fusion::correction::{VisualPose, VisualQuality};
use crate::planar::{planar_covariance, symmetric};
use nalgebra::{Matrix3, Vector2, Vector3};
use trundle_core::{Pose2, Pose3};

/// Probability that a visual pose outside the gate is wrong: the visual frame jumped as likely as the base did. Source: ours.
const JUMP_WRONG_PROBABILITY: f64 = 0.5;
/// Weight of a place above which the estimate starts from it. Source: ours.
const PROBABLY_RIGHT: f64 = 0.5;

/// Variance of the position above which a place sets the pose anew, m^2. Source: ours: a tenth of a room.
const UNKNOWN_VARIANCE_M2: f64 = 1.0;

/// A visual pose in the frame of its anchor.
struct Levelled {
    pose: Pose2,
    /// Covariance of the map part, in the axes of the visual map.
    map_part: Matrix3<f64>,
    /// Covariance of the white noise.
    noise: Matrix3<f64>,
}

impl Smoother {
    /// Adds a visual pose. The first one of a visual map anchors the map.
    pub fn add_visual(&mut self, visual: &VisualPose) -> MeasurementUse {
        if !(visual.visual_from_camera.is_finite() && visual.covariance.iter().all(|v| v.is_finite())) {
            return MeasurementUse::Invalid;
        }
        let at = match self.locate(visual.stamp) {
            Ok(at) => at,
            Err(rejection) => return rejection,
        };
        let Some(window) = &self.window else { return MeasurementUse::NoMotion };
        let is_used = |slot| window.keyframes.iter().any(|k| k.visual.is_some_and(|v| v.slot == slot));
        match self.maps.slot_for(visual.map, is_used) {
            None => MeasurementUse::TooManyMaps,
            Some(SlotFor::New(slot)) => self.anchor(visual, &at, slot),
            Some(SlotFor::Stored(slot, stored)) => {
                let old = self.anchor_in(slot);
                self.maps.take(slot, visual.map, stored.level_from_visual, old);
                self.set_anchor(slot, stored.anchor, Some(stored.covariance));
                self.add_visual_in(visual, &at, slot)
            }
            Some(SlotFor::Known(slot)) => self.add_visual_in(visual, &at, slot),
        }
    }

    /// A visual pose of a map whose anchor is in a slot.
    fn add_visual_in(&mut self, visual: &VisualPose, at: &Located, slot: usize) -> MeasurementUse {
        let Some(level) = self.maps.level(slot) else { return MeasurementUse::TooManyMaps };
        self.maps.on_used(slot);
        let mut levelled = self.levelled(visual, level);
        levelled.pose = levelled.pose * Pose2::exp(self.velocity() * -at.lead);
        let Some(window) = &self.window else { return MeasurementUse::NoMotion };
        let last = window.keyframes[..=at.before].iter().rev().find_map(|keyframe| keyframe.visual);
        let is_other_map = last.is_none_or(|last| last.slot != slot);
        let is_place = visual.recognised || is_other_map;
        if !is_place && self.is_redundant(window, at) {
            return MeasurementUse::Redundant;
        }
        let target = self.target(window, at, |keyframe| keyframe.visual.is_none());
        let (predicted, keyframe) = self.predicted(window, &target, at.stamp);
        let mut factor =
            VisualFactor { pose: levelled.pose, velocity: self.velocity(), noise: levelled.noise, slot };
        if let Target::Existing { motion, .. } = target {
            factor.pose = factor.pose * motion;
        }
        let measured = factor.linearise(&predicted.state, &window.border);
        let innovation = predicted.innovation(&measured, &factor.noise);
        let is_outside = innovation.squared > self.config.gate.powi(2);
        let wrong =
            if visual.recognised { self.config.wrong_place_probability } else { JUMP_WRONG_PROBABILITY };
        let switch = (is_place || is_outside).then(|| PlaceSwitch::new(wrong));
        let entry = Entry { target, predicted, keyframe, factor, map_part: levelled.map_part };
        match switch {
            None => {
                self.enter(entry, None, None);
                MeasurementUse::Applied(innovation)
            }
            Some(switch) => self.enter_place(entry, switch),
        }
    }

    /// A recognised place: the error of the visual poses starts again, with a switch.
    fn enter_place(&mut self, mut entry: Entry, switch: PlaceSwitch) -> MeasurementUse {
        let Some(window) = &self.window else { return MeasurementUse::NoMotion };
        let stationary = self.error_step(entry.map_part, None, Vector2::zeros()).stationary;
        entry.predicted.forget_error();
        let measured = entry.factor.linearise(&entry.predicted.state, &window.border);
        let without = entry.predicted.spread(&measured, &entry.factor.noise);
        let innovation = Innovation::new(&measured.residual, &symmetric(without + stationary));
        let switch = switch.judged(&measured.residual, &without, &stationary);
        let is_right = switch.weight > PROBABLY_RIGHT;
        let error = if is_right { Vector3::zeros() } else { measured.residual };
        if is_right && entry.predicted.covariance[(0, 0)] > UNKNOWN_VARIANCE_M2 {
            self.start_at(&mut entry);
        }
        self.enter(entry, Some(ErrorStart::Place(switch)), Some(error));
        MeasurementUse::Switched { innovation, weight: switch.weight }
    }

    /// Moves the whole window so that it agrees with a place: the derivatives at an unknown pose hold for no step of many metres.
    fn start_at(&mut self, entry: &mut Entry) {
        let Some(window) = &mut self.window else { return };
        let found = window.border.anchors[entry.factor.slot] * entry.factor.pose;
        let moved_from_old = found * entry.predicted.state.pose.inverse();
        window.move_all(&moved_from_old, entry.factor.slot);
        if let Some(keyframe) = &mut entry.keyframe {
            keyframe.state.pose = moved_from_old * keyframe.state.pose;
        }
    }

    /// Puts a visual factor into the window and solves it.
    fn enter(&mut self, entry: Entry, start: Option<ErrorStart>, error: Option<Vector3<f64>>) {
        let step = self.error_step(entry.map_part, start, Vector2::zeros());
        let change = |keyframe: &mut Keyframe| {
            keyframe.visual = Some(entry.factor);
            keyframe.error = ErrorStep { displacement: keyframe.error.displacement, ..step };
            keyframe.trust = keyframe.trust_after(keyframe.trust);
            keyframe.state.error = error.unwrap_or(keyframe.state.error);
        };
        match (entry.target, entry.keyframe) {
            (Target::New { k }, Some(mut keyframe)) => {
                change(&mut keyframe);
                self.insert(k, keyframe);
            }
            (Target::Existing { k, .. }, _) => {
                self.window.iter_mut().for_each(|window| change(&mut window.keyframes[k]));
                self.solve();
            }
            (Target::New { .. }, None) => {}
        }
    }

    /// The first visual pose of a map: its anchor is where the base is.
    fn anchor(&mut self, visual: &VisualPose, at: &Located, slot: usize) -> MeasurementUse {
        let level_from_visual = (visual.visual_from_camera * self.base_from_camera.inverse()).inverse();
        let old = self.anchor_in(slot);
        self.maps.take(slot, visual.map, level_from_visual, old);
        self.maps.on_used(slot);
        let levelled = self.levelled(visual, level_from_visual);
        let Some(window) = &self.window else { return MeasurementUse::NoMotion };
        let target = self.target(window, at, |keyframe| keyframe.visual.is_none());
        let (predicted, keyframe) = self.predicted(window, &target, at.stamp);
        let mut pose = levelled.pose * Pose2::exp(self.velocity() * -at.lead);
        if let Target::Existing { motion, .. } = target {
            pose = pose * motion;
        }
        let factor = VisualFactor { pose, velocity: self.velocity(), noise: levelled.noise, slot };
        self.set_anchor(slot, predicted.state.pose * pose.inverse(), None);
        let entry = Entry { target, predicted, keyframe, factor, map_part: Matrix3::zeros() };
        self.enter(entry, Some(ErrorStart::NewMap), Some(Vector3::zeros()));
        MeasurementUse::Anchored
    }

    /// Anchor and covariance in a slot, as they are estimated.
    fn anchor_in(&self, slot: usize) -> (Pose2, Matrix3<f64>) {
        let place = CHAIN + ANCHOR + 3 * slot;
        let covariance =
            self.newest.as_ref().map(|newest| newest.covariance.fixed_view::<3, 3>(place, place));
        let anchor = self.window.as_ref().map(|window| window.border.anchors[slot]);
        (anchor.unwrap_or(Pose2::IDENTITY), covariance.map_or_else(Matrix3::zeros, |view| view.into_owned()))
    }

    fn set_anchor(&mut self, slot: usize, anchor: Pose2, covariance: Option<Matrix3<f64>>) {
        if let Some(window) = &mut self.window {
            window.border.anchors[slot] = anchor;
            window.prior.set_anchor(slot, anchor, covariance);
        }
    }

    /// Whether the window has a visual pose with the same error.
    fn is_redundant(&self, window: &Window, at: &Located) -> bool {
        let has_visual = |keyframe: &Keyframe| keyframe.visual.is_some();
        let next = window.keyframes.get(at.before + 1).is_some_and(has_visual);
        let Some(path) = self.path_since(window, at, has_visual) else { return next };
        let config = &self.config;
        let is_far =
            path.distance >= config.keyframe_distance || path.turned >= config.keyframe_turn_deg.to_radians();
        next || path.time < config.keyframe_min_time || !is_far && path.time < config.keyframe_max_time
    }

    fn levelled(&self, visual: &VisualPose, level_from_visual: Pose3) -> Levelled {
        let level_from_base = level_from_visual * visual.visual_from_camera * self.base_from_camera.inverse();
        let pose = level_from_base.to_pose2();
        let turn = rotation(pose.theta);
        let own = turn * planar_covariance(&visual.covariance, &self.base_from_camera) * turn.transpose();
        let (height, tilt) =
            (level_from_base.translation.z, level_from_base.rotate(Vector3::z()).xy().norm());
        let out_of_plane = Vector3::new(height * height, height * height, tilt * tilt);
        let factor = match visual.quality {
            VisualQuality::Ok => 1.0,
            VisualQuality::Weak => self.config.weak_factor.powi(2),
        };
        let (position, heading) =
            (self.config.visual_white_position, self.config.visual_white_heading_deg.to_radians());
        let white = Vector3::new(position, position, heading).map(|sigma| sigma * sigma * factor);
        Levelled {
            pose,
            map_part: symmetric(own + Matrix3::from_diagonal(&out_of_plane)),
            noise: Matrix3::from_diagonal(&white),
        }
    }
}

/// A visual factor on its way into the window.
struct Entry {
    target: Target,
    predicted: Predicted,
    keyframe: Option<Keyframe>,
    factor: VisualFactor,
    map_part: Matrix3<f64>,
}

impl Predicted {
    /// Takes the error of the visual poses out: it starts again.
    fn forget_error(&mut self) {
        self.state.error = Vector3::zeros();
        self.covariance.fixed_rows_mut::<3>(ERROR).fill(0.0);
        self.covariance.fixed_columns_mut::<3>(ERROR).fill(0.0);
    }
}
