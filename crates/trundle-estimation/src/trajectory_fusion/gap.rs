//! Poses of the frames between two located ones, by the odometry.

use super::odometry_path::OdometryPath;
use trundle_core::{CameraMotion, Pose3};
use trundle_optim::{PoseConstraint, PoseGraph, PoseGraphConfig};

/// A run of frames that were not located, with the odometry along it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gap<'a> {
    /// Pose of the frame before the run, if placed.
    pub(super) before: Option<Pose3>,
    /// Pose of the frame after the run, if placed.
    pub(super) after: Option<Pose3>,
    /// Motion to each frame of the run, and to the frame after it.
    pub(super) steps: &'a [Option<CameraMotion>],
    /// Number of frames in the run.
    pub(super) frames: usize,
}

impl Gap<'_> {
    /// The poses of the run's frames: by both ends and all steps, else by the measured steps from either end.
    pub(super) fn poses(&self) -> Vec<Option<Pose3>> {
        if let Some(poses) = self.between_both_ends() {
            return poses.into_iter().map(Some).collect();
        }
        let mut poses = self.forward();
        let mut next = self.after;
        for i in (0..self.frames).rev() {
            let step = self.steps.get(i + 1).copied().flatten();
            next = next.zip(step).map(|(pose, step)| (pose * step.motion.inverse()).renormalized());
            poses[i] = poses[i].or(next);
            if next.is_none() {
                break;
            }
        }
        poses
    }

    /// Dead reckoning from the frame before the run.
    fn forward(&self) -> Vec<Option<Pose3>> {
        let step = |pose: &mut Option<Pose3>, step: &Option<CameraMotion>| {
            *pose = pose.zip(*step).map(|(pose, step)| (pose * step.motion).renormalized());
            Some(*pose)
        };
        self.steps[..self.frames].iter().scan(self.before, step).collect()
    }

    /// The most probable poses between the two ends; `None` if an end or a step is missing.
    fn between_both_ends(&self) -> Option<Vec<Pose3>> {
        let (before, after) = (self.before?, self.after?);
        let inner: Option<Vec<Pose3>> = self.forward().into_iter().collect();
        let poses: Vec<Pose3> = [vec![before], inner?, vec![after]].concat();
        let constraint = |(i, step): (usize, &Option<CameraMotion>)| {
            let path = OdometryPath::over([*step])?;
            Some(PoseConstraint {
                from: i,
                to: i + 1,
                from_to: path.motion,
                information: path.information()?,
            })
        };
        let constraints: Option<Vec<PoseConstraint>> =
            self.steps.iter().enumerate().map(constraint).collect();
        let mut fixed = vec![false; poses.len()];
        (fixed[0], fixed[poses.len() - 1]) = (true, true);
        let graph = PoseGraph::new(poses, &fixed, constraints?).ok()?;
        let solution = graph.solve(&PoseGraphConfig::default());
        Some(solution.poses[1..=self.frames].to_vec())
    }
}
