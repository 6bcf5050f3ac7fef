//! Corridor problems by seed, or from a file, solved and judged: prints a table.
//!
//! `cargo run --release -p trundle-docking --example corridor_bench -- --problems 5000`
//!
//! `--seed N`, `--file PATH` instead of a seed, `--write PATH` to keep the problems, `--boxes N` of the bound that judges,
//! `--baselines N` problems for the slow ones, `--loops N` problems in closed loop with noise, `--nodes N` of the search, `--list PATH` keeps what
//! became of each problem as CSV.

#![expect(clippy::print_stdout, reason = "an example prints its result")]

mod clock;
mod dynamic_window;
mod hybrid;
mod judge;
mod table;
#[path = "../../crates/trundle-docking/tests/it/world.rs"]
mod world;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use table::Row;
use trundle_docking::corridor::{Problem, generate, parse, write};
use trundle_docking::{Certificate, Docker, DockingConfig, Method, MotionLimits, Plan};

fn main() {
    let problems = problems();
    let mut rows = vec![optimal(&problems, number("--boxes", 50_000))];
    rows.push(by_paper(&problems));
    let few = &problems[..number("--baselines", 200).min(problems.len())];
    rows.push(by_window(few));
    rows.push(by_hybrid(few));
    table::print(&rows);
    if let Some(path) = argument("--list") {
        std::fs::write(path, table::list(&problems, &rows[0])).expect("a file that can be written");
    }
    closed_loop(&problems, &rows[0], number("--loops", 500));
}

fn problems() -> Vec<Problem> {
    if let Some(path) = argument("--file") {
        return parse(&std::fs::read_to_string(path).expect("a file that can be read"))
            .expect("the format of the page");
    }
    let (count, seed) = (number("--problems", 5000), number("--seed", 1) as u64);
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let problems: Vec<Problem> = (0..count).map(|i| generate(format!("{seed}-{i}"), &mut rng)).collect();
    if let Some(path) = argument("--write") {
        std::fs::write(path, write(&problems)).expect("a file that can be written");
    }
    problems
}

/// The default method, its times against a proven bound.
fn optimal(problems: &[Problem], boxes: usize) -> Row {
    let nodes = number("--nodes", DockingConfig::default().search_nodes);
    let base = DockingConfig { margin: 0.0, search_nodes: nodes, ..DockingConfig::default() };
    let mut row = plan_all("trundle, optimal", problems, &Docker::new(base.clone()).expect("valid"));
    // Many boxes only where a few leave more than 15 %, and only until they do not.
    let judge = |bound_boxes, gap| {
        Docker::new(DockingConfig { bound_boxes, gap, search_nodes: 0, ..base.clone() }).expect("valid")
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
    let config = DockingConfig { method: Method::Paper, margin: 0.0, ..DockingConfig::default() };
    plan_all("[Hong24]", problems, &Docker::new(config).expect("valid"))
}

/// Driven step by step, so that its "planning" is a whole run.
fn by_window(problems: &[Problem]) -> Row {
    let mut row = Row::new("dynamic window");
    for problem in problems {
        let scene = problem.scene().expect("valid");
        let ((time, contact), ms) =
            clock::timed(|| dynamic_window::drive(problem, &scene, &MotionLimits::default()));
        row.planning_ms.push(ms);
        if contact {
            row.bad.push(problem.name.clone());
        } else if time.is_none() {
            row.unsolved.push(problem.name.clone());
        }
        row.times.push(time.filter(|_| !contact));
    }
    row
}

fn by_hybrid(problems: &[Problem]) -> Row {
    let mut row = Row::new("hybrid A*, Reeds-Shepp");
    for problem in problems {
        let scene = problem.scene().expect("valid");
        let (time, ms) = clock::timed(|| hybrid::plan(problem, &scene, &MotionLimits::default()));
        row.planning_ms.push(ms);
        if time.is_none() {
            row.unsolved.push(problem.name.clone());
        }
        row.times.push(time);
    }
    row
}

/// The first `most` solvable problems with noise and lag.
fn closed_loop(problems: &[Problem], row: &Row, most: usize) {
    let solvable: Vec<_> =
        problems.iter().zip(&row.times).filter(|(_, time)| time.is_some()).take(most).collect();
    let (mut good, mut contacts, mut motions, mut ratios) = (0, 0, 0, Vec::new());
    for (i, (problem, time)) in solvable.iter().enumerate() {
        let run = world::run(problem, &DockingConfig::default(), i as u64);
        good += usize::from(run.settled && run.within && !run.contact);
        contacts += usize::from(run.contact);
        motions += run.motions;
        ratios.push(run.time / time.unwrap_or(f64::NAN));
        if !(run.settled && run.within && !run.contact) {
            println!(
                "closed loop {}: settled {}, within {}, contact {}",
                problem.name, run.settled, run.within, run.contact
            );
        }
    }
    println!(
        "closed loop with noise: {good} of {} within 1 cm and 1 deg, {contacts} with contact; {:.2} motions each, {:.2} times the planned time in the median",
        solvable.len(),
        motions as f64 / solvable.len().max(1) as f64,
        table::part(&ratios, 0.5)
    );
}

fn plan_all(name: &'static str, problems: &[Problem], docker: &Docker) -> Row {
    let mut row = Row::new(name);
    for problem in problems {
        let scene = problem.scene().expect("valid");
        let plan =
            || docker.plan(&problem.footprint, &scene, problem.start, problem.goal).expect("free ends");
        let (plan, ms) = clock::timed(plan);
        row.planning_ms.push(ms);
        row.steps.push(if let Plan::Found(solution) = &plan { solution.manoeuvre.steps().len() } else { 0 });
        let mut time = None;
        match plan {
            Plan::Found(solution) if judge::is_good(problem, &solution.manoeuvre) => {
                time = Some(solution.manoeuvre.duration());
            }
            Plan::Found(_) => row.bad.push(problem.name.clone()),
            Plan::Impossible(impossible) => match impossible.certificate {
                Certificate::Never => row.never += 1,
                Certificate::AtResolution => row.at_resolution += 1,
                Certificate::None => row.unsolved.push(problem.name.clone()),
            },
        }
        row.times.push(time);
    }
    row
}

fn argument(name: &str) -> Option<String> {
    std::env::args().skip_while(|a| a != name).nth(1)
}

fn number(name: &str, default: usize) -> usize {
    argument(name).map_or(default, |value| value.parse().expect("a number"))
}
