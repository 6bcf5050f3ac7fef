//! The judge: drives a manoeuvre in fine steps and looks for contact by sampling, on its own.

use trundle_core::wrap_angle;
use trundle_docking::Manoeuvre;
use trundle_docking::corridor::Problem;

/// Whether a manoeuvre begins and ends where it should, within 1 cm and 1 deg, and touches nothing on the way.
pub fn is_good(problem: &Problem, manoeuvre: &Manoeuvre) -> bool {
    let scene = problem.scene().expect("valid");
    let end = manoeuvre.end();
    let at_goal =
        end.distance(&problem.goal) <= 0.0142 && wrap_angle(end.theta - problem.goal.theta).abs() <= 0.0175;
    let samples = (manoeuvre.duration() / 0.02).ceil() as usize;
    let free = |i| {
        let (pose, _) = manoeuvre.at(manoeuvre.duration() * i as f64 / samples.max(1) as f64);
        scene.clearance(&problem.footprint, &pose, 1e-3).is_none_or(|(clearance, _)| clearance > 0.0)
    };
    let begins = manoeuvre.start().distance(&problem.start) < 1e-9;
    begins && at_goal && (0..=samples).all(free)
}
