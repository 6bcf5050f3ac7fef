//! Plans made in parts, and among very many points: counted work respects the grant.

use crate::clock::{slowness, timed};
use crate::clouds;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use trundle_core::{Footprint, Pose2, Vector2};
use trundle_docking::corridor::{generate, parse};
use trundle_docking::{
    Certificate, DockingConfig, DockingPlan, DockingPlanner, Method, Obstacle, ObstacleScene, SearchLimit,
};

/// Largest cost of a part above its grant: the work between two yields.
const BEYOND: u64 = 60_000;

/// The same plan for any division, with no part much above its grant.
#[test]
fn a_plan_in_parts_is_the_plan_at_once() {
    let mut config = DockingConfig::default();
    config.margin = 0.0;
    let planner = DockingPlanner::new(config).unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(12);
    let mut problems: Vec<_> = (0..25).map(|i| generate(format!("{i}"), &mut rng)).collect();
    problems.extend(parse(include_str!("../data/hard.txt")).unwrap().into_iter().take(1));
    let (mut max, mut parts) = (0, 0);
    for problem in &problems {
        let scene = problem.scene().unwrap();
        let run_to_end = planner.plan(&problem.footprint, &scene, problem.start, problem.goal).unwrap();
        let mut planning =
            planner.begin(0.0, &problem.footprint, &scene, problem.start, problem.goal).unwrap();
        let in_parts = loop {
            let before = planning.work();
            let plan = planning.advance(100_000);
            (max, parts) = (max.max(planning.work() - before), parts + 1);
            if let Some(plan) = plan {
                break plan;
            }
        };
        assert_eq!(run_to_end, in_parts, "problem {}", problem.name);
    }
    eprintln!("{parts} parts of 100000, the largest {max}");
    assert!(parts > 3 * problems.len() && max <= 100_000 + BEYOND, "{parts} parts, the largest {max}");
}

/// Number of runs of one problem, of which the fastest counts.
const MAX_TIMED_RUNS: usize = 15;
/// Largest work of a plan among a hundred thousand points \[units of `DockingJob::work`\]. A unit takes about 8 ns.
const MAX_WORK: u64 = 8_000_000;
/// Largest time of such a plan on the reference machine \[ms\].
const MAX_PLAN_MS: f64 = 100.0;

/// Walls, rooms, blobs, lattices, corridors: a hundred thousand points each. Every one is solved, or proven impossible within
/// reach.
#[test]
fn a_hundred_thousand_points_of_any_kind_stay_under_a_tenth_of_a_second() {
    let planner = DockingPlanner::new(DockingConfig::default()).unwrap();
    let (mut found, mut worst) = (0, 0.0_f64);
    for problem in clouds::scenes() {
        let scene = clouds::scene_of(&problem);
        let plan = || planner.plan(&problem.footprint, &scene, problem.start, problem.goal).unwrap();
        let mut runs = vec![timed(plan), timed(plan)];
        // Other tests share the cores: the fastest of several runs is the planner's own time.
        while runs.len() < MAX_TIMED_RUNS && runs.iter().all(|(_, ms)| *ms >= MAX_PLAN_MS) {
            runs.push(timed(plan));
        }
        let min = runs.iter().map(|(_, ms)| *ms).fold(f64::INFINITY, f64::min);
        assert!(min < MAX_PLAN_MS * slowness(), "{}: {min:.0} ms", problem.name);
        let (margin, ends) = (planner.config().margin, (problem.start, problem.goal));
        let mut job = planner.begin(margin, &problem.footprint, &scene, ends.0, ends.1).unwrap();
        job.advance(u64::MAX);
        assert!(job.work() <= MAX_WORK, "{}: {} units of work", problem.name, job.work());
        assert_eq!(runs[0].0, runs[1].0, "{}", problem.name);
        match &runs[0].0 {
            DockingPlan::Found(_) => found += 1,
            DockingPlan::Impossible(none) => {
                assert_eq!(none.certificate, Certificate::Never, "{}", problem.name);
                assert!(none.within >= planner.config().reach && none.by.is_some(), "{}", problem.name);
            }
        }
        worst = worst.max(min);
    }
    eprintln!("{found} of 21 found, the longest {worst:.0} ms");
    assert_eq!(found, 17);
}

/// Among a grid's cells, too, a whole plan ends at its work limit, and the error gives the setting.
#[test]
fn a_whole_plan_has_a_limit_and_names_it() {
    let hard = &parse(include_str!("../data/hard.txt")).unwrap()[0];
    let scene = hard.scene().unwrap();
    for method in [Method::Optimal, Method::Hong24] {
        let plan_work = 300_000;
        let mut config = DockingConfig::default();
        config.method = method;
        config.plan_work = plan_work;
        let planner = DockingPlanner::new(config).unwrap();
        let mut planning = planner.begin(0.01, &hard.footprint, &scene, hard.start, hard.goal).unwrap();
        let plan = planning.advance(u64::MAX).expect("all at once");
        let DockingPlan::Impossible(none) = plan else { panic!("{method:?}: {plan:?}") };
        assert_eq!(
            (none.certificate, none.limit),
            (Certificate::None, Some(SearchLimit::PlanWork)),
            "{method:?}"
        );
        assert!(planning.work() <= plan_work + BEYOND, "{method:?}: {}", planning.work());
    }
}

/// One decision of the paper's method tests tens of thousands of poses: it yields between them.
#[test]
fn the_papers_method_rests_too() {
    let mut config = DockingConfig::default();
    config.method = Method::Hong24;
    let planner = DockingPlanner::new(config).unwrap();
    let scene = ObstacleScene::new(&[Obstacle::Point(Vector2::new(0.0, 1.0))]).unwrap();
    let (start, goal) = (Pose2::IDENTITY, Pose2::new(0.1, 0.3, 0.2));
    let run_to_end = planner.plan(&Footprint::KOBUKI, &scene, start, goal).unwrap();
    let mut planning = planner.begin(0.01, &Footprint::KOBUKI, &scene, start, goal).unwrap();
    let (mut parts, mut max) = (0, 0);
    let in_parts = loop {
        let before = planning.work();
        let plan = planning.advance(10_000);
        (parts, max) = (parts + 1, max.max(planning.work() - before));
        if let Some(plan) = plan {
            break plan;
        }
    };
    assert_eq!(run_to_end, in_parts);
    assert!(parts > 5 && max <= 11_000, "{parts} parts, the largest {max}");
}
