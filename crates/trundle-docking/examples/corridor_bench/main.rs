//! Corridor problems by seed, solved and judged: prints a table.
//!
//! `cargo run --release -p trundle-docking --example corridor_bench -- --problems 5000`

mod judge;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::time::Instant;
use trundle_docking::corridor::{Problem, generate};
use trundle_docking::{Docker, DockingConfig, Method, Plan};

fn main() {
    let count = argument("--problems", 5000);
    let seed = argument("--seed", 1) as u64;
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let problems: Vec<Problem> = (0..count).map(|i| generate(format!("{seed}-{i}"), &mut rng)).collect();
    for method in [Method::Optimal] {
        let docker =
            Docker::new(DockingConfig { method, margin: 0.0, bound_boxes: argument("--boxes", 400), ..DockingConfig::default() }).expect("valid");
        let (mut solved, mut times, mut failed) = (0, Vec::new(), Vec::new());
        let mut legs = [0; 99];
        let mut ratios = Vec::new();
        let mut proven = 0;
        for problem in &problems {
            let scene = problem.scene().expect("valid");
            let clock = Instant::now();
            let plan =
                docker.plan(&problem.footprint, &scene, problem.start, problem.goal).expect("free ends");
            times.push(clock.elapsed().as_secs_f64() * 1e3);
            if times[times.len() - 1] > 60.0 && method == Method::Optimal {
                let n = match &plan { Plan::Found(s) => s.manoeuvre.steps().len() as i32, Plan::Impossible(i) => if i.proven { -1 } else { -2 } };
                println!("slow {} {:.0} ms {n} steps", problem.name, times[times.len() - 1]);
            }
            match plan {
                Plan::Found(solution) if judge::is_good(problem, &solution.manoeuvre) => {
                    solved += 1;
                    ratios.push(solution.manoeuvre.duration() / solution.bound.max(1e-9));
                    legs[solution.manoeuvre.steps().len()] += 1;
                }
                Plan::Found(_) => println!("{method:?} {}: not good", problem.name),
                Plan::Impossible(impossible) if impossible.proven => proven += 1,
                Plan::Impossible(_) => failed.push(problem.name.clone()),
            }
        }
        times.sort_by(f64::total_cmp);
        println!(
            "{method:?}: solved {solved} of {count}, {proven} proven impossible; planning median {:.2} ms, p99 {:.2} ms, max {:.2} ms; steps {legs:?}",
            times[times.len() / 2],
            times[times.len() * 99 / 100],
            times[times.len() - 1]
        );
        ratios.sort_by(f64::total_cmp);
        let at = |q: usize| ratios[(ratios.len() - 1) * q / 100];
        println!("time/bound: median {:.4}, p75 {:.4}, p90 {:.4}, p95 {:.4}, p99 {:.4}", at(50), at(75), at(90), at(95), at(99));
        println!("failed: {:?}", &failed[..failed.len().min(30)]);
    }
}

fn argument(name: &str, default: usize) -> usize {
    let mut arguments = std::env::args().skip_while(|a| a != name).skip(1);
    arguments.next().map_or(default, |value| value.parse().expect("a number"))
}
