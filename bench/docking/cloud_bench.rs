//! Plans among a hundred thousand points, scene by scene; prints the times and the worst:
//! `cargo run --release -p trundle-docking --example cloud_bench`, or only those whose name holds a word: `... -- walls`, and with
//! another `points_work`: `... -- walls 1000000000`

#![expect(clippy::print_stdout, reason = "an example prints its result")]

mod clock;
mod clouds;

use clock::timed;
use trundle_docking::{DockingConfig, DockingPlan, DockingPlanner};

/// Plans of each scene; the fastest counts. Source: ours.
const TIMES: usize = 3;

fn main() {
    let mut config = DockingConfig::default();
    if let Some(work) = std::env::args().nth(2) {
        config.points_work = work.parse().expect("a number");
    }
    config.plan_work = config.plan_work.max(config.points_work);
    let planner = DockingPlanner::new(config).expect("valid");
    let mut worst = (0.0, String::new());
    let word = std::env::args().nth(1).unwrap_or_default();
    for problem in clouds::scenes().into_iter().filter(|problem| problem.name.contains(&word)) {
        let (scene, preparing) = timed(|| clouds::scene_of(&problem));
        let plan = || planner.plan(&problem.footprint, &scene, problem.start, problem.goal);
        let runs: Vec<_> = (0..TIMES).map(|_| timed(plan)).collect();
        let min = runs.iter().map(|(_, ms)| *ms).fold(f64::INFINITY, f64::min);
        let outcome = match &runs[0].0 {
            Ok(DockingPlan::Found(found)) => format!(
                "{} motions, {:.2} s, bound {:.2} s, margin {:.1} mm",
                found.manoeuvre.steps().len(),
                found.manoeuvre.duration(),
                found.bound,
                1e3 * found.margin
            ),
            Ok(DockingPlan::Impossible(none)) => format!(
                "impossible within {} m: {:?}, ended by {:?}",
                none.within, none.certificate, none.limit
            ),
            Err(refusal) => refusal.to_string(),
        };
        println!("{min:7.1} ms, scene {preparing:5.1} ms: {}: {outcome}", problem.name);
        if min > worst.0 {
            worst = (min, problem.name);
        }
    }
    println!("worst: {:.1} ms, {}", worst.0, worst.1);
}
