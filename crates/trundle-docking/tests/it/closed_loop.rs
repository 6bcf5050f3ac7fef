//! The positioner in the small world.

use crate::world::{DT, World, run};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use trundle_core::{Pose2, Stamp, Twist2, Vector2};
use trundle_docking::corridor::generate;
use trundle_docking::{
    Docker, DockingConfig, Obstacle, Plan, Positioner, PositionerConfig, PositionerInput, Reason, Scene,
};

/// Solvable problems settle within 1 cm and 1 deg, and none touches anything; the benchmark does 500 of them.
#[test]
fn settles_under_noise() {
    let mut rng = ChaCha8Rng::seed_from_u64(77);
    let docker = Docker::new(DockingConfig { bound_boxes: 0, ..DockingConfig::default() }).unwrap();
    let (mut count, mut good, mut contacts, mut motions) = (0_u64, 0, 0, 0);
    while count < 40 {
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
                "problem {count}: {:.1} s, settled {} within {} contact {} motions {}",
                run.time, run.settled, run.within, run.contact, run.motions
            );
        }
    }
    eprintln!(
        "{good} of {count} settled within 1 cm and 1 deg, {contacts} with contact, {:.2} motions each",
        motions as f64 / count as f64
    );
    assert!(good == 40, "{good} of 40");
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
