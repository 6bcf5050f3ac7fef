//! Answers to corridor problems, as text.

use crate::corridor::format::{floats, refused};
use crate::motion::limits::MotionLimits;
use crate::motion::manoeuvre::{Manoeuvre, Motion};
use std::fmt::Write;
use trundle_core::{Invalid, Pose2, Twist2};

/// The first line of a file.
const HEADER: &str = "trundle-answers 1";

/// An answer to a problem.
#[derive(Debug, Clone, PartialEq)]
pub struct ProblemAnswer {
    /// The problem's name.
    pub problem: String,
    /// The motions from the problem's start; `None` for the answer "impossible".
    pub path: Option<Vec<PathPiece>>,
}

/// A part of a path, from rest to rest: a turn in place, a straight move, an arc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathPiece {
    /// Distance along the path, m, backward negative; 0 for a turn in place.
    pub distance: f64,
    /// Change of heading, rad, counter-clockwise positive; 0 for a straight.
    pub turn: f64,
}

impl From<Motion> for PathPiece {
    fn from(motion: Motion) -> Self {
        match motion {
            Motion::Turn(turn) => Self { distance: 0.0, turn },
            Motion::Drive(distance) => Self { distance, turn: 0.0 },
        }
    }
}

impl PathPiece {
    /// The pieces of a manoeuvre.
    pub fn all_of(manoeuvre: &Manoeuvre) -> Vec<Self> {
        manoeuvre.steps().iter().map(|step| step.motion.into()).collect()
    }

    /// Pose of a base that started at `from`, after `part` (0 to 1) of the piece.
    pub fn after(&self, from: &Pose2, part: f64) -> Pose2 {
        from.advance(Twist2::new(self.distance * part, self.turn * part), 1.0)
    }

    /// Minimum time from rest to rest, s: of its distance or of its turn, whichever is longer.
    pub fn time(&self, limits: &MotionLimits) -> f64 {
        limits.drive_time(self.distance).max(limits.turn_time(self.turn))
    }
}

/// Time of a path, s: every piece from rest to rest, with a pause (`switch_time`) between two, except for pieces that continue in the same
/// direction.
pub fn time_of(path: &[PathPiece], limits: &MotionLimits) -> f64 {
    let pauses = path.windows(2).filter(|pair| pair[0].distance * pair[1].distance <= 0.0).count();
    path.iter().map(|piece| piece.time(limits)).sum::<f64>() + pauses as f64 * limits.switch_time
}

/// Answers as text, metres and degrees. Numbers are exact.
pub fn write_answers(answers: &[ProblemAnswer]) -> String {
    let mut text = format!("{HEADER}\n");
    for answer in answers {
        one(answer, &mut text).expect("invariant: a string takes all that is written");
    }
    text
}

fn one(answer: &ProblemAnswer, text: &mut String) -> std::fmt::Result {
    writeln!(text, "\nproblem {}", answer.problem)?;
    let Some(path) = &answer.path else { return writeln!(text, "impossible") };
    path.iter().try_for_each(|piece| match (piece.distance, piece.turn) {
        (0.0, turn) => writeln!(text, "turn {}", turn.to_degrees()),
        (distance, 0.0) => writeln!(text, "drive {distance}"),
        (distance, turn) => writeln!(text, "arc {distance} {}", turn.to_degrees()),
    })
}

/// Answers from text; `#` begins a comment.
///
/// # Errors
/// When a line does not match the format; the error contains the line.
pub fn parse_answers(text: &str) -> Result<Vec<ProblemAnswer>, Invalid> {
    let lines =
        text.lines().enumerate().map(|(i, line)| (i + 1, line.split('#').next().unwrap_or("").trim()));
    let mut lines = lines.filter(|(_, line)| !line.is_empty());
    match lines.next() {
        Some((_, HEADER)) => {}
        other => return Err(refused(1, other.map_or("", |(_, line)| line), HEADER)),
    }
    let mut answers: Vec<ProblemAnswer> = Vec::new();
    for (number, line) in lines {
        let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
        if word == "problem" {
            answers.push(ProblemAnswer { problem: rest.to_owned(), path: Some(Vec::new()) });
            continue;
        }
        let answer = answers.last_mut().ok_or_else(|| refused(number, word, "`problem NAME` first"))?;
        let piece = match word {
            "turn" => PathPiece { distance: 0.0, turn: floats(number, rest, 1)?[0].to_radians() },
            "drive" => PathPiece { distance: floats(number, rest, 1)?[0], turn: 0.0 },
            "arc" => {
                let n = floats(number, rest, 2)?;
                PathPiece { distance: n[0], turn: n[1].to_radians() }
            }
            "impossible" => {
                answer.path = None;
                continue;
            }
            _ => return Err(refused(number, word, "problem, turn, drive, arc or impossible")),
        };
        match &mut answer.path {
            Some(path) => path.push(piece),
            None => return Err(refused(number, line, "nothing after `impossible`")),
        }
    }
    Ok(answers)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn written_answers_are_read_back() {
        let path = vec![
            PathPiece { distance: 0.0, turn: 0.5 },
            PathPiece { distance: -0.25, turn: 0.0 },
            PathPiece { distance: 0.1, turn: -0.2 },
        ];
        let answers = [
            ProblemAnswer { problem: "a".to_owned(), path: Some(path) },
            ProblemAnswer { problem: "b".to_owned(), path: None },
            ProblemAnswer { problem: "c".to_owned(), path: Some(Vec::new()) },
        ];
        let read = parse_answers(&write_answers(&answers)).unwrap();
        assert_eq!(read.len(), 3);
        for (a, b) in answers.iter().zip(&read) {
            assert_eq!((&a.problem, a.path.is_some()), (&b.problem, b.path.is_some()));
            let pieces = |answer: &ProblemAnswer| answer.path.clone().unwrap_or_default();
            for (p, q) in pieces(a).iter().zip(&pieces(b)) {
                assert!(p.distance == q.distance && (p.turn - q.turn).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn invalid_lines_are_refused_with_their_number() {
        let message = |text: &str| parse_answers(text).unwrap_err().to_string();
        assert!(message("answers").starts_with("line 1 is `answers`"));
        assert!(message("trundle-answers 1\nturn 3").starts_with("line 2"));
        assert!(message("trundle-answers 1\nproblem a\nturn NaN").starts_with("line 3"));
        assert!(message("trundle-answers 1\nproblem a\nfly 3").contains("`fly`"));
        assert!(message("trundle-answers 1\nproblem a\nimpossible\nturn 3").contains("nothing after"));
    }

    #[test]
    fn the_time_of_a_path_is_that_of_its_manoeuvre() {
        let limits = MotionLimits::default();
        let motions = [Motion::Turn(0.4), Motion::Drive(0.3), Motion::Turn(-1.0), Motion::Drive(-0.02)];
        let manoeuvre = Manoeuvre::new(Pose2::IDENTITY, &motions, limits);
        assert!((time_of(&PathPiece::all_of(&manoeuvre), &limits) - manoeuvre.duration()).abs() < 1e-12);
    }
}
