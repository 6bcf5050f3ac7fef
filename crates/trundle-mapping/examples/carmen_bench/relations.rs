//! The relations of \[Kuemmerle09\]: errors of relative poses against the reference's, in which one wrong turn does not affect all later
//! poses.

use trundle_core::{Pose2, Stamp, Vector2, wrap_angle};

#[derive(Clone, Copy, PartialEq)]
pub enum EntryKind {
    /// About 1 m of path apart.
    Near,
    /// About 10 m of path apart.
    Far,
    /// At the same place, at different times.
    Loop,
}

pub struct Relation {
    kind: EntryKind,
    from: Stamp,
    to: Stamp,
    relative: Pose2,
    /// Numbers of the reference's poses.
    poses: (usize, usize),
}

/// Smallest displacement in time between the poses of a loop, s: the relations of a file of that length or more are loops. Source: ours,
/// ten metres of path take less.
const LOOP_S: f64 = 60.0;

/// The surveyed relations of a file: lines of `t1 t2 x y z roll pitch yaw` (s, s, m, rad), as those of \[Kuemmerle09\].
pub fn surveyed(text: &str) -> Vec<Relation> {
    let relation = |line: &str| {
        let numbers: Vec<f64> = line.split_whitespace().map(|word| word.parse().unwrap()).collect();
        let [from, to, x, y, _, _, _, yaw] = numbers[..] else { panic!("8 numbers: {line}") };
        let relative = Pose2::new(x, y, yaw);
        let kind = match (to - from).abs() {
            duration if duration >= LOOP_S => EntryKind::Loop,
            _ if relative.position().norm() < 5.0 => EntryKind::Near,
            _ => EntryKind::Far,
        };
        let stamp = |seconds: f64| Stamp::from_nanos((seconds * 1e9).round() as i64);
        Relation { kind, from: stamp(from), to: stamp(to), relative, poses: (0, 0) }
    };
    text.lines().filter(|line| !line.trim().is_empty()).map(relation).collect()
}

/// The relations of a reference trajectory.
pub fn relations(reference: &[(Stamp, Pose2)]) -> Vec<Relation> {
    let mut found = Vec::new();
    let relation = |kind, i: usize, j: usize| {
        let ((from, a), (to, b)) = (reference[i], reference[j]);
        Relation { kind, from, to, relative: a.inverse() * b, poses: (i, j) }
    };
    for i in 0..reference.len() {
        let mut travelled = 0.0;
        let mut next = [(1.0, EntryKind::Near), (10.0, EntryKind::Far)].into_iter().peekable();
        for j in i + 1..reference.len() {
            travelled += reference[j].1.distance(&reference[j - 1].1);
            while next
                .next_if(|(length, kind)| {
                    travelled >= *length && {
                        found.push(relation(*kind, i, j));
                        true
                    }
                })
                .is_some()
            {}
            if next.peek().is_none() {
                break;
            }
        }
        // For each later visit of this place, after more than 40 m of path, the nearest pose.
        let mut travelled = 0.0;
        let mut nearest: Option<(f64, usize)> = None;
        for j in i + 1..reference.len() {
            travelled += reference[j].1.distance(&reference[j - 1].1);
            let distance = reference[i].1.distance(&reference[j].1);
            if travelled > 40.0 && distance < 2.0 {
                if nearest.is_none_or(|(min, _)| distance < min) {
                    nearest = Some((distance, j));
                }
            } else if let Some((_, j)) = nearest.take() {
                found.push(relation(EntryKind::Loop, i, j));
            }
        }
    }
    found
}

/// Errors of a relation, m and deg.
type Error = (f64, f64);

/// Agreement of an estimate with a reference.
pub struct Agreement {
    by_kind: [Vec<Error>; 3],
    all: Vec<Error>,
    /// Errors of relations that do not touch the excluded poses.
    rest: Option<Vec<Error>>,
    /// RMSE of the positions, m.
    absolute: f64,
}

/// Loops that are farther off than this are not closed, m: more than the reference itself is. Source: ours.
const OPEN: f64 = 3.0;

impl Agreement {
    /// None without a reference. `but`: poses of the reference, from and up to.
    pub fn of(
        relations: &[Relation],
        reference: &[(Stamp, Pose2)],
        estimate: &[(Stamp, Pose2)],
        but: Option<(usize, usize)>,
    ) -> Option<Self> {
        let at = |stamp: Stamp| {
            let i = estimate.partition_point(|(s, _)| *s < stamp.after(-1e-4));
            estimate.get(i).filter(|(s, _)| (*s - stamp).abs() < 1e-3).map(|(_, pose)| *pose)
        };
        let error = |r: &Relation| {
            let error = r.relative.inverse() * (at(r.from)?.inverse() * at(r.to)?);
            Some((error.position().norm(), wrap_angle(error.theta).abs().to_degrees()))
        };
        let errors = |which: &dyn Fn(&Relation) -> bool| -> Vec<Error> {
            relations.iter().filter(|r| which(r)).filter_map(error).collect()
        };
        let pairs: Vec<(Vector2, Vector2)> =
            reference.iter().filter_map(|(s, p)| Some((p.position(), at(*s)?.position()))).collect();
        (!relations.is_empty()).then(|| Self {
            by_kind: [EntryKind::Near, EntryKind::Far, EntryKind::Loop]
                .map(|kind| errors(&|r| r.kind == kind)),
            all: errors(&|_| true),
            rest: but.map(|(from, to)| {
                let out = |pose: usize| (from..to).contains(&pose);
                errors(&|r| !out(r.poses.0) && !out(r.poses.1))
            }),
            absolute: absolute(&pairs),
        })
    }

    /// Mean error of all relations, m.
    pub fn mean(&self) -> f64 {
        self.all.iter().map(|e| e.0).sum::<f64>() / self.all.len().max(1) as f64
    }

    /// Mean error of the turns of all relations, deg.
    pub fn mean_turn(&self) -> f64 {
        self.all.iter().map(|e| e.1).sum::<f64>() / self.all.len().max(1) as f64
    }

    /// Number of loop relations with an error so large that the loop is not closed.
    pub fn open_loops(&self) -> usize {
        self.by_kind[2].iter().filter(|e| e.0 > OPEN).count()
    }
}

/// Mean and standard deviation of the errors, by kind; then the error of the whole trajectory.
impl std::fmt::Display for Agreement {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (name, errors) in ["1 m", "10 m", "loops"].iter().zip(&self.by_kind) {
            write!(f, "{name} ({}) {}; ", errors.len(), summary(errors))?;
        }
        write!(f, "{} loops open; all {}; ", self.open_loops(), summary(&self.all))?;
        if let Some(rest) = &self.rest {
            write!(f, "without the poses left out ({}) {}; ", rest.len(), summary(rest))?;
        }
        write!(f, "ATE {:.3} m", self.absolute)
    }
}

fn summary(errors: &[Error]) -> String {
    let n = errors.len().max(1) as f64;
    let mean = |f: fn(&Error) -> f64| errors.iter().map(f).sum::<f64>() / n;
    let spread = |f: fn(&Error) -> f64| {
        let m = mean(f);
        (errors.iter().map(|e| (f(e) - m).powi(2)).sum::<f64>() / n).sqrt()
    };
    format!("{:.3}+-{:.3} m {:.2}+-{:.2} deg", mean(|e| e.0), spread(|e| e.0), mean(|e| e.1), spread(|e| e.1))
}

/// RMSE after the best rigid alignment.
fn absolute(pairs: &[(Vector2, Vector2)]) -> f64 {
    let n = pairs.len() as f64;
    let (a, b) = pairs.iter().fold((Vector2::zeros(), Vector2::zeros()), |(a, b), (p, q)| (a + p, b + q));
    let (a, b) = (a / n, b / n);
    let (dot, cross) = pairs.iter().fold((0.0, 0.0), |(d, c), (p, q)| {
        let (p, q) = (p - a, q - b);
        (d + q.dot(&p), c + q.perp(&p))
    });
    let turn = Pose2::new(0.0, 0.0, cross.atan2(dot));
    (pairs.iter().map(|(p, q)| (turn.rotate(q - b) + a - p).norm_squared()).sum::<f64>() / n).sqrt()
}
