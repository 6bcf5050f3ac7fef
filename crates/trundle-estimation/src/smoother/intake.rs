//! Place of a measurement in the window.

use super::fixed_lag::Smoother;
use super::keyframe::Keyframe;
use super::measurement::MeasurementUse;
use super::prediction::Predicted;
use super::preintegration::Preintegrated;
use super::window::Window;
use nalgebra::Vector3;
use trundle_core::{Pose2, Stamp};

/// A stamp in the window.
#[derive(Debug, Clone, Copy)]
pub(super) struct Located {
    /// The newest keyframe not later.
    pub(super) before: usize,
    /// The stamp, at most that of the newest motion.
    pub(super) stamp: Stamp,
    /// Time by which the measurement is ahead of the newest motion, s.
    pub(super) lead: f64,
}

/// The keyframe that a measurement belongs to.
#[derive(Debug, Clone, Copy)]
pub(super) enum Target {
    /// Keyframe `k`, at `motion` from the measurement's pose.
    Existing {
        /// Number of the keyframe.
        k: usize,
        /// Motion from the measurement to the keyframe.
        motion: Pose2,
    },
    /// A new keyframe after keyframe `k`.
    New {
        /// Number of the previous keyframe.
        k: usize,
    },
}

/// Largest time between a measurement and its keyframe, s; the motion in between counts as exact. Source: ours: 2 mm.
const MAX_SHIFT_S: f64 = 0.06;

/// Looks a stamp up.
pub(super) fn locate(smoother: &Smoother, stamp: Stamp) -> Result<Located, MeasurementUse> {
    let (Some(window), Some(motion)) = (&smoother.window, smoother.motions.newest()) else {
        return Err(MeasurementUse::NoMotion);
    };
    let lead = stamp - motion.stamp;
    if lead > smoother.config.limits.max_lead {
        return Err(MeasurementUse::TooNew { by: lead });
    }
    let oldest = window.keyframes[0].stamp;
    let before = window.at_or_before(stamp).ok_or(MeasurementUse::TooOld { by: oldest - stamp })?;
    Ok(Located { before, stamp: stamp.min(motion.stamp), lead: lead.max(0.0) })
}

/// The keyframe for a measurement: one within [`MAX_SHIFT_S`] that `accepts` it, else a new one.
pub(super) fn target(
    smoother: &Smoother,
    window: &Window,
    at: &Located,
    accepts: impl Fn(&Keyframe) -> bool,
) -> Target {
    let near = [at.before, at.before + 1].into_iter().filter(|&k| {
        let is_near = |keyframe: &Keyframe| (keyframe.stamp - at.stamp).abs() <= MAX_SHIFT_S;
        window.keyframes.get(k).is_some_and(|keyframe| is_near(keyframe) && accepts(keyframe))
    });
    let distance = |k: &usize| (window.keyframes[*k].stamp.nanos - at.stamp.nanos).abs();
    match near.min_by_key(distance) {
        None => Target::New { k: at.before },
        Some(k) => Target::Existing { k, motion: motion_to(smoother, window, at.stamp, k) },
    }
}

/// Motion from a stamp to that of keyframe `k`.
fn motion_to(smoother: &Smoother, window: &Window, stamp: Stamp, k: usize) -> Pose2 {
    let keyframe = &window.keyframes[k];
    let parameters = super::preintegration::parameters(keyframe.state.bias, &window.border);
    let between = |from: Stamp, to: Stamp| smoother.motions.between(from, to, parameters).motion;
    if keyframe.stamp >= stamp {
        between(stamp, keyframe.stamp)
    } else {
        between(keyframe.stamp, stamp).inverse()
    }
}

/// Path from the last keyframe that `has` a measurement to a stamp after keyframe `k`.
pub(super) fn path_since(
    smoother: &Smoother,
    window: &Window,
    at: &Located,
    has: impl Fn(&Keyframe) -> bool,
) -> Option<Path> {
    let last = window.keyframes[..=at.before].iter().rposition(has)?;
    let between = window.keyframes[last + 1..=at.before].iter().map(|keyframe| &keyframe.motion);
    let before = &window.keyframes[at.before];
    let end = smoother.motions.between(before.stamp, at.stamp, before.motion.at);
    let mut path = Path { distance: 0.0, turned: 0.0 };
    between.chain([&end]).for_each(|motion| path.add(motion));
    Some(path)
}

/// The estimate at a target, before its measurement; a new target includes its new keyframe.
pub(super) fn predicted(
    smoother: &Smoother,
    window: &Window,
    target: &Target,
    stamp: Stamp,
) -> (Predicted, Option<Keyframe>) {
    match *target {
        Target::Existing { k, .. } => (window.estimated(k), None),
        Target::New { k } => {
            let keyframe = smoother.keyframe_after(window, k, stamp);
            let (border, config) = (&window.border, smoother.motions.config());
            let from = window.estimated(k);
            let trust = window.keyframes[k].trust;
            (from.after(&keyframe.motion, &keyframe.error, trust, border, config), Some(keyframe))
        }
    }
}

/// Velocity of the base, m/s, m/s, rad/s.
pub(super) fn velocity(smoother: &Smoother) -> Vector3<f64> {
    Vector3::new(smoother.twist.v, 0.0, smoother.twist.omega)
}
/// A path between two measurements.
#[derive(Debug, Clone, Copy)]
pub(super) struct Path {
    /// Length, m.
    pub(super) distance: f64,
    /// Sum of the absolute turns, rad.
    pub(super) turned: f64,
}

impl Path {
    fn add(&mut self, motion: &Preintegrated) {
        self.distance += motion.distance;
        self.turned += motion.turned;
    }
}
