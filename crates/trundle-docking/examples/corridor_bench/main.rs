//! Corridor problems by seed, or from a file, solved and judged: prints a table.
//!
//! `cargo run --release -p trundle-docking --example corridor_bench -- --problems 5000`
//!
//! `--seed N`, `--file PATH` instead of a seed, `--write PATH` to keep the problems, `--boxes N` of the bound that judges.

mod clock;
mod judge;
mod table;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use table::Row;
use trundle_docking::corridor::{Problem, generate, parse, write};
use trundle_docking::{Docker, DockingConfig, Method, Plan};

fn main() {
    let problems = problems();
    let mut rows = vec![optimal(&problems, number("--boxes", 20_000))];
    rows.push(by_paper(&problems));
    table::print(&rows, problems.len());
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

/// The default method; its times against a bound that is sought with `boxes`.
fn optimal(problems: &[Problem], boxes: usize) -> Row {
    let base = DockingConfig { margin: 0.0, ..DockingConfig::default() };
    let judge =
        Docker::new(DockingConfig { bound_boxes: boxes, search_nodes: 0, ..base.clone() }).expect("valid");
    let mut row = plan_all("trundle, optimal", problems, &Docker::new(base).expect("valid"));
    for (problem, time) in problems.iter().zip(&row.times) {
        let Some(time) = time else { continue };
        let scene = problem.scene().expect("valid");
        let bound =
            judge.bound(&problem.footprint, &scene, problem.start, problem.goal, *time).expect("free ends");
        row.ratios.push(time / bound);
    }
    row
}

fn by_paper(problems: &[Problem]) -> Row {
    let config = DockingConfig { method: Method::Paper, margin: 0.0, ..DockingConfig::default() };
    plan_all("[Hong24]", problems, &Docker::new(config).expect("valid"))
}

fn plan_all(name: &'static str, problems: &[Problem], docker: &Docker) -> Row {
    let mut row = Row::new(name);
    for problem in problems {
        let scene = problem.scene().expect("valid");
        let plan =
            || docker.plan(&problem.footprint, &scene, problem.start, problem.goal).expect("free ends");
        let (plan, ms) = clock::timed(plan);
        row.planning_ms.push(ms);
        if std::env::args().any(|a| a == "--slow") && ms > 30.0 {
            let steps = if let Plan::Found(solution) = &plan { solution.manoeuvre.steps().len() } else { 0 };
            println!("{} {:.0} ms {steps} steps", problem.name, ms);
        }
        let mut time = None;
        match plan {
            Plan::Found(solution) if judge::is_good(problem, &solution.manoeuvre) => {
                time = Some(solution.manoeuvre.duration());
            }
            Plan::Found(_) => row.bad.push(problem.name.clone()),
            Plan::Impossible(impossible) if impossible.proven => row.proven += 1,
            Plan::Impossible(_) => row.unsolved.push(problem.name.clone()),
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
