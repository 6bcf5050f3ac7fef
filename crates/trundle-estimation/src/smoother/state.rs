//! The unknowns of the window and their order.

use nalgebra::{SMatrix, SVector, Vector3};
use trundle_core::Pose2;

/// Unknowns of a keyframe: pose (3), error of the visual pose (3), bias of the gyro (1). Source: ours, the sum of the numbers in brackets.
pub(crate) const CHAIN_SIZE: usize = 7;
/// Place of the pose in a keyframe's unknowns.
pub(crate) const POSE_PLACE: usize = 0;
/// Place of the error of the visual pose.
pub(crate) const ERROR_PLACE: usize = 3;
/// Place of the gyro's bias.
pub(crate) const BIAS_PLACE: usize = 6;

/// Unknowns common to all keyframes: scale, radii, wheelbase, delay, anchors.
pub(crate) const BORDER_SIZE: usize = 5 + 3 * ANCHOR_SLOTS;
/// Place of the gyro's scale in the border.
pub(crate) const SCALE_PLACE: usize = 0;
/// Place of the ratios of left radius, right radius and wheelbase.
pub(crate) const WHEELS_PLACE: usize = 1;
/// Place of the camera's delay.
pub(crate) const DELAY_PLACE: usize = 4;
/// Place of the first anchor.
pub(crate) const FIRST_ANCHOR_PLACE: usize = 5;
/// Number of visual maps with an anchor in the window. More maps in one window are rare. Source: ours.
pub(crate) const ANCHOR_SLOTS: usize = 3;

/// Unknowns of one keyframe and the border together.
pub(crate) const JOINT_SIZE: usize = CHAIN_SIZE + BORDER_SIZE;

/// Square block of a keyframe.
pub(crate) type ChainBlock = SMatrix<f64, CHAIN_SIZE, CHAIN_SIZE>;
/// Keyframe (rows) with border (columns).
pub(crate) type Coupling = SMatrix<f64, CHAIN_SIZE, BORDER_SIZE>;
/// Square block of the border.
pub(crate) type BorderBlock = SMatrix<f64, BORDER_SIZE, BORDER_SIZE>;
/// Matrix of a keyframe and the border.
pub(crate) type JointMatrix = SMatrix<f64, JOINT_SIZE, JOINT_SIZE>;
/// Vector of a keyframe and the border.
pub(crate) type JointVector = SVector<f64, JOINT_SIZE>;

/// Values of a keyframe's unknowns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ChainState {
    /// `map_from_base`.
    pub(crate) pose: Pose2,
    /// Error of the visual pose in the axes of the visual map (m, m, rad).
    pub(crate) error: Vector3<f64>,
    /// Bias of the gyro, rad/s.
    pub(crate) bias: f64,
}

/// Values of the common unknowns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BorderState {
    /// True turn over the gyro's turn.
    pub(crate) scale: f64,
    /// True over nominal: left radius, right radius, wheelbase.
    pub(crate) wheels: Vector3<f64>,
    /// Delay of the camera: stamp of an image minus its exposure, s.
    pub(crate) delay: f64,
    /// `map_from_visual` in the plane, by slot.
    pub(crate) anchors: [Pose2; ANCHOR_SLOTS],
}

impl ChainState {
    /// A keyframe at `pose` without any known error or bias.
    pub(crate) fn at(pose: Pose2) -> Self {
        Self { pose, error: Vector3::zeros(), bias: 0.0 }
    }

    /// The state after a step: the pose on its right side.
    pub(crate) fn moved(&self, step: &SVector<f64, CHAIN_SIZE>) -> Self {
        Self {
            pose: self.pose * Pose2::exp(step.fixed_rows::<3>(POSE_PLACE).into()),
            error: self.error + step.fixed_rows::<3>(ERROR_PLACE),
            bias: self.bias + step[BIAS_PLACE],
        }
    }

    /// The step that leads from `from` to here.
    pub(crate) fn since(&self, from: &Self) -> SVector<f64, CHAIN_SIZE> {
        let mut step = SVector::<f64, CHAIN_SIZE>::zeros();
        step.fixed_rows_mut::<3>(POSE_PLACE).copy_from(&(from.pose.inverse() * self.pose).log());
        step.fixed_rows_mut::<3>(ERROR_PLACE).copy_from(&(self.error - from.error));
        step[BIAS_PLACE] = self.bias - from.bias;
        step
    }
}

impl Default for BorderState {
    fn default() -> Self {
        Self {
            scale: 1.0,
            wheels: Vector3::repeat(1.0),
            delay: 0.0,
            anchors: [Pose2::IDENTITY; ANCHOR_SLOTS],
        }
    }
}

impl BorderState {
    /// The state after a step: anchors on their right side.
    pub(crate) fn moved(&self, step: &SVector<f64, BORDER_SIZE>) -> Self {
        let mut moved = *self;
        moved.scale += step[SCALE_PLACE];
        moved.wheels += step.fixed_rows::<3>(WHEELS_PLACE);
        moved.delay += step[DELAY_PLACE];
        for (slot, anchor) in moved.anchors.iter_mut().enumerate() {
            *anchor = *anchor * Pose2::exp(step.fixed_rows::<3>(FIRST_ANCHOR_PLACE + 3 * slot).into());
        }
        moved
    }

    /// Moves all anchors but one.
    pub(crate) fn move_anchors(&mut self, new_from_old: &Pose2, fixed_slot: usize) {
        for (slot, anchor) in self.anchors.iter_mut().enumerate() {
            if slot != fixed_slot {
                *anchor = *new_from_old * *anchor;
            }
        }
    }

    /// The step that leads from `from` to here.
    pub(crate) fn since(&self, from: &Self) -> SVector<f64, BORDER_SIZE> {
        let mut step = SVector::<f64, BORDER_SIZE>::zeros();
        step[SCALE_PLACE] = self.scale - from.scale;
        step.fixed_rows_mut::<3>(WHEELS_PLACE).copy_from(&(self.wheels - from.wheels));
        step[DELAY_PLACE] = self.delay - from.delay;
        for slot in 0..ANCHOR_SLOTS {
            let moved = (from.anchors[slot].inverse() * self.anchors[slot]).log();
            step.fixed_rows_mut::<3>(FIRST_ANCHOR_PLACE + 3 * slot).copy_from(&moved);
        }
        step
    }
}
