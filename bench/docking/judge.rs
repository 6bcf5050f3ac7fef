//! The checker: drives a path in fine steps and looks for contact by sampling, on its own. One for all methods.

use std::collections::BTreeMap;
use trundle_core::{Pose2, wrap_angle};
use trundle_docking::MotionLimits;
use trundle_docking::corridor::{PathPiece, Problem, ProblemAnswer, time_of};

/// How far a point of the robot moves from one sample to the next at most, m. Source: ours.
const STEP: f64 = 0.001;
/// How far from the goal is on it, m. Source: ours.
const PLACE: f64 = 0.01;
/// Heading error that counts as none, rad. Source: ours.
const HEADING: f64 = std::f64::consts::PI / 180.0;
/// Largest error of numbers written and read. Source: ours.
const ROUNDING: f64 = 1e-9;

/// The path's time (s) when it touches nothing and ends on the goal, within 1 cm of distance and 1 deg; else what is wrong.
pub fn time(problem: &Problem, path: &[PathPiece]) -> Result<f64, String> {
    let scene = problem.scene().expect("valid");
    let arm = problem.footprint.circumscribed_radius();
    let touches =
        |pose: &Pose2| scene.clearance(&problem.footprint, pose, 1e-3).is_some_and(|(d, _)| d <= 0.0);
    let mut pose = problem.start;
    for (i, piece) in path.iter().enumerate() {
        let samples = ((piece.distance.abs() + arm * piece.turn.abs()) / STEP).ceil().max(1.0);
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

/// Results of the answers to some problems.
#[derive(Debug, Default)]
pub struct Judged {
    /// Time of each path that is good, s.
    pub times: Vec<f64>,
    /// Problems that are said to be impossible.
    pub impossible: usize,
    /// Each wrong answer, with the reason.
    pub wrong: Vec<String>,
    /// Problems without an answer.
    pub missing: usize,
}

/// Evaluates answers to problems; refuses two answers to one problem, and one to a problem that there is not.
pub fn judge(problems: &[Problem], answers: &[ProblemAnswer]) -> Result<Judged, String> {
    let mut open: BTreeMap<&str, &ProblemAnswer> = BTreeMap::new();
    for answer in answers {
        if open.insert(&answer.problem, answer).is_some() {
            return Err(format!("two answers to problem `{}`", answer.problem));
        }
    }
    let mut judged = Judged::default();
    for problem in problems {
        judged.note(problem, open.remove(problem.name.as_str()));
    }
    match open.keys().next() {
        Some(name) => Err(format!("an answer to problem `{name}`, which is none of the {}", problems.len())),
        None => Ok(judged),
    }
}

impl Judged {
    /// Evaluates the answer to a problem; `None` if there is none.
    pub fn note(&mut self, problem: &Problem, answer: Option<&ProblemAnswer>) {
        match answer.map(|answer| &answer.path) {
            None => self.missing += 1,
            Some(None) => self.impossible += 1,
            Some(Some(path)) => match time(problem, path) {
                Ok(time) => self.times.push(time),
                Err(reason) => self.refuse(problem, &reason),
            },
        }
    }

    /// Counts a wrong answer.
    pub fn refuse(&mut self, problem: &Problem, reason: &str) {
        self.wrong.push(format!("{}: {reason}", problem.name));
    }

    /// A line for each wrong answer, and one for all.
    pub fn summary(&self) -> String {
        let Self { times, impossible, wrong, missing } = self;
        let count = times.len() + impossible + wrong.len() + missing;
        let mean = times.iter().sum::<f64>() / times.len().max(1) as f64;
        let lines: String = wrong.iter().map(|line| format!("{line}\n")).collect();
        format!(
            "{lines}{count} problems: {} settled, {impossible} said to be impossible, {} wrong, {missing} without an answer; {mean:.3} s \
             on average",
            times.len(),
            wrong.len()
        )
    }
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

    /// Answers written by hand to the paper's scenarios.
    #[test]
    fn answers_by_hand_are_judged() {
        let problems = Scenario::ALL.map(Scenario::problem);
        let read = |text: &str| trundle_docking::corridor::parse_answers(text).unwrap();
        let judged = judge(&problems, &read(include_str!("answers_by_hand.txt"))).unwrap();
        assert_eq!((judged.times.len(), judged.impossible, judged.missing), (2, 0, 1));
        // 2 (1.2 rad/s, 3 rad/s^2 over 90 deg) + 1 (0.25 m/s, 0.5 m/s^2 over 0.2 m) + 2 pauses.
        let turn = std::f64::consts::FRAC_PI_2 / 1.2 + 0.4;
        assert!((judged.times[0] - (2.0 * turn + 1.3 + 1.0)).abs() < 1e-9, "{:?}", judged.times);
        assert!(judged.wrong[0].starts_with("hong24-b: touches something in piece 1"), "{:?}", judged.wrong);
        assert!(
            judged.summary().contains("4 problems: 2 settled, 0 said to be impossible, 1 wrong, 1 without")
        );
        let twice = judge(&problems, &read("trundle-answers 1\nproblem hong24-a\nproblem hong24-a\n"));
        assert!(twice.unwrap_err().contains("two answers to problem `hong24-a`"));
        let unknown = judge(&problems, &read("trundle-answers 1\nproblem x\nturn 3\n"));
        assert!(unknown.unwrap_err().contains("`x`, which is none of the 4"));
    }
}
