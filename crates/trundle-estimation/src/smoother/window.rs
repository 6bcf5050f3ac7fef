//! The window: keyframes, common unknowns, prior, and their solution.

use super::error_process::{ErrorStart, PlaceSwitch, wrong_place};
use super::factors::{Link, WindowSystem};
use super::keyframe::Keyframe;
use super::motion_buffer::MotionBuffer;
use super::prediction::Predicted;
use super::preintegration::parameters;
use super::prior::Prior;
use super::state::{BIAS_PLACE, BorderState, ChainState, ERROR_PLACE, POSE_PLACE};
use crate::odometry_config::OdometryConfig;
use crate::planar::symmetric;
use nalgebra::Matrix3;
use trundle_core::{Pose2, Stamp};

/// Keyframes by stamp, with the common unknowns and the prior of removed keyframes.
#[derive(Debug, Clone)]
pub(crate) struct Window {
    pub(crate) keyframes: Vec<Keyframe>,
    pub(crate) border: BorderState,
    pub(crate) prior: Prior,
    /// Normal equations, factorised at the newest values.
    system: WindowSystem,
    /// Normal equations of the two oldest keyframes; the first one is removed.
    leaving: WindowSystem,
    /// Values before a step.
    before: Vec<ChainState>,
    /// Number of solutions.
    pub(crate) solutions: usize,
}

/// Largest number of solutions after a measurement. Source: ours; the second one changes little.
const MAX_STEPS: usize = 3;
/// Largest step of a converged solution, m, rad, rad/s and ratio. Source: ours; such a step changes the derivatives by a thousandth.
const CONVERGED_STEP: f64 = 2e-3;
/// Relative rise of the cost after which a step is undone. Source: ours: above rounding.
const MAX_COST_RISE: f64 = 1e-3;
/// Change of a switch after which the window is solved again. Source: ours.
const MIN_SWITCH_CHANGE: f64 = 0.01;
/// Minimum information on the error of a place from other factors, relative to that of a wrong place. Source: ours; it keeps the difference
/// of two informations definite.
const MIN_OTHER_INFORMATION: f64 = 1e-3;
/// Damping after a step that raised the cost. Source: Levenberg and Marquardt; the number is ours.
const FIRST_DAMPING: f64 = 0.1;
/// Change of the gyro's bias (rad/s) after which a motion is integrated again. Source: ours: 0.5 s at 2 mrad/s.
const MAX_BIAS_CHANGE: f64 = 2e-3;
/// Change of scale, radii and wheelbase after which a motion is integrated again, ratio. Source: ours.
const MAX_RATIO_CHANGE: f64 = 5e-3;

impl Window {
    /// A window of one keyframe.
    pub(crate) fn new(
        first: Keyframe,
        border: BorderState,
        prior: Prior,
        max_keyframes: usize,
        config: &OdometryConfig,
    ) -> Self {
        let room = max_keyframes + 2;
        let mut keyframes = Vec::with_capacity(room);
        keyframes.push(first);
        let mut window = Self {
            keyframes,
            border,
            prior,
            system: WindowSystem::with_capacity(room),
            leaving: WindowSystem::with_capacity(2),
            before: Vec::with_capacity(room),
            solutions: 0,
        };
        window.linearise(config);
        window.system.factorise();
        window
    }

    /// The newest keyframe.
    pub(crate) fn newest(&self) -> &Keyframe {
        self.keyframes.last().expect("invariant: a window is never empty")
    }

    /// Number of the newest keyframe not later than a stamp; `None` before the window.
    pub(crate) fn at_or_before(&self, stamp: Stamp) -> Option<usize> {
        self.keyframes.partition_point(|keyframe| keyframe.stamp <= stamp).checked_sub(1)
    }

    /// The estimate of keyframe `k`.
    pub(crate) fn estimated(&self, k: usize) -> Predicted {
        // Keyframes may have been removed since the factorisation.
        let gone = self.system.count() - self.keyframes.len();
        Predicted::of(self.keyframes[k].state, &self.system.covariance(k + gone))
    }

    /// The estimate of the newest keyframe.
    pub(crate) fn estimated_newest(&self) -> Predicted {
        self.estimated(self.keyframes.len() - 1)
    }

    /// Finds the values with the best agreement with all factors, and the factorised system at these values. `false` if no step can be
    /// solved: the values do not change.
    pub(crate) fn optimise(&mut self, motions: &MotionBuffer) -> bool {
        self.integrate_again(motions);
        let (mut cost, mut damping, mut size) = (f64::INFINITY, 0.0, f64::INFINITY);
        let mut border_before = self.border;
        for _ in 0..MAX_STEPS {
            let next = self.linearise(motions.config());
            if next > cost + MAX_COST_RISE * cost.abs().max(1.0) {
                self.restore(&border_before);
                cost = self.linearise(motions.config());
                damping = f64::max(FIRST_DAMPING, damping * 10.0);
            } else {
                cost = next;
            }
            self.system.damp(damping);
            if !self.system.factorise() {
                self.restore(&border_before);
                return false;
            }
            self.system.solve();
            self.solutions += 1;
            border_before = self.border;
            size = self.take_step();
            if size < CONVERGED_STEP {
                break;
            }
        }
        let is_factor_old = damping > 0.0 || size >= CONVERGED_STEP;
        !is_factor_old || {
            self.linearise(motions.config());
            self.system.factorise()
        }
    }

    /// The normal equations at the present values; returns the cost.
    fn linearise(&mut self, config: &OdometryConfig) -> f64 {
        let Self { keyframes, border, prior, system, .. } = self;
        system.reset(keyframes.len());
        let mut cost = prior.add_to(system, &keyframes[0].state, border);
        let mut trust = keyframes[0].trust;
        for k in 0..keyframes.len() {
            cost += add_measurements(system, k, &keyframes[k], border);
            if k > 0 {
                let (from, to) = (keyframes[k - 1], &mut keyframes[k]);
                let link = Link { motion: &to.motion, error: &to.error, trust, config };
                cost += link.add_to(system, k - 1, (&from.state, &to.state), border);
                trust = to.trust_after(trust);
                to.trust = trust;
            }
        }
        cost
    }

    /// Moves all values by the solution; returns the largest change of a pose (m, rad), a bias (rad/s) or a common unknown.
    fn take_step(&mut self) -> f64 {
        self.before.clear();
        let mut size: f64 = 0.0;
        for (k, keyframe) in self.keyframes.iter_mut().enumerate() {
            self.before.push(keyframe.state);
            let step = self.system.step(k);
            keyframe.state = keyframe.state.moved(&step);
            size = size.max(step.fixed_rows::<3>(POSE_PLACE).amax()).max(step[BIAS_PLACE].abs());
        }
        let step = self.system.border_step();
        self.border = self.border.moved(&step);
        size.max(step.amax())
    }

    /// Undoes the last step.
    fn restore(&mut self, border: &BorderState) {
        self.border = *border;
        for (keyframe, before) in self.keyframes.iter_mut().zip(&self.before) {
            keyframe.state = *before;
        }
    }

    /// Integrates motions again after a change of the calibration beyond first order.
    fn integrate_again(&mut self, motions: &MotionBuffer) {
        for k in 1..self.keyframes.len() {
            let at = parameters(self.keyframes[k - 1].state.bias, &self.border);
            let change = at - self.keyframes[k].motion.at;
            if change[0].abs() > MAX_BIAS_CHANGE || change.fixed_rows::<4>(1).amax() > MAX_RATIO_CHANGE {
                let (from, to) = (self.keyframes[k - 1].stamp, self.keyframes[k].stamp);
                self.keyframes[k].motion = motions.between(from, to, at);
            }
        }
    }

    /// Moves all poses and anchors but one by a motion of the map frame; their relative poses do not change.
    pub(crate) fn move_all(&mut self, new_from_old: &Pose2, fixed_slot: usize) {
        self.before.clear();
        for keyframe in &mut self.keyframes {
            keyframe.state.pose = *new_from_old * keyframe.state.pose;
        }
        self.border.move_anchors(new_from_old, fixed_slot);
        self.prior.move_all(new_from_old, fixed_slot);
    }

    /// Inserts a keyframe after keyframe `k`; the motion to the next keyframe is integrated again.
    pub(crate) fn insert_after(&mut self, k: usize, keyframe: Keyframe, motions: &MotionBuffer) {
        self.before.clear();
        let at = parameters(keyframe.state.bias, &self.border);
        if let Some(later) = self.keyframes.get_mut(k + 1) {
            later.motion = motions.between(keyframe.stamp, later.stamp, at);
            later.error.displacement -= keyframe.error.displacement;
        }
        self.keyframes.insert(k + 1, keyframe);
    }

    /// Replaces the newest keyframe, which has a predecessor, by a later keyframe predicted from it.
    pub(crate) fn replace_newest(&mut self, mut keyframe: Keyframe, motions: &MotionBuffer) {
        self.before.clear();
        if let Some(replaced) = self.keyframes.pop() {
            keyframe.error.displacement += replaced.error.displacement;
        }
        let before = self.newest();
        let at = parameters(before.state.bias, &self.border);
        keyframe.motion = motions.between(before.stamp, keyframe.stamp, at);
        self.keyframes.push(keyframe);
    }

    /// Removes the oldest keyframe; its information becomes the prior of the next one. `false` if the window has one keyframe, or its
    /// equations have no solution.
    pub(crate) fn remove_oldest(&mut self, config: &OdometryConfig) -> bool {
        let Self { keyframes, border, prior, leaving, .. } = self;
        let [first, second, ..] = keyframes[..] else { return false };
        leaving.reset(2);
        prior.add_to(leaving, &first.state, border);
        add_measurements(leaving, 0, &first, border);
        let link = Link { motion: &second.motion, error: &second.error, trust: first.trust, config };
        link.add_to(leaving, 0, (&first.state, &second.state), border);
        let Some(marginal) = leaving.marginalise_first() else { return false };
        let time = second.stamp - first.stamp;
        *prior = Prior::after(&marginal, second.state, *border, time);
        keyframes.remove(0);
        true
    }

    /// Evaluates each recognised place by all other factors. Returns whether a switch has moved.
    pub(crate) fn judge_places(&mut self) -> bool {
        let mut is_moved = false;
        for k in 1..self.keyframes.len() {
            let Some(ErrorStart::Place(switch)) = self.keyframes[k].error.start else { continue };
            let Some(judged) = self.judged(k, &switch) else { continue };
            is_moved |= (judged.weight - switch.weight).abs() > MIN_SWITCH_CHANGE;
            self.keyframes[k].error.start = Some(ErrorStart::Place(judged));
        }
        is_moved
    }

    /// The switch of keyframe `k`, by the error of the visual pose from all other factors: the factor of the place is subtracted from the
    /// posterior.
    fn judged(&self, k: usize, switch: &PlaceSwitch) -> Option<PlaceSwitch> {
        let keyframe = &self.keyframes[k];
        let posterior: Matrix3<f64> =
            self.system.covariance(k).block.fixed_view::<3, 3>(ERROR_PLACE, ERROR_PLACE).into();
        let with = posterior.try_inverse()?;
        let without = with - keyframe.error.information(&keyframe.motion)?;
        let floor = wrong_place().try_inverse()? * MIN_OTHER_INFORMATION;
        let covariance = symmetric(without + floor).try_inverse()?;
        let error = covariance * (with * keyframe.state.error);
        covariance.cholesky()?;
        Some(switch.judged(&error, &covariance, &keyframe.error.stationary))
    }
}

/// Adds the measurements of keyframe `k`; returns their cost.
fn add_measurements(system: &mut WindowSystem, k: usize, keyframe: &Keyframe, border: &BorderState) -> f64 {
    let mut cost = 0.0;
    if let Some(visual) = &keyframe.visual {
        cost += visual.linearise(&keyframe.state, border).add_to(system, k, &visual.noise);
    }
    if let Some(scan) = &keyframe.scan {
        cost += scan.linearise(&keyframe.state).add_to(system, k, &scan.noise);
    }
    cost
}
