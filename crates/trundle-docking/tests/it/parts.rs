//! Plans made in parts, and among very many points: counted work keeps to what was granted.

use crate::clock::timed;
use crate::clouds;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use trundle_docking::corridor::{generate, parse};
use trundle_docking::{Docker, DockingConfig, Plan};

/// More than a part may cost beyond its grant: what lies between two rests.
const BEYOND: u64 = 60_000;

/// The same plan however it is cut, and no part much beyond its grant.
#[test]
fn a_plan_in_parts_is_the_plan_at_once() {
    let docker = Docker::new(DockingConfig { margin: 0.0, ..DockingConfig::default() }).unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(12);
    let mut problems: Vec<_> = (0..25).map(|i| generate(format!("{i}"), &mut rng)).collect();
    problems.extend(parse(include_str!("../data/hard.txt")).unwrap().into_iter().take(1));
    let (mut most, mut parts) = (0, 0);
    for problem in &problems {
        let scene = problem.scene().unwrap();
        let at_once = docker.plan(&problem.footprint, &scene, problem.start, problem.goal).unwrap();
        let mut planning =
            docker.begin(0.0, &problem.footprint, &scene, problem.start, problem.goal).unwrap();
        let in_parts = loop {
            let before = planning.work();
            let plan = planning.go_on(100_000);
            (most, parts) = (most.max(planning.work() - before), parts + 1);
            if let Some(plan) = plan {
                break plan;
            }
        };
        assert_eq!(at_once, in_parts, "problem {}", problem.name);
    }
    eprintln!("{parts} parts of 100000, the largest {most}");
    assert!(parts > 3 * problems.len() && most <= 100_000 + BEYOND, "{parts} parts, the largest {most}");
}

/// Walls, rooms, blobs, lattices, corridors: a hundred thousand points each.
#[test]
fn a_hundred_thousand_points_of_any_kind_stay_under_a_tenth_of_a_second() {
    let docker = Docker::new(DockingConfig::default()).unwrap();
    let (mut found, mut worst) = (0, 0.0_f64);
    for problem in clouds::scenes() {
        let scene = clouds::scene_of(&problem);
        let plan = || docker.plan(&problem.footprint, &scene, problem.start, problem.goal).unwrap();
        let runs: Vec<_> = (0..3).map(|_| timed(plan)).collect();
        let least = runs.iter().map(|(_, ms)| *ms).fold(f64::INFINITY, f64::min);
        assert!(least < 100.0, "{}: {least:.0} ms", problem.name);
        assert_eq!(runs[0].0, runs[1].0, "{}", problem.name);
        (found, worst) = (found + i32::from(matches!(runs[0].0, Plan::Found(_))), worst.max(least));
    }
    eprintln!("{found} of 21 found, the longest {worst:.0} ms");
    assert!(found >= 15, "{found} found");
}
