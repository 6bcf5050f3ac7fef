//! Bad input, hard input, and verdicts.

use crate::clock::{slowness, timed};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trundle_core::{Cell, Footprint, GridGeometry, OccupancyGrid, Pose2, Vector2};
use trundle_docking::corridor::{Problem, Scenario, generate, parse};
use trundle_docking::{
    BlockerKind, Certificate, ContactSpace, DockingConfig, DockingPlan, DockingPlanner, DockingRefusal,
    Method, Motion, Obstacle, ObstacleScene,
};

fn at(x: f64, y: f64) -> Vector2 {
    Vector2::new(x, y)
}

fn robot() -> Footprint {
    Footprint::polygon([(0.3, 0.2), (-0.3, 0.2), (-0.3, -0.2), (0.3, -0.2)].map(|(x, y)| at(x, y)).to_vec())
        .expect("convex")
}

fn planner() -> DockingPlanner {
    DockingPlanner::new(DockingConfig::default()).expect("valid")
}

/// Each error gives the fault, the place, and the remedy.
#[test]
fn bad_input_is_refused_with_a_reason() {
    let wall = ObstacleScene::new(&[Obstacle::Segment(at(0.25, -1.0), at(0.25, 1.0))]).unwrap();
    let (here, there) = (Pose2::IDENTITY, Pose2::new(-0.5, 0.0, 0.0));
    let far = Pose2::new(-50.5, 0.0, 0.0);
    let nowhere = Pose2 { x: f64::NAN, ..there };
    let cases = [
        (here, there, "the start overlaps obstacle 0 at (0.250, 0.000) m"),
        (there, here, "the goal overlaps obstacle 0 at (0.250, 0.000) m"),
        (there, far, "the goal is 50.00 m away, expected at most 5.00 m: plan a path there first"),
        (nowhere, there, "start is (NaN, 0, 0), expected finite numbers"),
        (there, nowhere, "goal is (NaN, 0, 0), expected finite numbers"),
    ];
    for method in [Method::Optimal, Method::Hong24] {
        let mut config = DockingConfig::default();
        config.method = method;
        let planner = DockingPlanner::new(config).unwrap();
        for (start, goal, expected) in cases {
            let message = planner.plan(&robot(), &wall, start, goal).unwrap_err().to_string();
            assert!(message.contains(expected), "{message}");
            let started = planner.begin(0.01, &robot(), &wall, start, goal).unwrap_err().to_string();
            assert_eq!(message, started);
        }
    }
    let shape = |corners: &[(f64, f64)]| {
        Footprint::polygon(corners.iter().map(|&(x, y)| at(x, y)).collect()).unwrap_err().to_string()
    };
    assert!(shape(&[(0.3, 0.2), (-0.3, 0.2), (0.0, 0.1), (-0.3, -0.2), (0.3, -0.2)]).contains("convex"));
    assert!(shape(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)]).contains("area is 0 m^2"));
    assert!(Footprint::disc(0.0).is_err() && Footprint::disc(f64::NAN).is_err());
    let list = [Obstacle::Point(at(0.0, 0.0)), Obstacle::Segment(at(0.0, 1.0), at(f64::NAN, 0.0))];
    let message = ObstacleScene::new(&list).unwrap_err().to_string();
    assert!(message.contains("obstacle 1") && message.contains("finite"), "{message}");
}

#[test]
fn a_closed_wall_is_named_as_what_forbids_it() {
    let wall = Obstacle::Segment(at(0.0, -3.0), at(0.0, 3.0));
    let ends =
        [(-3.0, -3.0, 3.0, -3.0), (3.0, -3.0, 3.0, 3.0), (3.0, 3.0, -3.0, 3.0), (-3.0, 3.0, -3.0, -3.0)];
    let mut obstacles: Vec<Obstacle> =
        ends.map(|(a, b, c, d)| Obstacle::Segment(at(a, b), at(c, d))).to_vec();
    obstacles.push(wall);
    let scene = ObstacleScene::new(&obstacles).unwrap();
    let plan =
        planner().plan(&robot(), &scene, Pose2::new(-0.6, 0.0, 0.0), Pose2::new(0.6, 0.0, 0.0)).unwrap();
    let DockingPlan::Impossible(impossible) = plan else { panic!("{plan:?}") };
    assert_eq!(
        (impossible.certificate, impossible.by.unwrap().thing),
        (Certificate::Never, BlockerKind::Listed(4))
    );
}

/// A goal in the opposite direction in a corridor too narrow for a turn: proven impossible; with a wider place far away, out of reach.
#[test]
fn a_corridor_too_narrow_to_turn_is_certified() {
    let walls = [(-0.3, 0.3), (0.3, 0.3)].map(|(y, _)| Obstacle::Segment(at(-9.0, y), at(9.0, y)));
    let scene = ObstacleScene::new(&walls).unwrap();
    let plan = planner()
        .plan(&robot(), &scene, Pose2::IDENTITY, Pose2::new(0.1, 0.0, std::f64::consts::PI))
        .unwrap();
    assert!(
        matches!(plan, DockingPlan::Impossible(i) if i.certificate == Certificate::Never && i.by.is_some())
    );
}

/// A wall with ends: no path around it within the first reach, but one in the extended search.
#[test]
fn a_path_around_a_wall_is_found_farther_off() {
    let wall = ObstacleScene::new(&[Obstacle::Polygon(
        [(-0.05, -2.2), (0.05, -2.2), (0.05, 2.2), (-0.05, 2.2)].map(|(x, y)| at(x, y)).to_vec(),
    )])
    .unwrap();
    let (start, goal) = (Pose2::new(-0.4, 0.0, 1.57), Pose2::new(0.4, 0.0, 1.57));
    let plan = planner().plan(&robot(), &wall, start, goal).unwrap();
    let DockingPlan::Found(solution) = plan else { panic!("{plan:?}") };
    assert!(solution.manoeuvre.end().distance(&goal) < 1e-9);
}

/// A corridor of a map, too narrow for a turn and longer than any query: none of its walls may be left out.
#[test]
fn no_turn_leads_through_the_walls_of_a_map() {
    let free = |y: usize| (4..40).contains(&y);
    let cell = |i: usize| if free(i / 800) { Cell::Free } else { Cell::Occupied };
    let geometry = GridGeometry::new(0.02, at(0.0, 0.0), 800, 44).unwrap();
    let grid = OccupancyGrid::new(geometry, (0..800 * 44).map(cell).collect()).unwrap();
    let (config, y) = (DockingConfig::default(), 0.44);
    for turned in [120.0_f64, 150.0, 179.9] {
        let (start, goal) = (Pose2::new(7.0, y, 0.0), Pose2::new(9.0, y, turned.to_radians()));
        let (center, half) = config.view(&robot(), &start, &goal);
        let scene = ObstacleScene::from_grid(&grid, center, half, true);
        match planner().plan(&robot(), &scene, start, goal) {
            Ok(DockingPlan::Impossible(_)) | Err(DockingRefusal::GoalBlocked(_)) => {}
            other => panic!("{turned}: {other:?}"),
        }
    }
}

#[test]
fn the_default_method_solves_the_papers_scenarios_with_a_bound() {
    for scenario in Scenario::ALL {
        let Problem { footprint, start, goal, .. } = scenario.problem();
        let plan = planner().plan(&footprint, &scenario.problem().scene().unwrap(), start, goal).unwrap();
        let DockingPlan::Found(solution) = plan else { panic!("{scenario:?}: {plan:?}") };
        assert!(solution.manoeuvre.end().distance(&goal) < 1e-9);
        assert!(
            solution.bound <= solution.manoeuvre.duration()
                && solution.bound > 0.3 * solution.manoeuvre.duration()
        );
    }
}

/// Every manoeuvre ends exactly, is free of contact, and is consistent with its lower bound.
#[test]
fn manoeuvres_are_free_and_end_exactly() {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    for i in 0..60 {
        let problem = generate(format!("{i}"), &mut rng);
        let scene = problem.scene().unwrap();
        let DockingPlan::Found(solution) =
            planner().plan(&problem.footprint, &scene, problem.start, problem.goal).unwrap()
        else {
            continue;
        };
        let manoeuvre = &solution.manoeuvre;
        assert!(
            manoeuvre.end().distance(&problem.goal) < 1e-9
                && (manoeuvre.end().theta - problem.goal.theta).abs() < 1e-9
        );
        assert!(solution.bound <= manoeuvre.duration() + 1e-9);
        let mut space = ContactSpace::new(&problem.footprint, solution.margin, &scene);
        for step in manoeuvre.steps() {
            let free = match step.motion {
                Motion::Turn(angle) => {
                    let free = space.turn(&step.from);
                    if angle > 0.0 { angle <= free.left + 1e-6 } else { -angle <= free.right + 1e-6 }
                }
                Motion::Drive(length) => {
                    let free = space.drive(&step.from, length.abs() + 0.1);
                    length <= free.ahead + 1e-6 && -length <= free.behind + 1e-6
                }
            };
            assert!(free, "problem {i}: {step:?}");
        }
    }
}

/// Problems that no beam gets through: a motion of any kind first, then legs along it.
#[test]
fn hardly_any_room_takes_many_motions_and_is_solved() {
    let problems = parse(include_str!("../data/hard.txt")).unwrap();
    let mut config = DockingConfig::default();
    config.margin = 0.0;
    let planner = DockingPlanner::new(config).unwrap();
    for problem in problems.iter().filter(|p| p.name == "1-297" || p.name == "1-1385") {
        let scene = problem.scene().unwrap();
        let plan = planner.plan(&problem.footprint, &scene, problem.start, problem.goal).unwrap();
        let DockingPlan::Found(solution) = plan else { panic!("{}: {plan:?}", problem.name) };
        let manoeuvre = &solution.manoeuvre;
        assert!(manoeuvre.end().distance(&problem.goal) < 1e-9 && manoeuvre.steps().len() > 6);
        for i in 0..=2000 {
            let (pose, _) = manoeuvre.at(manoeuvre.duration() * f64::from(i) / 2000.0);
            let clearance = scene.clearance(&problem.footprint, &pose, 1e-3);
            assert!(clearance.is_none_or(|(distance, _)| distance > 0.0), "{} touches", problem.name);
        }
    }
}

/// On a map, the error gives the blocking cell instead of a segment of an outline.
#[test]
fn on_a_map_the_blocking_cell_is_named() {
    let wall = "#".repeat(30) + "\n";
    let row = "...............#..........????\n";
    let grid = OccupancyGrid::from_ascii(0.1, &(wall.clone() + &row.repeat(16) + &wall)).unwrap();
    let scene = ObstacleScene::from_grid(&grid, at(1.5, 0.9), 5.0, true);
    let (free, disc) = (Pose2::new(0.8, 0.9, 0.0), Footprint::disc(0.2).unwrap());
    let message = |goal: Pose2| planner().plan(&disc, &scene, free, goal).unwrap_err().to_string();
    let goal = |x: f64, y: f64| Pose2::new(x, y, 0.0);
    assert_eq!(message(goal(1.38, 0.93)), "the goal overlaps the occupied cell at (1.550, 0.950) m");
    assert_eq!(message(goal(1.55, 0.93)), "the goal overlaps the occupied cell at (1.550, 0.950) m");
    assert_eq!(message(goal(2.75, 0.85)), "the goal overlaps the unknown cell at (2.650, 0.850) m");
    assert!(message(goal(-0.05, 0.93)).contains("the goal overlaps the end of the map at ("));
    let DockingPlan::Impossible(none) = planner().plan(&disc, &scene, free, goal(2.1, 0.9)).unwrap() else {
        panic!("through a wall")
    };
    assert_eq!((none.certificate, none.by.unwrap().thing), (Certificate::Never, BlockerKind::Occupied));
}

#[test]
fn a_grid_is_a_scene() {
    let (wall, free) = ("#".repeat(20) + "\n", ".".repeat(20) + "\n");
    let art = wall.clone() + &free.repeat(7) + &wall;
    let grid = OccupancyGrid::from_ascii(0.1, &art).unwrap();
    let scene = ObstacleScene::from_grid(&grid, at(1.0, 0.45), 3.0, false);
    let plan =
        planner().plan(&robot(), &scene, Pose2::new(0.7, 0.4, 0.0), Pose2::new(0.9, 0.5, 0.0)).unwrap();
    assert!(matches!(plan, DockingPlan::Found(_)));
}

/// A hundred thousand points on two noisy walls: in less than 100 ms of one core.
#[test]
fn a_hundred_thousand_points_are_planned() {
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    let mut point = |side: f64| {
        Obstacle::Point(at(rng.random_range(-1.6..1.6), side * (0.42 + rng.random_range(0.0..0.02))))
    };
    let points: Vec<Obstacle> = (0..100_000).map(|i| point(if i % 2 == 0 { 1.0 } else { -1.0 })).collect();
    let scene = ObstacleScene::new(&points).unwrap();
    let (start, goal) = (Pose2::new(0.0, -0.1, 0.1), Pose2::new(0.1, 0.12, 0.0));
    let plan = || planner().plan(&robot(), &scene, start, goal).unwrap();
    let (found, ms) = timed(plan);
    let DockingPlan::Found(solution) = found else { panic!("{found:?}") };
    // Checked against every point: exact although planned among a few.
    let mut space = ContactSpace::new(&robot(), solution.margin, &scene);
    for step in solution.manoeuvre.steps() {
        let free = match step.motion {
            Motion::Turn(angle) => space.turn(&step.from).turn_by(angle) == Some(angle),
            Motion::Drive(length) => space.drive(&step.from, length.abs() + 0.01).allows(length),
        };
        assert!(free, "{step:?}");
    }
    let min = (0..6).map(|_| timed(plan).1).fold(ms, f64::min);
    eprintln!("100,000 points: {min:.0} ms of one core");
    assert!(min < 100.0 * slowness(), "{min:.0} ms");
}
