use crate::limits::MotionLimits;
use crate::manoeuvre::Motion;
use crate::space::Space;
use trundle_core::Pose2;

/// What counts as there.
#[derive(Debug, Clone, Copy)]
pub struct Tolerance {
    /// Metres.
    pub position: f64,
    /// Rad.
    pub heading: f64,
}

impl Tolerance {
    /// Whether a pose is there, by `part` of the tolerance.
    pub fn holds(&self, error: &Pose2, part: f64) -> bool {
        error.position().norm() <= part * self.position && error.theta.abs() <= part * self.heading
    }
}

/// One or two motions that end within `part` of the tolerance, when such are free: where the exact goal would take a whole
/// manoeuvre, being nearly there is worth more.
pub fn nearly(
    space: &mut Space<'_>,
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

fn is_free(space: &mut Space<'_>, mut pose: Pose2, motions: &[Motion]) -> bool {
    motions.iter().all(|motion| {
        let is_free = space.in_the_way(&pose, *motion).is_none();
        pose = motion.after(pose, motion.amount());
        is_free
    })
}
