//! The judge: drives a path in fine steps and looks for contact by sampling, on its own. One for all methods.

use trundle_core::{Pose2, wrap_angle};
use trundle_docking::MotionLimits;
use trundle_docking::corridor::{Answer, Piece, Problem, time_of};

/// How far a point of the robot moves from one sample to the next at most, m.
const STEP: f64 = 0.001;
/// How far from the goal is on it, m, ...
const PLACE: f64 = 0.01;
/// ... and rad.
const HEADING: f64 = std::f64::consts::PI / 180.0;
/// What numbers written and read may be off by.
const ROUNDING: f64 = 1e-9;

/// The path's time (s) when it touches nothing and ends on the goal, within 1 cm of distance and 1 deg; else what is wrong.
pub fn time(problem: &Problem, path: &[Piece]) -> Result<f64, String> {
    let scene = problem.scene().expect("valid");
    let arm = problem.footprint.circumscribed_radius();
    let touches =
        |pose: &Pose2| scene.clearance(&problem.footprint, pose, 1e-3).is_some_and(|(d, _)| d <= 0.0);
    let mut pose = problem.start;
    for (i, piece) in path.iter().enumerate() {
        let samples = ((piece.way.abs() + arm * piece.turn.abs()) / STEP).ceil().max(1.0);
        for k in 1..=samples as usize {
            let at = piece.after(&pose, k as f64 / samples);
            if touches(&at) {
                return Err(format!("touches something in piece {} at ({:.4}, {:.4}) m", i + 1, at.x, at.y));
            }
        }
        pose = piece.after(&pose, 1.0);
    }
    let (off, turned) = (pose.distance(&problem.goal), wrap_angle(pose.theta - problem.goal.theta).abs());
    if off > PLACE + ROUNDING || turned > HEADING + ROUNDING {
        return Err(format!("ends {:.1} mm and {:.2} deg off the goal", 1e3 * off, turned.to_degrees()));
    }
    Ok(time_of(path, &MotionLimits::default()))
}

/// Judges answers to problems, prints what became of each that is not good and a summary.
pub fn print(problems: &[Problem], answers: &[Answer]) {
    let (mut times, mut impossible, mut wrong, mut missing) = (Vec::new(), 0, 0, 0);
    for problem in problems {
        match answers.iter().find(|answer| answer.problem == problem.name).map(|answer| &answer.path) {
            None => missing += 1,
            Some(None) => impossible += 1,
            Some(Some(path)) => match time(problem, path) {
                Ok(time) => times.push(time),
                Err(reason) => {
                    wrong += 1;
                    println!("{}: {reason}", problem.name);
                }
            },
        }
    }
    let sum: f64 = times.iter().sum();
    println!(
        "{} problems: {} settled, {impossible} said to be impossible, {wrong} wrong, {missing} without an answer; {:.3} s on average",
        problems.len(),
        times.len(),
        sum / times.len().max(1) as f64
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_docking::corridor::Scenario;

    #[test]
    fn a_centimetre_is_a_distance() {
        let problem = Scenario::Free.problem();
        let off = |x: f64, y: f64| {
            let goal = problem.start * trundle_core::Pose2::new(x, y, 0.0);
            time(&Problem { goal, ..problem.clone() }, &[])
        };
        assert!(off(0.0099, 0.0).is_ok() && off(0.007, 0.007).is_ok());
        assert!(off(0.0101, 0.0).is_err() && off(0.008, 0.008).is_err());
    }
}
