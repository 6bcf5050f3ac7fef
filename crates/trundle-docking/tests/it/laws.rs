//! Laws of plans: contact-free motions, exact ends, and bounds that hold under the symmetries of the problem.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use trundle_core::{Footprint, Pose2, Vector2};
use trundle_docking::corridor::{Problem, generate};
use trundle_docking::{Certificate, DockingConfig, DockingPlan, DockingPlanner, Obstacle, Solution};

/// Number of random problems of each law.
const PROBLEMS: usize = 24;

fn problems(seed: u64) -> Vec<Problem> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    (0..PROBLEMS).map(|i| generate(format!("law-{i}"), &mut rng)).collect()
}

fn plan(problem: &Problem) -> DockingPlan {
    let mut config = DockingConfig::default();
    config.margin = 0.0;
    config.bound_boxes = 2000;
    let planner = DockingPlanner::new(config).unwrap();
    planner.plan(&problem.footprint, &problem.scene().unwrap(), problem.start, problem.goal).unwrap()
}

/// The problem with every point and pose mapped; `mirrors`: whether the map changes the orientation.
fn mapped(
    problem: &Problem,
    mirrors: bool,
    point: impl Fn(Vector2) -> Vector2,
    pose: impl Fn(Pose2) -> Pose2,
) -> Problem {
    let obstacle = |obstacle: &Obstacle| match obstacle {
        Obstacle::Point(at) => Obstacle::Point(point(*at)),
        Obstacle::Segment(a, b) => Obstacle::Segment(point(*a), point(*b)),
        Obstacle::Polygon(corners) => {
            let mut corners: Vec<_> = corners.iter().map(|corner| point(*corner)).collect();
            if mirrors {
                corners.reverse();
            }
            Obstacle::Polygon(corners)
        }
    };
    let footprint = match &problem.footprint {
        Footprint::Polygon { corners } if mirrors => {
            let corners = corners.iter().rev().map(|corner| Vector2::new(corner.x, -corner.y)).collect();
            Footprint::Polygon { corners }
        }
        same => same.clone(),
    };
    Problem {
        name: problem.name.clone(),
        footprint,
        start: pose(problem.start),
        goal: pose(problem.goal),
        obstacles: problem.obstacles.iter().map(obstacle).collect(),
    }
}

fn mirrored(problem: &Problem) -> Problem {
    let flip = |at: Vector2| Vector2::new(at.x, -at.y);
    mapped(problem, true, flip, |pose| Pose2::new(pose.x, -pose.y, -pose.theta))
}

fn moved(problem: &Problem) -> Problem {
    let by = Pose2::new(3.1, -1.7, 0.83);
    mapped(problem, false, |at| by.transform(at), |pose| by * pose)
}

/// Start and goal exchanged: every manoeuvre can be driven in reverse in the same time.
fn reversed(problem: &Problem) -> Problem {
    Problem { start: problem.goal, goal: problem.start, ..problem.clone() }
}

/// A manoeuvre of one problem is one of the other, so neither bound is above the time of the other, and a proof excludes both.
fn assert_equivalent(name: &str, a: &DockingPlan, b: &DockingPlan) {
    match (a, b) {
        (DockingPlan::Found(a), DockingPlan::Found(b)) => {
            let (times, bounds) = ([a, b].map(|s| s.manoeuvre.duration()), [a.bound, b.bound]);
            assert!(
                bounds[0] <= times[1] + 1e-3 && bounds[1] <= times[0] + 1e-3,
                "{name}: {bounds:?}, {times:?}"
            );
        }
        (DockingPlan::Found(_), DockingPlan::Impossible(none))
        | (DockingPlan::Impossible(none), DockingPlan::Found(_)) => {
            assert_ne!(none.certificate, Certificate::Never, "{name}");
        }
        (DockingPlan::Impossible(_), DockingPlan::Impossible(_)) => {}
    }
}

fn solved(problems: &[Problem]) -> Vec<(&Problem, Solution)> {
    let found = problems.iter().filter_map(|problem| match plan(problem) {
        DockingPlan::Found(solution) => Some((problem, solution)),
        DockingPlan::Impossible(_) => None,
    });
    found.collect()
}

#[test]
fn bounds_hold_for_the_mirrored_problem() {
    for problem in problems(21) {
        assert_equivalent(&problem.name, &plan(&problem), &plan(&mirrored(&problem)));
    }
}

#[test]
fn bounds_hold_for_the_moved_problem() {
    for problem in problems(22) {
        assert_equivalent(&problem.name, &plan(&problem), &plan(&moved(&problem)));
    }
}

#[test]
fn bounds_hold_for_the_reversed_problem() {
    for problem in problems(23) {
        assert_equivalent(&problem.name, &plan(&problem), &plan(&reversed(&problem)));
    }
}

#[test]
fn every_pose_of_a_manoeuvre_is_free_and_its_ends_are_exact() {
    let problems = problems(24);
    let solved = solved(&problems);
    assert!(solved.len() * 2 > problems.len(), "{} of {} solved", solved.len(), problems.len());
    for (problem, solution) in solved {
        let (scene, manoeuvre) = (problem.scene().unwrap(), &solution.manoeuvre);
        assert_eq!(manoeuvre.start(), problem.start, "{}", problem.name);
        assert!(manoeuvre.end().distance(&problem.goal) < 1e-6, "{}", problem.name);
        let samples = (manoeuvre.duration() / 0.01).ceil() as usize;
        for i in 0..=samples {
            let pose = manoeuvre.at(manoeuvre.duration() * i as f64 / samples.max(1) as f64).0;
            let contact = scene.clearance(&problem.footprint, &pose, 1e-6);
            assert!(contact.is_none(), "{}: {contact:?} at {pose:?}", problem.name);
        }
    }
}

#[test]
fn the_bound_is_at_most_the_time_and_the_known_time() {
    let problems = problems(25);
    let mut config = DockingConfig::default();
    config.margin = 0.0;
    let planner = DockingPlanner::new(config).unwrap();
    for (problem, solution) in solved(&problems) {
        let time = solution.manoeuvre.duration();
        assert!(solution.bound <= time + 1e-9, "{}: {} above {time}", problem.name, solution.bound);
        let (scene, known) = (problem.scene().unwrap(), 0.5 * time);
        let bound = planner.bound(&problem.footprint, &scene, problem.start, problem.goal, known).unwrap();
        assert!(bound <= known + 1e-9, "{}: {bound} above {known}", problem.name);
    }
}
