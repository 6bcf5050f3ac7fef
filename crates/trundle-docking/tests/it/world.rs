//! A small kinematic world: noise on the pose, wheels that lag. The corridor benchmark uses it too.

use nalgebra::{Matrix3, Vector3};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trundle_core::{Pose2, Stamp, Twist2, wrap_angle};
use trundle_docking::corridor::Problem;
use trundle_docking::{DockingConfig, Positioner, PositionerConfig, PositionerInput, PositionerReason};

/// A control step, s.
pub const DT: f64 = 0.05;

/// A base whose speeds follow the command with a lag of 80 ms, and a pose sensor with noise of 2 mm and 0.15 deg.
pub struct World {
    /// The truth, `map_from_base`.
    pub pose: Pose2,
    twist: Twist2,
    rng: ChaCha8Rng,
}

impl World {
    /// At rest.
    pub fn new(pose: Pose2, seed: u64) -> Self {
        Self { pose, twist: Twist2::ZERO, rng: ChaCha8Rng::seed_from_u64(seed) }
    }

    /// One control step.
    pub fn advance(&mut self, command: Twist2) {
        for _ in 0..5 {
            let part = 1.0 - (-DT / 5.0 / 0.08_f64).exp();
            self.twist.v += (command.v - self.twist.v) * part;
            self.twist.omega += (command.omega - self.twist.omega) * part;
            self.pose = self.pose.advance(self.twist, DT / 5.0);
        }
    }

    /// The pose with noise.
    pub fn measured(&mut self) -> Pose2 {
        let (x, y, t) = (normal(&mut self.rng), normal(&mut self.rng), normal(&mut self.rng));
        Pose2::new(
            self.pose.x + 0.002 * x,
            self.pose.y + 0.002 * y,
            self.pose.theta + 0.15_f64.to_radians() * t,
        )
    }
}

/// The sum of twelve uniform numbers, less six.
fn normal(rng: &mut impl Rng) -> f64 {
    (0..12).map(|_| rng.random_range(0.0..1.0)).sum::<f64>() - 6.0
}

/// Result of a run.
pub struct Run {
    /// Whether the positioner reported the end.
    pub settled: bool,
    /// In truth within 1 cm and 1 deg.
    pub within: bool,
    /// Something was touched.
    pub contact: bool,
    /// Motions made.
    pub motions: usize,
    /// Time until the end, s.
    pub time: f64,
}

/// Covariance reported by the pose sensor.
pub fn covariance() -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(0.002, 0.002, 0.15_f64.to_radians()).map(|sigma| sigma * sigma))
}

/// Settles on the goal of a problem, four minutes at most.
pub fn run(problem: &Problem, docking: &DockingConfig, seed: u64) -> Run {
    let scene = problem.scene().expect("valid");
    let mut positioner = Positioner::new(
        docking.clone(),
        PositionerConfig::default(),
        problem.footprint.clone(),
        problem.goal,
    )
    .expect("valid");
    let mut world = World::new(problem.start, seed);
    let (mut contact, mut motions, mut moving, mut time) = (false, 0, false, 0.0);
    for i in 0..(240.0 / DT) as usize {
        time = i as f64 * DT;
        let input = PositionerInput {
            stamp: Stamp::default().after(i as f64 * DT),
            pose: world.measured(),
            covariance: covariance(),
            scene: &scene,
        };
        let report = positioner.step(&input);
        motions += usize::from(matches!(report.reason, PositionerReason::Moving(_)) && !moving);
        moving = matches!(report.reason, PositionerReason::Moving(_));
        world.advance(report.twist);
        contact |= scene.clearance(&problem.footprint, &world.pose, 1e-3).is_some_and(|(d, _)| d == 0.0);
        if positioner.is_settled() {
            break;
        }
    }
    let error = problem.goal.inverse() * world.pose;
    let within = error.position().norm() <= 0.01 && wrap_angle(error.theta).abs() <= 1_f64.to_radians();
    Run { settled: positioner.is_settled(), within, contact, motions, time }
}
