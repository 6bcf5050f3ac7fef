//! Plans against manoeuvres that were driven at random: no proof excludes them, and no bound is above their time.

use crate::common::{any_pose, at, mapped, mirrored, mirrored_footprint, robot, scene, wall};
use crate::contact::{CONTACT_M, distance, footprint, obstacle, sides};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trundle_core::{Footprint, Pose2, Vector2, wrap_angle};
use trundle_docking::corridor::generate;
use trundle_docking::{
    DockingConfig, DockingPlan, DockingPlanner, Manoeuvre, Motion, MotionLimits, Obstacle, ObstacleScene,
    Solution,
};

/// Walks of each law.
const WALKS: usize = 40;
/// Distance that a walk keeps from every obstacle, m.
const KEPT: f64 = 2e-3;

/// A manoeuvre driven at random among obstacles.
struct Walk {
    footprint: Footprint,
    obstacles: Vec<Obstacle>,
    manoeuvre: Manoeuvre,
}

type Sides = [(Vector2, Vector2)];

/// The least distance from every obstacle during a motion, no point of the robot moving by more than 2 mm between two samples.
fn min_distance(footprint: &Footprint, from: Pose2, motion: Motion, pieces: &Sides) -> f64 {
    let arm = if matches!(motion, Motion::Turn(_)) { footprint.circumscribed_radius() } else { 1.0 };
    let samples = (motion.amount().abs() * arm / 0.002).ceil().max(1.0) as u32;
    let pose = |i: u32| motion.after(from, motion.amount() * f64::from(i) / f64::from(samples));
    (0..=samples).map(|i| distance(footprint, &pose(i), pieces)).fold(f64::INFINITY, f64::min)
}

/// The least distance from every obstacle during a manoeuvre, m.
fn min_of(footprint: &Footprint, manoeuvre: &Manoeuvre, pieces: &Sides) -> f64 {
    let steps = manoeuvre.steps().iter();
    steps.map(|step| min_distance(footprint, step.from, step.motion, pieces)).fold(f64::INFINITY, f64::min)
}

fn walks(seed: u64, lengths: std::ops::Range<usize>) -> impl Iterator<Item = Walk> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    std::iter::from_fn(move || {
        loop {
            let footprint = footprint(&mut rng);
            let obstacles: Vec<_> = (0..rng.random_range(4..12)).map(|_| obstacle(&mut rng)).collect();
            let (pieces, start) = (sides(&obstacles), any_pose(&mut rng, 0.4));
            if distance(&footprint, &start, &pieces) < 2.0 * KEPT {
                continue;
            }
            let (mut pose, mut motions) = (start, Vec::new());
            let length = rng.random_range(lengths.clone());
            for _ in 0..20 * length {
                let motion = if motions.len() % 2 == 0 {
                    Motion::Turn(rng.random_range(-1.5..1.5))
                } else {
                    Motion::Drive(rng.random_range(-0.4..0.4))
                };
                if motions.len() < length && min_distance(&footprint, pose, motion, &pieces) > 2.0 * KEPT {
                    pose = motion.after(pose, motion.amount());
                    motions.push(motion);
                }
            }
            if motions.len() == length && start.distance(&pose) < 0.6 {
                let manoeuvre = Manoeuvre::new(start, &motions, MotionLimits::default());
                return Some(Walk { footprint, obstacles, manoeuvre });
            }
        }
    })
    .take(WALKS)
}

fn planner(bound_boxes: usize) -> DockingPlanner {
    let mut config = DockingConfig::default();
    config.margin = 0.0;
    config.max_work = 2_000_000;
    config.bound_boxes = bound_boxes;
    DockingPlanner::new(config).unwrap()
}

fn plan(planner: &DockingPlanner, walk: &Walk) -> DockingPlan {
    let (start, goal) = (walk.manoeuvre.start(), walk.manoeuvre.end());
    planner.plan(&walk.footprint, &scene(&walk.obstacles), start, goal).unwrap()
}

#[test]
fn no_proof_excludes_a_goal_that_was_reached_and_no_bound_is_above_the_time_it_took() {
    let planner = planner(400);
    let (mut found, mut faster) = (0, 0);
    for (i, walk) in walks(81, 1..6).enumerate() {
        match plan(&planner, &walk) {
            DockingPlan::Found(solution) => {
                found += 1;
                faster += usize::from(solution.manoeuvre.duration() <= walk.manoeuvre.duration() + 1e-9);
                let (bound, time) = (solution.bound, walk.manoeuvre.duration());
                assert!(bound <= time + 1e-9, "walk {i}: bound {bound} s above {time} s");
            }
            DockingPlan::Impossible(none) => {
                use trundle_docking::Certificate;
                assert_ne!(none.certificate, Certificate::Never, "walk {i}: {none:?}");
            }
        }
    }
    assert!(found >= WALKS - 2, "{found} of {WALKS} found");
    assert!(2 * faster > WALKS, "only {faster} of {WALKS} plans are as fast as a random walk");
}

#[test]
fn a_goal_reached_by_two_motions_is_always_found_and_hardly_slower() {
    let planner = planner(0);
    for (i, walk) in walks(82, 1..3).enumerate() {
        let DockingPlan::Found(solution) = plan(&planner, &walk) else { panic!("walk {i} is not found") };
        let (planned, driven) = (solution.manoeuvre.duration(), walk.manoeuvre.duration());
        assert!(planned <= 1.5 * driven + 1.0, "walk {i}: {planned} s instead of {driven} s");
    }
}

#[test]
fn the_bound_of_a_query_is_below_every_manoeuvre_that_solves_it() {
    let planner = planner(400);
    for (i, walk) in walks(83, 2..5).enumerate() {
        let (start, goal, scene) = (walk.manoeuvre.start(), walk.manoeuvre.end(), scene(&walk.obstacles));
        let bound = planner.bound(&walk.footprint, &scene, start, goal, 1e3).unwrap();
        let time = walk.manoeuvre.duration();
        assert!(bound <= time + 1e-9, "walk {i}: bound {bound} s above {time} s");
    }
}

/// The planner's solutions of some corridors.
fn solutions(seed: u64) -> Vec<(Footprint, Vec<Obstacle>, Solution)> {
    let (mut rng, planner) = (ChaCha8Rng::seed_from_u64(seed), planner(0));
    let problems = (0..25).map(|i| generate(format!("{i}"), &mut rng));
    let solved = problems.filter_map(|problem| {
        let scene = problem.scene().unwrap();
        match planner.plan(&problem.footprint, &scene, problem.start, problem.goal).unwrap() {
            DockingPlan::Found(solution) => Some((problem.footprint, problem.obstacles, solution)),
            DockingPlan::Impossible(_) => None,
        }
    });
    solved.collect()
}

fn rebuilt(start: Pose2, motions: impl Iterator<Item = Motion>) -> Manoeuvre {
    Manoeuvre::new(start, &motions.collect::<Vec<_>>(), MotionLimits::default())
}

#[test]
fn a_solution_driven_in_reverse_is_free_and_solves_the_reversed_problem() {
    for (footprint, obstacles, solution) in solutions(84) {
        let forth = &solution.manoeuvre;
        let reversed = forth.steps().iter().rev().map(|step| match step.motion {
            Motion::Turn(angle) => Motion::Turn(-angle),
            Motion::Drive(distance) => Motion::Drive(-distance),
        });
        let back = rebuilt(forth.end(), reversed);
        assert!(back.end().distance(&forth.start()) < 1e-9);
        assert!(wrap_angle(back.end().theta - forth.start().theta).abs() < 1e-9);
        assert!(min_of(&footprint, &back, &sides(&obstacles)) > -CONTACT_M);
    }
}

#[test]
fn a_solution_in_the_mirror_is_free_and_solves_the_mirrored_problem() {
    for (footprint, obstacles, solution) in solutions(85) {
        let one = &solution.manoeuvre;
        let flipped = one.steps().iter().map(|step| match step.motion {
            Motion::Turn(angle) => Motion::Turn(-angle),
            straight => straight,
        });
        let image = rebuilt(mirrored(one.start()), flipped);
        assert!(image.end().distance(&mirrored(one.end())) < 1e-9);
        let flipped = mapped(&obstacles, |p| at(p.x, -p.y));
        assert!(min_of(&mirrored_footprint(&footprint), &image, &sides(&flipped)) > -CONTACT_M);
    }
}

#[test]
fn every_pose_of_a_solution_keeps_the_margin_that_it_states() {
    let mut config = DockingConfig::default();
    config.bound_boxes = 0;
    let planner = DockingPlanner::new(config).unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(86);
    let mut kept_all = 0;
    for i in 0..25 {
        let problem = generate(format!("{i}"), &mut rng);
        let scene = problem.scene().unwrap();
        let plan = planner.plan(&problem.footprint, &scene, problem.start, problem.goal).unwrap();
        let DockingPlan::Found(solution) = plan else { continue };
        let min = min_of(&problem.footprint, &solution.manoeuvre, &sides(&problem.obstacles));
        assert!(min >= solution.margin - 1e-6, "problem {i}: {min} m instead of {}", solution.margin);
        assert!(solution.margin <= planner.config().margin);
        kept_all += usize::from(solution.margin == planner.config().margin);
    }
    assert!(kept_all > 5, "the whole margin is kept in {kept_all} of 25");
}

#[test]
fn without_obstacles_a_straight_move_and_a_turn_are_planned_as_such_and_bounded_exactly() {
    let (free, limits) = (scene(&[]), MotionLimits::default());
    let planner = planner(400);
    let solved = |goal: Pose2| match planner.plan(&robot(), &free, Pose2::IDENTITY, goal).unwrap() {
        DockingPlan::Found(solution) => solution,
        none => panic!("{none:?}"),
    };
    for distance in [0.7, -0.7] {
        let solution = solved(Pose2::new(distance, 0.0, 0.0));
        assert_eq!(solution.manoeuvre.steps().len(), 1);
        assert!((solution.manoeuvre.duration() - limits.drive_time(distance)).abs() < 1e-9);
        assert!(solution.bound > 0.98 * solution.manoeuvre.duration());
    }
    for angle in [1.2, -2.9] {
        let solution = solved(Pose2::new(0.0, 0.0, angle));
        assert!((solution.manoeuvre.duration() - limits.turn_time(angle)).abs() < 1e-9);
    }
    assert_eq!(solved(Pose2::IDENTITY).manoeuvre.duration(), 0.0);
}

#[test]
fn no_time_is_below_what_the_distance_and_the_turn_alone_take() {
    let limits = MotionLimits::default();
    for (_, _, solution) in solutions(87) {
        let (start, goal) = (solution.manoeuvre.start(), solution.manoeuvre.end());
        let min = limits
            .drive_time(start.distance(&goal))
            .max(limits.turn_time(wrap_angle(goal.theta - start.theta)));
        assert!(solution.manoeuvre.duration() >= min - 1e-9);
    }
}

#[test]
fn walls_on_all_sides_keep_the_robot_inside_and_the_proof_names_one_of_them() {
    let closed: Vec<Obstacle> = [
        ((-0.6, -0.6), (0.6, -0.6)),
        ((0.6, -0.6), (0.6, 0.6)),
        ((0.6, 0.6), (-0.6, 0.6)),
        ((-0.6, 0.6), (-0.6, -0.6)),
    ]
    .map(|(a, b)| wall(a, b))
    .to_vec();
    let planner = planner(0);
    for goal in [(1.2, 0.0), (-1.2, 0.3), (0.0, 1.2)] {
        let goal = Pose2::new(goal.0, goal.1, 0.4);
        let plan = planner.plan(&robot(), &scene(&closed), Pose2::IDENTITY, goal).unwrap();
        let DockingPlan::Impossible(none) = plan else { panic!("{plan:?}") };
        assert_eq!(none.certificate, trundle_docking::Certificate::Never);
        let by = none.by.unwrap();
        assert!(by.at.amax() < 0.6 + 1e-9, "{by}");
    }
}

/// A scene of obstacles that no plan near the origin can meet.
fn far_away() -> ObstacleScene {
    scene(&[wall((50.0, 50.0), (60.0, 50.0)), Obstacle::Point(at(-70.0, 0.0))])
}

#[test]
fn obstacles_out_of_reach_change_nothing() {
    let (planner, mut rng) = (planner(100), ChaCha8Rng::seed_from_u64(88));
    for _ in 0..10 {
        let (start, goal) = (any_pose(&mut rng, 0.5), any_pose(&mut rng, 0.5));
        let plans =
            [scene(&[]), far_away()].map(|scene| planner.plan(&robot(), &scene, start, goal).unwrap());
        assert_eq!(plans[0], plans[1]);
    }
}
