//! Scenes of a hundred thousand obstacle points, of many kinds, each seeded: for `cloud_bench` and the crate's tests.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::{PI, TAU};
use trundle_core::{Footprint, Pose2, Vector2};
use trundle_docking::corridor::{Problem, generate};
use trundle_docking::{Obstacle, ObstacleScene};

/// Points of a scene. Source: ours.
pub const COUNT: usize = 100_000;

/// All scenes.
pub fn scenes() -> Vec<Problem> {
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    let wall = |half: f64, thick: f64| {
        move |rng: &mut ChaCha8Rng| {
            let side = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
            Vector2::new(rng.random_range(-1.6..1.6), side * (half + rng.random_range(0.0..thick)))
        }
    };
    let anywhere =
        |rng: &mut ChaCha8Rng| Vector2::new(rng.random_range(-1.6..1.6), rng.random_range(-1.6..1.6));
    let centers: Vec<(Vector2, f64)> =
        (0..60).map(|_| (anywhere(&mut rng), rng.random_range(0.005..0.08))).collect();
    let blob = move |rng: &mut ChaCha8Rng| {
        let (center, size) = centers[rng.random_range(0..centers.len())];
        let (radius, bearing): (f64, f64) = (rng.random_range(0.0..1.0), rng.random_range(0.0..TAU));
        center + Vector2::new(bearing.cos(), bearing.sin()) * (size * radius * 2.0)
    };
    let lattice = |rng: &mut ChaCha8Rng| {
        let cell = |rng: &mut ChaCha8Rng| f64::from(rng.random_range(-160..160)) * 0.01;
        Vector2::new(cell(rng), cell(rng))
    };
    let room = |rng: &mut ChaCha8Rng| {
        let (t, s) = (rng.random_range(-0.6..0.6), if rng.random_bool(0.5) { 0.6 } else { -0.6 });
        if rng.random_bool(0.5) { Vector2::new(t, s) } else { Vector2::new(s, t) }
    };
    let (start, goal) = (Pose2::new(0.0, -0.1, 0.1), Pose2::new(0.1, 0.12, 0.0));
    let low = (Pose2::new(0.0, -0.05, 0.05), Pose2::new(0.1, 0.05, 0.0));
    let turned = Pose2::new(0.1, 0.0, PI);
    let mut list = vec![
        of("walls 2 cm thick", (start, goal), &mut rng, wall(0.42, 0.02)),
        of("walls 10 cm thick", (start, goal), &mut rng, wall(0.42, 0.1)),
        of("walls 1 cm thick, 0.72 m apart", (start, goal), &mut rng, wall(0.36, 0.01)),
        of("walls 1 cm thick, 0.60 m apart", low, &mut rng, wall(0.30, 0.01)),
        of("walls 3 cm thick, 0.50 m apart", low, &mut rng, wall(0.25, 0.03)),
        of("to turn where there is no room", (Pose2::IDENTITY, turned), &mut rng, wall(0.3, 0.02)),
        of("to turn in a small room", (Pose2::IDENTITY, turned), &mut rng, room),
        of("blobs", (start, goal), &mut rng, blob),
        of("blobs, a metre to go", (Pose2::new(-0.5, 0.0, 0.1), Pose2::new(0.5, 0.12, 2.0)), &mut rng, {
            let centers: Vec<Vector2> =
                (0..25).map(|_| anywhere(&mut ChaCha8Rng::seed_from_u64(1))).collect();
            move |rng: &mut ChaCha8Rng| {
                let bearing: f64 = rng.random_range(0.0..TAU);
                centers[rng.random_range(0..25)] + Vector2::new(bearing.cos(), bearing.sin()) * 0.04
            }
        }),
        of("everywhere", (start, goal), &mut rng, anywhere),
        of("everywhere but along the way", (start, goal), &mut rng, {
            let distance = Problem { start, goal, ..empty("way") };
            move |rng: &mut ChaCha8Rng| loop {
                let p = anywhere(rng);
                let on_way = (0..=20).any(|i| {
                    let t = f64::from(i) / 20.0;
                    let at = |a: f64, b: f64| a + (b - a) * t;
                    let (a, b) = (distance.start, distance.goal);
                    let seen =
                        Pose2::new(at(a.x, b.x), at(a.y, b.y), at(a.theta, b.theta)).inverse().transform(p);
                    seen.x.abs() < 0.5 && seen.y.abs() < 0.26
                });
                if !on_way {
                    return p;
                }
            }
        }),
        of("a lattice of 1 cm", (start, goal), &mut rng, lattice),
        of("a wall between", (Pose2::new(-0.45, 0.0, 0.0), Pose2::new(0.45, 0.0, 0.0)), &mut rng, |rng| {
            Vector2::new(rng.random_range(-0.02..0.02), rng.random_range(-3.2..3.2))
        }),
    ];
    list.extend((0..8).map(|i| of_corridor(i, &mut rng)));
    list
}

fn empty(name: &str) -> Problem {
    let corners = [(0.3, 0.2), (-0.3, 0.2), (-0.3, -0.2), (0.3, -0.2)];
    Problem {
        name: name.to_owned(),
        footprint: Footprint::Polygon { corners: corners.map(|(x, y)| Vector2::new(x, y)).to_vec() },
        start: Pose2::IDENTITY,
        goal: Pose2::IDENTITY,
        obstacles: Vec::new(),
    }
}

/// Points by chance, those within 1.2 cm of start and goal left out.
fn of(
    name: &str,
    (start, goal): (Pose2, Pose2),
    rng: &mut ChaCha8Rng,
    mut point: impl FnMut(&mut ChaCha8Rng) -> Vector2,
) -> Problem {
    let mut problem = Problem { start, goal, ..empty(name) };
    let near = |pose: &Pose2, p: Vector2| {
        let seen = pose.inverse().transform(p);
        seen.x.abs() < 0.312 && seen.y.abs() < 0.212
    };
    while problem.obstacles.len() < COUNT {
        let p = point(rng);
        if !near(&start, p) && !near(&goal, p) {
            problem.obstacles.push(Obstacle::Point(p));
        }
    }
    problem
}

/// A problem of the generator, its walls and boxes as points.
fn of_corridor(i: usize, rng: &mut ChaCha8Rng) -> Problem {
    let problem = generate(format!("corridor {i} as points"), rng);
    let scene = problem.scene().expect("valid");
    let sides: Vec<_> = scene.pieces().iter().map(|piece| piece.segment).collect();
    let whole: f64 = sides.iter().map(|s| (s.b - s.a).norm()).sum();
    let spacing = whole / COUNT as f64;
    let mut points = Vec::with_capacity(COUNT);
    for side in sides {
        let count = ((side.b - side.a).norm() / spacing).ceil().max(1.0);
        points.extend(
            (0..=count as usize).map(|k| Obstacle::Point(side.a + (side.b - side.a) * (k as f64 / count))),
        );
    }
    Problem { obstacles: points, ..problem }
}

/// The obstacles, prepared.
pub fn scene_of(problem: &Problem) -> ObstacleScene {
    problem.scene().expect("valid")
}
