//! Corridor problems by seed, or from a file, solved and evaluated: prints a table.
//!
//! `cargo run --release -p trundle-docking --example corridor_bench -- --problems 5000`
//!
//! `--seed N`, `--file PATH` instead of a seed, `--write PATH` writes the problems and ends, `--answers PATH` evaluates the answers of
//! another program and ends, `--planner PROGRAM` runs another program on each problem (`--seconds N`), `--write-answers PATH` keeps the default method's, `--boxes N` of the bound that evaluates,
//! `--baselines N` problems for the slow ones, `--loops N` problems in closed loop with noise, `--nodes N` of the search, `--margin M` asked for (default 0), `--list PATH` keeps what
//! became of each problem as CSV.

#![expect(clippy::print_stdout, reason = "an example prints its result")]

mod clock;
mod dynamic_window;
mod entry;
mod hybrid;
mod judge;
mod race;
mod table;
#[path = "../../crates/trundle-docking/tests/it/world.rs"]
mod world;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::process::ExitCode;
use std::time::Duration;
use table::{Row, Track};
use trundle_core::Invalid;
use trundle_docking::corridor::{
    PathPiece, Problem, ProblemAnswer, generate, parse, parse_answers, write, write_answers,
};
use trundle_docking::hong24::Hong24Config;
use trundle_docking::{Certificate, DockingConfig, DockingPlan, DockingPlanner, Method, MotionLimits};

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            println!("{problem}");
            ExitCode::from(2)
        }
    }
}

fn run() -> Result<(), String> {
    let problems = problems()?;
    if let Some(path) = argument("--write") {
        return kept(&path, &write(&problems));
    }
    if let Some(path) = argument("--answers") {
        let answers = read(&path, parse_answers)?;
        println!("{}", judge::judge(&problems, &answers).map_err(|e| format!("{path}: {e}"))?.summary());
        return Ok(());
    }
    if let Some(program) = argument("--planner") {
        let limit = Duration::from_secs(number("--seconds", 10) as u64);
        println!("{}", entry::run(&program, &problems, limit)?.summary());
        return Ok(());
    }
    let mut rows = vec![optimal(&problems, number("--boxes", 50_000))];
    rows.push(by_paper(&problems));
    let few = &problems[..number("--baselines", 200).min(problems.len())];
    rows.push(by_hybrid(few));
    table::print(&rows);
    if let Some(path) = argument("--write-answers") {
        kept(&path, &write_answers(&rows[0].answers))?;
    }
    if let Some(path) = argument("--list") {
        kept(&path, &table::list(&problems, &rows[0]))?;
    }
    let solvable: Vec<&Problem> =
        problems.iter().zip(&rows[0].times).filter(|(_, time)| time.is_some()).map(|(p, _)| p).collect();
    closed_loop(&solvable, number("--loops", 500), number("--baselines", 200));
    Ok(())
}

fn kept(path: &str, text: &str) -> Result<(), String> {
    std::fs::write(path, text).map_err(|e| format!("{path}: cannot write it: {e}"))
}

fn read<T>(path: &str, parse: impl Fn(&str) -> Result<T, Invalid>) -> Result<T, String> {
    let text = std::fs::read_to_string(path).map_err(|e| format!("{path}: cannot read it: {e}"))?;
    parse(&text).map_err(|e| format!("{path}: {e}"))
}

fn problems() -> Result<Vec<Problem>, String> {
    if let Some(path) = argument("--file") {
        let problems = read(&path, parse)?;
        for problem in &problems {
            problem.scene().map_err(|e| format!("{path}: problem {}: {e}", problem.name))?;
        }
        return Ok(problems);
    }
    let (count, seed) = (number("--problems", 5000), number("--seed", 1) as u64);
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    Ok((0..count).map(|i| generate(format!("{seed}-{i}"), &mut rng)).collect())
}

/// The default method, its times against a proven bound.
fn optimal(problems: &[Problem], boxes: usize) -> Row {
    let nodes = number("--nodes", DockingConfig::default().search_nodes);
    let margin = argument("--margin").map_or(0.0, |value| value.parse().expect("metres"));
    let mut base = DockingConfig::default();
    base.margin = margin;
    base.search_nodes = nodes;
    let mut row = plan_all("trundle, optimal", problems, &DockingPlanner::new(base.clone()).expect("valid"));
    // Many boxes only where a few leave more than 15 %, and only until they do not.
    let judge = |bound_boxes, gap| {
        let mut config = base.clone();
        config.bound_boxes = bound_boxes;
        config.gap = gap;
        config.search_nodes = 0;
        DockingPlanner::new(config).expect("valid")
    };
    let judges = [judge(boxes / 20, 0.02), judge(boxes, 0.125)];
    let bound = |problem: &Problem, time: f64| {
        let scene = problem.scene().expect("valid");
        judges.iter().fold(0.0_f64, |bound, judge| {
            if time <= 1.15 * bound {
                return bound;
            }
            let found = judge.bound(&problem.footprint, &scene, problem.start, problem.goal, time);
            bound.max(found.expect("free ends"))
        })
    };
    let bounds = problems.iter().zip(&row.times).map(|(problem, time)| time.map(|time| bound(problem, time)));
    row.bounds = bounds.collect();
    row
}

fn by_paper(problems: &[Problem]) -> Row {
    // A distance of 1 cm is asked for: each axis gets its part of it.
    let part = number("--paper-mm", 7) as f64 * 1e-3;
    let mut paper = Hong24Config::default();
    paper.lateral_threshold = part;
    paper.longitudinal_threshold = part;
    let mut config = DockingConfig::default();
    config.method = Method::Hong24;
    config.margin = 0.0;
    config.paper = paper;
    plan_all("[Hong24]", problems, &DockingPlanner::new(config).expect("valid"))
}

/// Distance that the path planner keeps from obstacles, m: a millimetre for what lies between its samples. Source: ours.
const KEPT: f64 = 0.001;

fn by_hybrid(problems: &[Problem]) -> Row {
    let mut row = Row::new("hybrid A*, Reeds-Shepp");
    for problem in problems {
        let scene = problem.scene().expect("valid");
        let limits = MotionLimits::default();
        let (path, ms) = clock::timed(|| hybrid::plan(problem, &scene, &limits, KEPT));
        let path = path.map(|path| {
            path.iter()
                .map(|&(curvature, distance)| PathPiece { distance, turn: curvature * distance })
                .collect()
        });
        row.planning_ms.push(ms);
        row.note(problem, path);
    }
    row
}

/// Solvable problems with noise and lag: the first `max` by the positioner, the first `few` by the others.
fn closed_loop(problems: &[&Problem], max: usize, few: usize) {
    let mut paper = DockingConfig::default();
    paper.method = Method::Hong24;
    let run = |docking: &DockingConfig, problem: &Problem, i: usize| world::run(problem, docking, i as u64);
    let scene = |problem: &Problem| problem.scene().expect("valid");
    let mut tracks = vec![Track::new("trundle, optimal"), Track::new("[Hong24]")];
    tracks.extend([Track::new("dynamic window"), Track::new("hybrid A*, Reeds-Shepp")]);
    for (i, &problem) in problems.iter().enumerate().take(max) {
        tracks[0].note(problem, run(&DockingConfig::default(), problem, i));
        if i < few {
            tracks[1].note(problem, run(&paper, problem, i));
            tracks[2].note(problem, race::by_window(problem, &scene(problem), i as u64));
            tracks[3].note(problem, race::by_hybrid(problem, &scene(problem), i as u64));
        }
    }
    table::print_closed_loop(&tracks);
}

fn plan_all(name: &'static str, problems: &[Problem], planner: &DockingPlanner) -> Row {
    let mut row = Row::new(name);
    for problem in problems {
        let scene = problem.scene().expect("valid");
        let plan =
            || planner.plan(&problem.footprint, &scene, problem.start, problem.goal).expect("free ends");
        let (plan, ms) = clock::timed(plan);
        row.planning_ms.push(ms);
        row.steps.push(if let DockingPlan::Found(solution) = &plan {
            solution.manoeuvre.steps().len()
        } else {
            0
        });
        match plan {
            DockingPlan::Found(solution) => row.note(problem, Some(PathPiece::all_of(&solution.manoeuvre))),
            DockingPlan::Impossible(impossible) => {
                match (impossible.certificate, impossible.limit) {
                    (Certificate::Never, None) => row.never += 1,
                    (Certificate::AtResolution, None) => row.at_resolution += 1,
                    _ => row.unsolved.push(problem.name.clone()),
                }
                row.times.push(None);
                row.answers.push(ProblemAnswer { problem: problem.name.clone(), path: None });
            }
        }
    }
    row
}

fn argument(name: &str) -> Option<String> {
    std::env::args().skip_while(|a| a != name).nth(1)
}

fn number(name: &str, default: usize) -> usize {
    argument(name).map_or(default, |value| value.parse().expect("a number"))
}
