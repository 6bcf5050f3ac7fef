//! Whole plans of any footprint among any obstacles, compared with exhaustive search.

use crate::contact::{CONTACT_M, distance, footprint, obstacle, sides};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;
use trundle_core::{Footprint, Pose2, Vector2};
use trundle_docking::{
    Certificate, DockingConfig, DockingPlan, DockingPlanner, Manoeuvre, Method, Obstacle, ObstacleScene,
};

const PROBLEMS: usize = 100;

/// Start and goal with some centimetres of clearance, near each other.
pub fn ends(rng: &mut ChaCha8Rng, free: impl Fn(&Pose2) -> bool) -> Option<(Pose2, Pose2)> {
    let start =
        Pose2::new(rng.random_range(-0.3..0.3), rng.random_range(-0.3..0.3), rng.random_range(-PI..PI));
    let part = if rng.random_bool(0.3) { 3.0 } else { 0.4 };
    let by =
        Pose2::new(rng.random_range(-0.3..0.3), rng.random_range(-0.25..0.25), rng.random_range(-part..part));
    let goal = start * by;
    (free(&start) && free(&goal)).then_some((start, goal))
}

/// The minimum distance along the path; no point of the robot moves more than 2 mm between two samples.
fn min_along_path(footprint: &Footprint, manoeuvre: &Manoeuvre, pieces: &[(Vector2, Vector2)]) -> f64 {
    let arm = footprint.circumscribed_radius().max(1.0);
    let mut min = f64::INFINITY;
    for step in manoeuvre.steps() {
        let amount = step.motion.amount();
        let samples = (amount.abs() * arm / 0.002).ceil().max(1.0) as u32;
        for i in 0..=samples {
            let pose = step.motion.after(step.from, amount * f64::from(i) / f64::from(samples));
            min = min.min(distance(footprint, &pose, pieces));
        }
    }
    min
}

/// Discs, triangles and heptagons with any axle, also outside. Every manoeuvre is free and ends exactly, and no query that the greedy
/// method solves is called impossible.
#[test]
fn any_shape_is_safe_and_nothing_possible_is_called_impossible() {
    let mut rng = ChaCha8Rng::seed_from_u64(21);
    let mut config = DockingConfig::default();
    config.max_work = 4_000_000;
    config.bound_boxes = 100;
    let dockers = [0.0, 0.01].map(|margin| {
        let mut config = config.clone();
        config.margin = margin;
        DockingPlanner::new(config).unwrap()
    });
    let mut by_paper = config;
    by_paper.method = Method::Hong24;
    by_paper.margin = 0.0;
    let greedy = DockingPlanner::new(by_paper).unwrap();
    let (mut count, mut found, mut never, mut min) = (0, 0, 0, f64::INFINITY);
    while count < PROBLEMS {
        let footprint = footprint(&mut rng);
        let obstacles: Vec<Obstacle> = (0..rng.random_range(4..16)).map(|_| obstacle(&mut rng)).collect();
        let (scene, pieces) = (ObstacleScene::new(&obstacles).unwrap(), sides(&obstacles));
        let free = |pose: &Pose2| scene.clearance(&footprint, pose, 0.005).is_none();
        let Some((start, goal)) = ends(&mut rng, free) else { continue };
        count += 1;
        match dockers[count % 2].plan(&footprint, &scene, start, goal).unwrap() {
            DockingPlan::Found(solution) => {
                found += 1;
                let manoeuvre = &solution.manoeuvre;
                assert!(manoeuvre.end().distance(&goal) < 1e-9, "problem {count}");
                let on_the_way = min_along_path(&footprint, manoeuvre, &pieces);
                let kept = solution.margin - CONTACT_M;
                assert!(on_the_way >= kept, "problem {count}: {on_the_way} of {kept}");
                assert!(solution.bound <= manoeuvre.duration() + 1e-9);
                min = min.min(on_the_way);
            }
            DockingPlan::Impossible(none) => {
                let DockingPlan::Found(other) = greedy.plan(&footprint, &scene, start, goal).unwrap() else {
                    never += i32::from(none.certificate == Certificate::Never);
                    continue;
                };
                // The greedy method tests samples only, and ends near the goal: a clearance of one centimetre counts as free.
                let is_free = min_along_path(&footprint, &other.manoeuvre, &pieces) > 0.005;
                let is_there = other.manoeuvre.end().distance(&goal) < 1e-3;
                assert!(
                    !(is_free && is_there),
                    "problem {count}: {none:?}, but the greedy method finds a way"
                );
            }
        }
    }
    eprintln!("{found} of {count} found, {never} proven impossible; smallest clearance {:.2} mm", 1e3 * min);
    assert!(found > PROBLEMS / 2, "{found} of {count}");
}
