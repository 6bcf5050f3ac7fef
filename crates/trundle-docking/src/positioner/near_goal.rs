//! Short motions onto the goal's tolerance.

use crate::contact_space::ContactSpace;
use crate::motion::limits::MotionLimits;
use crate::motion::manoeuvre::Motion;
use trundle_core::Pose2;

/// Tolerance of a goal.
#[derive(Debug, Clone, Copy)]
pub struct Tolerance {
    /// Position, m.
    pub position: f64,
    /// Heading, rad.
    pub heading: f64,
}

impl Tolerance {
    /// Whether an error is within `part` of the tolerance.
    pub fn holds(&self, error: &Pose2, part: f64) -> bool {
        error.position().norm() <= part * self.position && error.theta.abs() <= part * self.heading
    }
}

/// One or two free motions that end within `part` of the tolerance, if the exact goal would need a whole manoeuvre.
pub fn nearly(
    space: &mut ContactSpace<'_>,
    limits: &MotionLimits,
    pose: &Pose2,
    goal: &Pose2,
    tolerance: &Tolerance,
    part: f64,
) -> Option<Vec<Motion>> {
    let error = goal.inverse() * *pose;
    let turn = -error.theta;
    let seen = pose.inverse() * *goal;
    let lists = [
        vec![Motion::Turn(turn)],
        vec![Motion::Drive(seen.x)],
        vec![Motion::Drive(seen.x), Motion::Turn(turn)],
        vec![Motion::Turn(turn), Motion::Drive(-error.x)],
    ];
    let good = lists.into_iter().filter(|list| {
        let end = list.iter().fold(*pose, |pose, motion| motion.after(pose, motion.amount()));
        tolerance.holds(&(goal.inverse() * end), part) && is_free(space, *pose, list)
    });
    let pauses = |list: &[Motion]| (list.len() - 1) as f64 * limits.switch_time;
    let time = |list: &Vec<Motion>| list.iter().map(|m| m.time(limits)).sum::<f64>() + pauses(list);
    good.min_by(|a, b| time(a).total_cmp(&time(b)))
}

fn is_free(space: &mut ContactSpace<'_>, mut pose: Pose2, motions: &[Motion]) -> bool {
    motions.iter().all(|motion| {
        let is_free = space.blocker_of(&pose, *motion).is_none();
        pose = motion.after(pose, motion.amount());
        is_free
    })
}
