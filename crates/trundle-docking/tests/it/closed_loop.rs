//! The positioner in a small kinematic world: noise on the pose, wheels that lag.

use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trundle_core::{Pose2, Stamp, Twist2, Vector2, wrap_angle};
use trundle_docking::corridor::{Problem, generate};
use trundle_docking::{
    Docker, DockingConfig, Obstacle, Plan, Positioner, PositionerConfig, PositionerInput, Reason, Scene,
};

const DT: f64 = 0.05;

/// A base whose speeds follow the command with a lag of 80 ms, and a pose sensor with noise of 2 mm and 0.15 deg.
struct World {
    pose: Pose2,
    twist: Twist2,
    rng: ChaCha8Rng,
}

impl World {
    fn new(pose: Pose2, seed: u64) -> Self {
        Self { pose, twist: Twist2::ZERO, rng: ChaCha8Rng::seed_from_u64(seed) }
    }

    fn advance(&mut self, command: Twist2) {
        for _ in 0..5 {
            let part = 1.0 - (-DT / 5.0 / 0.08_f64).exp();
            self.twist.v += (command.v - self.twist.v) * part;
            self.twist.omega += (command.omega - self.twist.omega) * part;
            self.pose = self.pose.advance(self.twist, DT / 5.0);
        }
    }

    fn measured(&mut self) -> Pose2 {
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

/// How a run ended.
struct Run {
    settled: bool,
    within: bool,
    contact: bool,
    motions: usize,
}

fn run(problem: &Problem, seed: u64) -> Run {
    let scene = problem.scene().unwrap();
    let mut positioner = Positioner::new(
        DockingConfig::default(),
        PositionerConfig::default(),
        problem.footprint.clone(),
        problem.goal,
    )
    .unwrap();
    let mut world = World::new(problem.start, seed);
    let (mut contact, mut motions, mut moving) = (false, 0, false);
    for i in 0..(240.0 / DT) as usize {
        let input = PositionerInput {
            stamp: Stamp::default().after(i as f64 * DT),
            pose: world.measured(),
            scene: &scene,
        };
        let report = positioner.step(&input);
        motions += usize::from(matches!(report.reason, Reason::Moving(_)) && !moving);
        moving = matches!(report.reason, Reason::Moving(_));
        world.advance(report.twist);
        contact |= scene.clearance(&problem.footprint, &world.pose, 1e-3).is_some_and(|(d, _)| d == 0.0);
        if positioner.is_settled() {
            break;
        }
    }
    let error = problem.goal.inverse() * world.pose;
    let within = error.position().norm() <= 0.01 && wrap_angle(error.theta).abs() <= 1_f64.to_radians();
    Run { settled: positioner.is_settled(), within, contact, motions }
}

/// Of solvable problems, 99 % settle within 1 cm and 1 deg, and none touches anything.
#[test]
fn settles_under_noise() {
    let mut rng = ChaCha8Rng::seed_from_u64(77);
    let docker = Docker::new(DockingConfig { bound_boxes: 0, ..DockingConfig::default() }).unwrap();
    let (mut count, mut good, mut contacts, mut motions) = (0_u64, 0, 0, 0);
    while count < 500 {
        let problem = generate("closed", &mut rng);
        let scene = problem.scene().unwrap();
        let plan = docker.plan(&problem.footprint, &scene, problem.start, problem.goal).unwrap();
        if !matches!(plan, Plan::Found(_)) {
            continue;
        }
        count += 1;
        let run = run(&problem, count);
        good += u32::from(run.settled && run.within);
        contacts += u32::from(run.contact);
        motions += run.motions;
        if !run.settled || !run.within || run.contact {
            eprintln!(
                "problem {count}: settled {} within {} contact {} motions {}",
                run.settled, run.within, run.contact, run.motions
            );
        }
    }
    eprintln!(
        "{good} of {count} settled within 1 cm and 1 deg, {contacts} with contact, {:.2} motions each",
        motions as f64 / count as f64
    );
    assert!(good >= 495, "{good} of 500");
    assert_eq!(contacts, 0);
}

/// A box that appears in the way stops the robot in the next step; when it is gone, the robot goes on.
#[test]
fn stops_for_what_comes_in_the_way_and_starts_again() {
    let footprint = trundle_core::Footprint::KOBUKI;
    let goal = Pose2::new(1.0, 0.0, 0.0);
    let at = |x: f64, y: f64| Vector2::new(x, y);
    let walls = vec![
        Obstacle::Segment(at(-1.0, 0.3), at(2.0, 0.3)),
        Obstacle::Segment(at(-1.0, -0.3), at(2.0, -0.3)),
    ];
    let mut blocked = walls.clone();
    blocked.push(Obstacle::Polygon(vec![at(0.62, -0.2), at(0.7, -0.2), at(0.7, 0.2), at(0.62, 0.2)]));
    let (open, blocked) = (Scene::new(&walls).unwrap(), Scene::new(&blocked).unwrap());
    let mut positioner =
        Positioner::new(DockingConfig::default(), PositionerConfig::default(), footprint.clone(), goal)
            .unwrap();
    let mut world = World::new(Pose2::IDENTITY, 5);
    let mut stopped_after = None;
    let mut appeared = None;
    for i in 0..1200 {
        let time = i as f64 * DT;
        if appeared.is_none() && world.pose.x > 0.2 {
            appeared = Some(time);
        }
        let there = appeared.is_some_and(|since| time - since < 10.0);
        let scene = if there { &blocked } else { &open };
        let report = positioner.step(&PositionerInput {
            stamp: Stamp::default().after(time),
            pose: world.measured(),
            scene,
        });
        if there && stopped_after.is_none() && matches!(report.reason, Reason::Obstacle(_)) {
            assert_eq!(report.twist, Twist2::ZERO);
            stopped_after = Some(time);
        }
        world.advance(report.twist);
        assert!(
            !there || scene.clearance(&footprint, &world.pose, 1.0).unwrap().0 > 0.0,
            "touched at {time} s"
        );
        if positioner.is_settled() {
            break;
        }
    }
    assert!(stopped_after.is_some() && positioner.is_settled());
}
