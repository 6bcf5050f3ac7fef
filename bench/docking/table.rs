//! The table of the benchmark, and the list behind it.

use crate::judge;
use crate::world::Run;
use std::fmt::Write;
use trundle_docking::corridor::{PathPiece, Problem, ProblemAnswer};

/// Results of one method on all problems.
pub struct Row {
    /// Its name.
    pub name: &'static str,
    /// Time of the manoeuvre on each problem, s; `None` if it was not settled.
    pub times: Vec<Option<f64>>,
    /// Proven impossible by any motion.
    pub never: usize,
    /// Certified impossible at 1 cm.
    pub at_resolution: usize,
    /// Problems without an answer.
    pub unsolved: Vec<String>,
    /// Problems with contact or a missed goal.
    pub bad: Vec<String>,
    /// Of planning, or of all control steps of a run, ms on one core.
    pub planning_ms: Vec<f64>,
    /// Motions of each manoeuvre; 0 if there is none.
    pub steps: Vec<usize>,
    /// A time that no manoeuvre beats, s, if one was settled.
    pub bounds: Vec<Option<f64>>,
    /// Result for each problem.
    pub answers: Vec<ProblemAnswer>,
}

impl Row {
    /// An empty row.
    pub fn new(name: &'static str) -> Self {
        Self {
            name,
            times: Vec::new(),
            never: 0,
            at_resolution: 0,
            unsolved: Vec::new(),
            bad: Vec::new(),
            planning_ms: Vec::new(),
            steps: Vec::new(),
            bounds: Vec::new(),
            answers: Vec::new(),
        }
    }

    /// Has a path evaluated; none is not an answer.
    pub fn note(&mut self, problem: &Problem, path: Option<Vec<PathPiece>>) {
        let judged = path.as_ref().map(|path| judge::time(problem, path));
        match &judged {
            None => self.unsolved.push(problem.name.clone()),
            Some(Err(_)) => self.bad.push(problem.name.clone()),
            Some(Ok(_)) => {}
        }
        self.times.push(judged.and_then(Result::ok));
        self.answers.push(ProblemAnswer { problem: problem.name.clone(), path });
    }
}

/// Results of one method in closed loop.
pub struct Track {
    name: &'static str,
    runs: Vec<(String, Run)>,
}

impl Track {
    /// An empty track.
    pub fn new(name: &'static str) -> Self {
        Self { name, runs: Vec::new() }
    }

    /// Notes a run.
    pub fn note(&mut self, problem: &Problem, run: Run) {
        self.runs.push((problem.name.clone(), run));
    }
}

/// Prints the closed loops; times are compared with the first track's, where both settled.
pub fn print_closed_loop(tracks: &[Track]) {
    let good = |run: &Run| run.settled && run.within && !run.contact;
    println!(
        "\n| closed loop | problems | within 1 cm and 1 deg | with contact | time / first row's, median (p95) |"
    );
    println!("|---|---|---|---|---|");
    for track in tracks {
        let count = track.runs.len();
        let settled = track.runs.iter().filter(|(_, run)| good(run)).count();
        let contacts = track.runs.iter().filter(|(_, run)| run.contact).count();
        let pairs = track.runs.iter().zip(&tracks[0].runs).filter(|((_, a), (_, b))| good(a) && good(b));
        let ratios: Vec<f64> = pairs.map(|((_, a), (_, b))| a.time / b.time).collect();
        println!(
            "| {} | {count} | {settled} ({:.1} %) | {contacts} | {:.2} ({:.2}) |",
            track.name,
            100.0 * settled as f64 / count.max(1) as f64,
            part(&ratios, 0.5),
            part(&ratios, 0.95)
        );
    }
    for track in tracks {
        let share = |is: &dyn Fn(&Run) -> bool| track.runs.iter().filter(|(_, run)| is(run)).count();
        let within = 100.0 * share(&good) as f64 / track.runs.len().max(1) as f64;
        let contacts = share(&|run: &Run| run.contact);
        println!("{}: within 1 cm and 1 deg: {within:.1} %, runs with contact: {contacts}", track.name);
    }
    for (name, run) in tracks[0].runs.iter().filter(|(_, run)| !good(run)) {
        println!(
            "{} {name}: settled {}, within {}, contact {}, {:.1} s, {} motions",
            tracks[0].name, run.settled, run.within, run.contact, run.time, run.motions
        );
    }
    let motions: usize = tracks[0].runs.iter().map(|(_, run)| run.motions).sum();
    println!("{}: {:.2} motions each", tracks[0].name, motions as f64 / tracks[0].runs.len().max(1) as f64);
}

/// Prints the rows; times are compared with those of the first row, problem by problem.
pub fn print(rows: &[Row]) {
    println!(
        "| method | problems | settled | never (at 1 cm) | no answer | contact or missed | time / first row's, median (p95) | planning ms, median (p99, most) |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for row in rows {
        let pairs = row.times.iter().zip(&rows[0].times);
        let ratios: Vec<f64> = pairs.filter_map(|(a, b)| Some((*a)? / (*b)?)).collect();
        let count = row.times.len();
        let settled = row.times.iter().flatten().count();
        println!(
            "| {} | {count} | {settled} ({:.2} %) | {} ({}) | {} | {} | {:.3} ({:.3}) | {:.2} ({:.1}, {:.0}) |",
            row.name,
            100.0 * settled as f64 / count as f64,
            row.never,
            row.at_resolution,
            row.unsolved.len(),
            row.bad.len(),
            part(&ratios, 0.5),
            part(&ratios, 0.95),
            part(&row.planning_ms, 0.5),
            part(&row.planning_ms, 0.99),
            part(&row.planning_ms, 1.0),
        );
    }
    println!();
    for row in rows {
        let answered = row.times.iter().flatten().count() + row.never + row.at_resolution;
        let [median, p99] = [0.5, 0.99].map(|q| part(&row.planning_ms, q));
        println!("{}: settled or proven impossible: {answered}", row.name);
        println!("{}: median planning time: {median:.2} ms", row.name);
        println!("{}: p99 planning time: {p99:.1} ms", row.name);
    }
    for row in rows {
        let over: Vec<f64> = row
            .times
            .iter()
            .zip(&row.bounds)
            .filter_map(|(time, bound)| Some((*time)? / (*bound)?))
            .collect();
        if !over.is_empty() {
            let at = |q| part(&over, q);
            println!(
                "\n{}: time over the proven bound: median {:.4}, p90 {:.4}, p95 {:.4}, p99 {:.4}",
                row.name,
                at(0.5),
                at(0.9),
                at(0.95),
                at(0.99)
            );
        }
        if !row.unsolved.is_empty() || !row.bad.is_empty() {
            println!("{}: no answer {:?}; bad {:?}", row.name, first(&row.unsolved), first(&row.bad));
        }
    }
    let sum: f64 = rows[0].times.iter().flatten().sum();
    println!(
        "\n{}: {:.3} s on average",
        rows[0].name,
        sum / rows[0].times.iter().flatten().count().max(1) as f64
    );
}

/// Result of each problem, as CSV.
pub fn list(problems: &[Problem], row: &Row) -> String {
    let mut text = "problem,time_s,bound_s,motions,planning_ms\n".to_owned();
    let shown = |x: Option<f64>| x.map_or(String::new(), |x| format!("{x:.4}"));
    for (i, problem) in problems.iter().enumerate() {
        let bound = row.bounds.get(i).copied().flatten();
        let (time, bound) = (shown(row.times[i]), shown(bound));
        writeln!(text, "{},{time},{bound},{},{:.2}", problem.name, row.steps[i], row.planning_ms[i])
            .expect("invariant: a string takes all that is written");
    }
    text
}

fn first(list: &[String]) -> &[String] {
    &list[..list.len().min(20)]
}

/// The `q`-quantile.
pub fn part(values: &[f64], q: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(((sorted.len().max(1) - 1) as f64 * q).round() as usize).copied().unwrap_or(f64::NAN)
}
