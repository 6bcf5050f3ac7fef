//! Visual poses: keyframe, anchor, gate, switch.

use super::error_process::{ErrorStart, ErrorStep, PlaceSwitch};
use super::factors::{VisualFactor, rotation};
use super::fixed_lag::Smoother;
use super::innovation::Innovation;
use super::intake::{self, Located, Target};
use super::keyframe::Keyframe;
use super::measurement::MeasurementUse;
use super::prediction::Predicted;
use super::state::{CHAIN_SIZE, FIRST_ANCHOR_PLACE};
use super::visual_maps::SlotFor;
use super::window::Window;
use crate::fusion::correction::{VisualPose, VisualQuality};
use crate::planar::{planar_covariance, symmetric};
use nalgebra::{Matrix3, Vector2, Vector3};
use trundle_core::{Pose2, Pose3};

/// Prior probability that a visual pose outside the gate is wrong: a jump of the visual frame is as likely as one of the base. Source:
/// ours.
const JUMP_WRONG_PROBABILITY: f64 = 0.5;
/// Weight of a place above which the estimate restarts at this place. Source: ours.
const PROBABLY_RIGHT: f64 = 0.5;
/// Variance of the first visual pose of a map, m^2 and rad^2. Source: ours; it keeps the equations definite.
const FIRST_IMAGE_VARIANCE: f64 = 1e-9;
/// Variance of the position above which a place resets the pose, m^2. Source: ours: a tenth of a room.
const UNKNOWN_VARIANCE_M2: f64 = 1.0;

/// A visual pose in the frame of its anchor.
struct Levelled {
    pose: Pose2,
    /// Covariance of the map part, in the axes of the visual map.
    map_part: Matrix3<f64>,
    /// Covariance of the white noise.
    noise: Matrix3<f64>,
}

/// Adds a visual pose. The first one of a visual map anchors the map.
pub(super) fn add(smoother: &mut Smoother, visual: &VisualPose) -> MeasurementUse {
    if !(visual.visual_from_camera.is_finite() && visual.covariance.iter().all(|v| v.is_finite())) {
        return MeasurementUse::Invalid;
    }
    let at = match intake::locate(smoother, visual.stamp) {
        Ok(at) => at,
        Err(rejection) => return rejection,
    };
    let Some(window) = &smoother.window else { return MeasurementUse::NoMotion };
    let is_used = |slot| window.keyframes.iter().any(|k| k.visual.is_some_and(|v| v.slot == slot));
    match smoother.maps.slot_for(visual.map, is_used) {
        None => MeasurementUse::TooManyMaps,
        Some(SlotFor::New(slot)) => anchor(smoother, visual, &at, slot),
        Some(SlotFor::Stored(slot, stored)) => {
            let old = anchor_in(smoother, slot);
            smoother.maps.take(slot, visual.map, stored.level_from_visual, old);
            set_anchor(smoother, slot, stored.anchor, Some(stored.covariance));
            add_visual_in(smoother, visual, &at, slot)
        }
        Some(SlotFor::Known(slot)) => add_visual_in(smoother, visual, &at, slot),
    }
}

/// A visual pose of a map whose anchor is in a slot.
fn add_visual_in(smoother: &mut Smoother, visual: &VisualPose, at: &Located, slot: usize) -> MeasurementUse {
    let Some(level) = smoother.maps.level(slot) else { return MeasurementUse::TooManyMaps };
    smoother.maps.on_used(slot);
    let levelled = levelled(smoother, visual, level);
    let Some(window) = &smoother.window else { return MeasurementUse::NoMotion };
    let last = window.keyframes[..=at.before].iter().rev().find_map(|keyframe| keyframe.visual);
    let is_other_map = last.is_none_or(|last| last.slot != slot);
    let is_place = visual.recognised || is_other_map;
    let is_before_another = window.keyframes.get(at.before + 1).is_some_and(|next| next.visual.is_some());
    if !is_place && is_before_another {
        return MeasurementUse::Redundant;
    }
    let entry = entry(smoother, window, at, (levelled, slot));
    let measured = entry.factor.linearise(&entry.predicted.state, &window.border);
    let innovation = entry.predicted.innovation(&measured, &entry.factor.noise);
    let limits = &smoother.config.limits;
    let wrong = if visual.recognised { limits.wrong_place_probability } else { JUMP_WRONG_PROBABILITY };
    if is_place || innovation.squared > limits.gate.powi(2) {
        return enter_place(smoother, entry, PlaceSwitch::new(wrong));
    }
    enter(smoother, entry, None, None);
    MeasurementUse::Applied(innovation)
}

/// A visual pose with its keyframe, and its prediction.
fn entry(smoother: &Smoother, window: &Window, at: &Located, (levelled, slot): (Levelled, usize)) -> Entry {
    let target = intake::target(smoother, window, at, |keyframe| keyframe.visual.is_none());
    let (predicted, keyframe) = intake::predicted(smoother, window, &target, at.stamp);
    let velocity = intake::velocity(smoother);
    let mut pose = levelled.pose * Pose2::exp(velocity * -at.lead);
    if let Target::Existing { motion, .. } = target {
        pose = pose * motion;
    }
    let factor = VisualFactor { pose, velocity, noise: levelled.noise, slot };
    Entry { target, predicted, keyframe, factor, map_part: levelled.map_part }
}

/// A recognised place: the error of the visual poses starts again, with a switch.
fn enter_place(smoother: &mut Smoother, mut entry: Entry, switch: PlaceSwitch) -> MeasurementUse {
    let Some(window) = &smoother.window else { return MeasurementUse::NoMotion };
    let stationary = smoother.error_step(entry.map_part, None, Vector2::zeros()).stationary;
    entry.predicted.forget_error();
    let measured = entry.factor.linearise(&entry.predicted.state, &window.border);
    let without = entry.predicted.spread(&measured, &entry.factor.noise);
    let innovation = Innovation::new(&measured.residual, &symmetric(without + stationary));
    let switch = switch.judged(&measured.residual, &without, &stationary);
    let is_right = switch.weight > PROBABLY_RIGHT;
    let error = if is_right { Vector3::zeros() } else { measured.residual };
    if is_right && entry.predicted.covariance[(0, 0)] > UNKNOWN_VARIANCE_M2 {
        start_at(smoother, &mut entry);
    }
    enter(smoother, entry, Some(ErrorStart::Place(switch)), Some(error));
    MeasurementUse::Switched { innovation, weight: switch.weight }
}

/// Moves the whole window to agree with a place: the derivatives at an unknown pose are not valid for steps of many metres.
fn start_at(smoother: &mut Smoother, entry: &mut Entry) {
    let Some(window) = &mut smoother.window else { return };
    let found = window.border.anchors[entry.factor.slot] * entry.factor.pose;
    let moved_from_old = found * entry.predicted.state.pose.inverse();
    window.move_all(&moved_from_old, entry.factor.slot);
    if let Some(keyframe) = &mut entry.keyframe {
        keyframe.state.pose = moved_from_old * keyframe.state.pose;
    }
}

/// Adds a visual factor to the window and solves the window.
fn enter(smoother: &mut Smoother, entry: Entry, start: Option<ErrorStart>, error: Option<Vector3<f64>>) {
    let moved = measured_displacement(smoother, &entry);
    let step = smoother.error_step(entry.map_part, start, Vector2::zeros());
    let change = |keyframe: &mut Keyframe| {
        keyframe.visual = Some(entry.factor);
        keyframe.error = ErrorStep { displacement: moved.unwrap_or(keyframe.error.displacement), ..step };
        keyframe.trust = keyframe.trust_after(keyframe.trust);
        keyframe.state.error = error.unwrap_or(keyframe.state.error);
    };
    match (entry.target, entry.keyframe) {
        (Target::New { k }, Some(mut keyframe)) => {
            change(&mut keyframe);
            smoother.insert_image(k, keyframe);
        }
        (Target::Existing { k, .. }, _) => {
            smoother.window.iter_mut().for_each(|window| change(&mut window.keyframes[k]));
            smoother.solve();
        }
        (Target::New { .. }, None) => {}
    }
}

/// Displacement from the visual pose of the previous keyframe; `None` if that pose is of another map.
fn measured_displacement(smoother: &Smoother, entry: &Entry) -> Option<Vector2<f64>> {
    let before = match entry.target {
        Target::New { k } => k,
        Target::Existing { k, .. } => k.checked_sub(1)?,
    };
    let before = smoother.window.as_ref()?.keyframes[before].visual?;
    (before.slot == entry.factor.slot).then(|| entry.factor.pose.position() - before.pose.position())
}

/// The first visual pose of a map: the anchor follows from the base's pose.
fn anchor(smoother: &mut Smoother, visual: &VisualPose, at: &Located, slot: usize) -> MeasurementUse {
    let level_from_visual = (visual.visual_from_camera * smoother.base_from_camera.inverse()).inverse();
    let old = anchor_in(smoother, slot);
    smoother.maps.take(slot, visual.map, level_from_visual, old);
    smoother.maps.on_used(slot);
    let mut levelled = levelled(smoother, visual, level_from_visual);
    // The first image defines the frame: its pose has no error.
    levelled.noise = Matrix3::identity() * FIRST_IMAGE_VARIANCE;
    levelled.map_part = Matrix3::zeros();
    let Some(window) = &smoother.window else { return MeasurementUse::NoMotion };
    let entry = entry(smoother, window, at, (levelled, slot));
    let anchor = entry.predicted.state.pose * entry.factor.pose.inverse();
    set_anchor(smoother, slot, anchor, None);
    enter(smoother, entry, Some(ErrorStart::NewMap), Some(Vector3::zeros()));
    MeasurementUse::Anchored
}

/// Estimated anchor and covariance in a slot.
fn anchor_in(smoother: &Smoother, slot: usize) -> (Pose2, Matrix3<f64>) {
    let place = CHAIN_SIZE + FIRST_ANCHOR_PLACE + 3 * slot;
    let covariance =
        smoother.newest.as_ref().map(|newest| newest.covariance.fixed_view::<3, 3>(place, place));
    let anchor = smoother.window.as_ref().map(|window| window.border.anchors[slot]);
    (anchor.unwrap_or(Pose2::IDENTITY), covariance.map_or_else(Matrix3::zeros, |view| view.into_owned()))
}

fn set_anchor(smoother: &mut Smoother, slot: usize, anchor: Pose2, covariance: Option<Matrix3<f64>>) {
    if let Some(window) = &mut smoother.window {
        window.border.anchors[slot] = anchor;
        window.prior.set_anchor(slot, anchor, covariance);
    }
}

fn levelled(smoother: &Smoother, visual: &VisualPose, level_from_visual: Pose3) -> Levelled {
    let level_from_base = level_from_visual * visual.visual_from_camera * smoother.base_from_camera.inverse();
    let pose = level_from_base.to_pose2();
    let turn = rotation(pose.theta);
    let own = turn * planar_covariance(&visual.covariance, &smoother.base_from_camera) * turn.transpose();
    let (height, tilt) = (level_from_base.translation.z, level_from_base.rotate(Vector3::z()).xy().norm());
    let out_of_plane = Vector3::new(height * height, height * height, tilt * tilt);
    let factor = match visual.quality {
        VisualQuality::Ok => 1.0,
        VisualQuality::Weak => smoother.config.noise.weak_factor.powi(2),
    };
    let (position, heading) = (
        smoother.config.noise.visual_white_position,
        smoother.config.noise.visual_white_heading_deg.to_radians(),
    );
    let white = Vector3::new(position, position, heading).map(|sigma| sigma * sigma * factor);
    Levelled {
        pose,
        map_part: symmetric(own + Matrix3::from_diagonal(&out_of_plane)),
        noise: Matrix3::from_diagonal(&white),
    }
}
/// A visual factor to be added to the window.
struct Entry {
    target: Target,
    predicted: Predicted,
    keyframe: Option<Keyframe>,
    factor: VisualFactor,
    map_part: Matrix3<f64>,
}
