//! The motion between two poses.

use trundle_core::{Hypotenuse, Pose2, Stamp, Twist2};

/// The mean twist between two poses of the base: the length of the step, always positive, and the turn by its time. Zero without time between.
pub(crate) fn twist_between((then, before): (Stamp, Pose2), (now, pose): (Stamp, Pose2)) -> Twist2 {
    let seconds = now - then;
    let step = before.inverse() * pose;
    if seconds > 0.0 {
        Twist2::new(step.x.hypotenuse(step.y) / seconds, step.theta / seconds)
    } else {
        Twist2::ZERO
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_and_its_time_give_the_twist() {
        let start = (Stamp::default(), Pose2::new(1.0, 1.0, 0.5));
        let end = |seconds| (start.0.after(seconds), Pose2::new(1.3, 1.4, 0.3));
        let twist = twist_between(start, end(2.0));
        assert!((twist.v - 0.25).abs() < 1e-12 && (twist.omega + 0.1).abs() < 1e-12, "{twist:?}");
        assert_eq!(twist_between(start, end(0.0)), Twist2::ZERO);
    }
}
