//! Corridor problems as text.

use crate::corridor::problem::Problem;
use crate::scene::obstacle_scene::Obstacle;
use std::fmt::Write;
use trundle_core::{Footprint, Invalid, Pose2, Vector2};

/// Number of characters of an invalid line in a message. Source: ours.
const MAX_SHOWN_CHARACTERS: usize = 60;

/// The first line of a file.
const HEADER: &str = "trundle-corridors 1";

/// Problems as text, metres and degrees: the first word of a line is its kind, numbers follow. Numbers are exact.
pub fn write(problems: &[Problem]) -> String {
    let mut text = format!("{HEADER}\n");
    for problem in problems {
        one(problem, &mut text).expect("invariant: a string takes all that is written");
    }
    text
}

fn one(problem: &Problem, text: &mut String) -> std::fmt::Result {
    writeln!(text, "\nproblem {}", problem.name)?;
    match &problem.footprint {
        Footprint::Disc { radius } => writeln!(text, "disc {radius}")?,
        Footprint::Polygon { corners } => writeln!(text, "footprint{}", numbers(corners))?,
    }
    for (word, pose) in [("start", problem.start), ("goal", problem.goal)] {
        writeln!(text, "{word} {} {} {}", pose.x, pose.y, pose.theta.to_degrees())?;
    }
    for obstacle in &problem.obstacles {
        match obstacle {
            Obstacle::Point(p) => writeln!(text, "point{}", numbers(&[*p]))?,
            Obstacle::Segment(a, b) => writeln!(text, "wall{}", numbers(&[*a, *b]))?,
            Obstacle::Polygon(corners) => writeln!(text, "box{}", numbers(corners))?,
        }
    }
    Ok(())
}

fn numbers(points: &[Vector2]) -> String {
    points.iter().map(|p| format!(" {} {}", p.x, p.y)).collect()
}

/// Problems from text; `#` begins a comment.
///
/// # Errors
/// When a line does not match the format; the error contains the line.
pub fn parse(text: &str) -> Result<Vec<Problem>, Invalid> {
    let mut lines =
        text.lines().enumerate().map(|(i, line)| (i + 1, line.split('#').next().unwrap_or("").trim()));
    let mut lines = lines.by_ref().filter(|(_, line)| !line.is_empty());
    match lines.next() {
        Some((_, HEADER)) => {}
        other => return Err(refused(1, other.map_or("", |(_, line)| line), HEADER)),
    }
    let mut problems: Vec<Problem> = Vec::new();
    let (mut given, mut began) = (ReadParts::default(), 1);
    for (number, line) in lines {
        let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
        if word == "problem" {
            if let Some(last) = problems.last() {
                given.checked(began, &last.name)?;
            }
            if rest.trim().is_empty() {
                return Err(refused(number, line, "problem NAME"));
            }
            (given, began) = (ReadParts::default(), number);
            problems.push(empty(rest.trim()));
            continue;
        }
        let problem = problems.last_mut().ok_or_else(|| refused(number, word, "`problem NAME` first"))?;
        let points = || points_of(number, rest);
        given.note(word);
        match word {
            "disc" => {
                let radius = floats(number, rest, 1)?[0];
                problem.footprint = Footprint::disc(radius).map_err(|e| in_line(number, e))?;
            }
            "footprint" => {
                problem.footprint = Footprint::polygon(points()?).map_err(|e| in_line(number, e))?;
            }
            "start" => problem.start = pose(number, rest)?,
            "goal" => problem.goal = pose(number, rest)?,
            "point" => problem.obstacles.extend(points()?.into_iter().map(Obstacle::Point)),
            "wall" => match points()?[..] {
                [a, b] => problem.obstacles.push(Obstacle::Segment(a, b)),
                _ => return Err(refused(number, rest, "wall X Y X Y")),
            },
            "box" => problem.obstacles.push(Obstacle::Polygon(points()?)),
            _ => {
                return Err(refused(
                    number,
                    word,
                    "problem, disc, footprint, start, goal, point, wall or box",
                ));
            }
        }
    }
    if let Some(last) = problems.last() {
        given.checked(began, &last.name)?;
    }
    Ok(problems)
}

/// Parts of a problem that have been read.
#[derive(Debug, Clone, Copy, Default)]
struct ReadParts {
    footprint: bool,
    start: bool,
    goal: bool,
}

impl ReadParts {
    fn note(&mut self, word: &str) {
        self.footprint |= word == "footprint" || word == "disc";
        self.start |= word == "start";
        self.goal |= word == "goal";
    }

    /// Refuses a problem, which began on a line, without one of its three parts.
    fn checked(&self, began: usize, name: &str) -> Result<(), Invalid> {
        let parts = [(self.footprint, "footprint or disc"), (self.start, "start"), (self.goal, "goal")];
        match parts.into_iter().find(|(is_given, _)| !is_given) {
            Some((_, part)) => Err(refused(began, name, &format!("a problem with a line `{part}`"))),
            None => Ok(()),
        }
    }
}

fn empty(name: &str) -> Problem {
    Problem {
        name: name.to_owned(),
        footprint: Footprint::KOBUKI,
        start: Pose2::IDENTITY,
        goal: Pose2::IDENTITY,
        obstacles: Vec::new(),
    }
}

fn pose(number: usize, text: &str) -> Result<Pose2, Invalid> {
    let n = floats(number, text, 3)?;
    Ok(Pose2::new(n[0], n[1], n[2].to_radians()))
}

fn points_of(number: usize, text: &str) -> Result<Vec<Vector2>, Invalid> {
    let n = floats(number, text, 0)?;
    if n.is_empty() || n.len() % 2 == 1 {
        return Err(refused(number, text, "pairs X Y"));
    }
    Ok(n.chunks_exact(2).map(|p| Vector2::new(p[0], p[1])).collect())
}

/// The finite numbers of a line; exactly `count` unless that is 0.
pub(super) fn floats(number: usize, text: &str, count: usize) -> Result<Vec<f64>, Invalid> {
    let parsed: Option<Vec<f64>> =
        text.split_whitespace().map(|word| word.parse().ok().filter(|x: &f64| x.is_finite())).collect();
    match parsed {
        Some(list) if count == 0 || list.len() == count => Ok(list),
        _ => Err(refused(number, text, "finite numbers, as many as the word takes")),
    }
}

/// The error with its line number.
fn in_line(number: usize, error: Invalid) -> Invalid {
    Invalid { field: format!("line {number}: {}", error.field), ..error }
}

pub(super) fn refused(number: usize, value: &str, expected: &str) -> Invalid {
    let mut shown: String = value.chars().take(MAX_SHOWN_CHARACTERS).collect();
    if shown.len() < value.len() {
        shown.push_str("...");
    }
    Invalid::new(format!("line {number}"), format!("`{shown}`"), "", expected)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::corridor::generate::generate;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn written_problems_are_read_back() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let problems: Vec<_> = (0..20).map(|i| generate(format!("p{i}"), &mut rng)).collect();
        let read = parse(&write(&problems)).unwrap();
        for (a, b) in problems.iter().zip(&read) {
            assert_eq!((&a.name, &a.footprint, &a.obstacles), (&b.name, &b.footprint, &b.obstacles));
            assert!((a.goal.theta - b.goal.theta).abs() < 1e-15 && a.start.distance(&b.start) == 0.0);
        }
    }

    #[test]
    fn invalid_lines_are_refused_with_their_number() {
        let message = |text: &str| parse(text).unwrap_err().to_string();
        assert!(message("corridors").starts_with("line 1 is `corridors`"));
        assert!(message("trundle-corridors 1\nwall 0 0 1 1").starts_with("line 2"));
        assert!(message("trundle-corridors 1\nproblem a\nwall 0 0 1 NaN").starts_with("line 3"));
        assert!(message("trundle-corridors 1\nproblem a\nhole 0 0").contains("line 3 is `hole`"));
        assert!(message("trundle-corridors 1\nproblem").contains("problem NAME"));
        let whole = "trundle-corridors 1\nproblem a\ndisc 0.2\nstart 0 0 0\ngoal 1 0 0\n";
        assert!(parse(whole).is_ok());
        for part in ["disc 0.2\n", "start 0 0 0\n", "goal 1 0 0\n"] {
            let error = message(&whole.replace(part, ""));
            let word = part.split(' ').next().unwrap();
            assert!(error.starts_with("line 2 is `a`") && error.contains(word), "{error}");
        }
    }
}
