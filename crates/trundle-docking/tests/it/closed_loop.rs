//! The positioner in the small world.

use crate::world::{DT, World, covariance, run};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use trundle_core::{Footprint, Pose2, Stamp, Twist2, Vector2};
use trundle_docking::corridor::{Scenario, generate};
use trundle_docking::{
    DockingConfig, DockingPlan, DockingPlanner, Manoeuvre, Method, Obstacle, ObstacleScene, Positioner,
    PositionerConfig, PositionerInput, PositionerReason,
};

/// Solvable problems end within 1 cm and 1 deg without a contact; the benchmark runs 500 of them.
#[test]
fn it_reaches_the_goal_pose_under_noise() {
    let mut rng = ChaCha8Rng::seed_from_u64(77);
    let mut config = DockingConfig::default();
    config.bound_boxes = 0;
    let planner = DockingPlanner::new(config).unwrap();
    let (mut count, mut good, mut contacts, mut motions) = (0_u64, 0, 0, 0);
    while count < 40 {
        let problem = generate("closed", &mut rng);
        let scene = problem.scene().unwrap();
        let plan = planner.plan(&problem.footprint, &scene, problem.start, problem.goal).unwrap();
        if !matches!(plan, DockingPlan::Found(_)) {
            continue;
        }
        count += 1;
        let run = run(&problem, &DockingConfig::default(), count);
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

/// A box appears ahead: the command is zero within 0.1 s; after its removal, the robot continues from its present pose.
fn stops_and_starts_again(method: Method) {
    let footprint = Footprint::KOBUKI;
    let goal = Pose2::new(1.0, 0.0, 0.0);
    let at = |x: f64, y: f64| Vector2::new(x, y);
    let walls = vec![
        Obstacle::Segment(at(-6.0, 0.3), at(7.0, 0.3)),
        Obstacle::Segment(at(-6.0, -0.3), at(7.0, -0.3)),
    ];
    let mut blocked = walls.clone();
    blocked.push(Obstacle::Polygon(vec![at(0.48, -0.2), at(0.56, -0.2), at(0.56, 0.2), at(0.48, 0.2)]));
    let (open, blocked) = (ObstacleScene::new(&walls).unwrap(), ObstacleScene::new(&blocked).unwrap());
    let mut docking = DockingConfig::default();
    docking.method = method;
    let mut positioner =
        Positioner::new(docking, PositionerConfig::default(), footprint.clone(), goal).unwrap();
    let mut world = World::new(Pose2::IDENTITY, 5);
    let (mut appeared, mut stopped, mut stood, mut went_on) = (None, None, None, None);
    for i in 0..2400 {
        let time = i as f64 * DT;
        if appeared.is_none() && world.pose.x > 0.2 {
            appeared = Some(time);
        }
        let there = appeared.is_some_and(|since| time - since < 10.0);
        let scene = if there { &blocked } else { &open };
        let stamp = Stamp::default().after(time);
        let input = PositionerInput { stamp, pose: world.measured(), covariance: covariance(), scene };
        let report = positioner.step(&input);
        if there && stopped.is_none() && matches!(report.reason, PositionerReason::Obstacle(_)) {
            assert_eq!(report.twist, Twist2::ZERO);
            stopped = Some(time);
        }
        if stopped.is_some() && there {
            stood = Some(world.pose);
        }
        if appeared.is_some() && !there && went_on.is_none() && report.twist != Twist2::ZERO {
            went_on = Some(world.pose);
        }
        world.advance(report.twist);
        assert!(
            !there || scene.clearance(&footprint, &world.pose, 1.0).unwrap().0 > 0.0,
            "{method:?} touched at {time} s"
        );
        if positioner.is_settled() {
            break;
        }
    }
    let (appeared, stopped) = (appeared.unwrap(), stopped.expect("stopped"));
    assert!(stopped - appeared <= 0.1 + 1e-9, "{method:?}: stopped {:.2} s after", stopped - appeared);
    assert!(
        went_on.expect("went on").distance(&stood.expect("stood")) < 0.01,
        "{method:?} went on elsewhere"
    );
    assert!(positioner.is_settled(), "{method:?}");
    let error = goal.inverse() * world.pose;
    assert!(error.position().norm() < 0.015 && error.theta.abs() < 0.0175, "{method:?}: {error:?}");
}

#[test]
fn stops_for_what_comes_in_the_way_and_starts_again() {
    stops_and_starts_again(Method::Optimal);
}

#[test]
fn the_papers_method_stops_and_starts_again_too() {
    stops_and_starts_again(Method::Hong24);
}

/// A positioner with a search of many steps: returns the step of its first motion; pose and scene are given by step.
fn begins<'s>(
    method: Method,
    at: impl Fn(usize) -> (Pose2, &'s ObstacleScene),
) -> (Vec<PositionerReason>, Option<(usize, Manoeuvre)>) {
    let mut docking = DockingConfig::default();
    docking.method = method;
    let mut config = PositionerConfig::default();
    config.step_work = 10_000;
    let goal = Pose2::new(0.1, 0.9, 0.2);
    let mut positioner = Positioner::new(docking, config, Footprint::KOBUKI, goal).unwrap();
    let (mut reasons, mut began) = (Vec::new(), None);
    for i in 0..1000 {
        let (pose, scene) = at(i);
        let stamp = Stamp::default().after(i as f64 * DT);
        let report = positioner.step(&PositionerInput { stamp, pose, covariance: covariance(), scene });
        reasons.push(report.reason.clone());
        if matches!(report.reason, PositionerReason::Moving(_)) {
            began = Some((i, positioner.manoeuvre().expect("planned").clone()));
            break;
        }
    }
    (reasons, began)
}

/// Obstacles out of the robot's reach, which make the search longer.
fn far_off() -> Vec<Obstacle> {
    let around = |i: u32| {
        let (sin, cos) = (f64::from(i) * 0.01 * std::f64::consts::TAU).sin_cos();
        let p = Vector2::new(1.4 * cos, 0.45 + 1.4 * sin);
        Obstacle::Segment(p, p + Vector2::new(0.01, 0.0))
    };
    (0..100).map(around).collect()
}

/// The step in the middle of the first search.
fn amid(reasons: &[PositionerReason]) -> usize {
    let planning = |i: &usize| reasons[*i] == PositionerReason::Planning;
    let steps: Vec<usize> = (0..reasons.len()).filter(planning).collect();
    assert!(steps.len() > 3, "a search of {} steps", steps.len());
    steps[steps.len() / 2]
}

/// A robot that is pushed during planning plans again from its new pose.
#[test]
fn a_plan_from_where_it_no_longer_stands_is_not_carried_out() {
    let scene = ObstacleScene::new(&far_off()).unwrap();
    let (here, there) = (Pose2::IDENTITY, Pose2::new(0.0, 0.05, 0.0));
    for method in [Method::Optimal, Method::Hong24] {
        let (reasons, began) = begins(method, |_| (here, &scene));
        assert!(began.unwrap().1.start().distance(&here) < 1e-9, "{method:?}");
        let pushed = amid(&reasons);
        let (again, began) = begins(method, |i| (if i < pushed { here } else { there }, &scene));
        assert_eq!(again[pushed], PositionerReason::Measuring, "{method:?}");
        assert!(began.unwrap().1.start().distance(&there) < 1e-9, "{method:?}");
    }
}

/// A finished plan is checked against the present obstacles, up to its last motion: its first motion here, a turn of a disc, is free.
#[test]
fn a_plan_through_what_has_come_meanwhile_is_not_carried_out() {
    let mut around = far_off();
    let open = ObstacleScene::new(&around).unwrap();
    around.push(Obstacle::Point(Vector2::new(0.05, 0.45)));
    let shut = ObstacleScene::new(&around).unwrap();
    for method in [Method::Optimal, Method::Hong24] {
        let (reasons, began) = begins(method, |_| (Pose2::IDENTITY, &open));
        let (came, (first, _)) = (amid(&reasons), began.unwrap());
        let (again, began) = begins(method, |i| (Pose2::IDENTITY, if i < came { &open } else { &shut }));
        assert!(matches!(again[first], PositionerReason::Obstacle(_)), "{method:?}: {:?}", again[first]);
        let (_, manoeuvre) = began.expect("another way");
        for i in 0..=200 {
            let (pose, _) = manoeuvre.at(manoeuvre.duration() * f64::from(i) / 200.0);
            assert!(shut.clearance(&Footprint::KOBUKI, &pose, 0.003).is_none(), "{method:?}: {pose:?}");
        }
    }
}

/// The paper's four scenarios in closed loop with its own method: the end is within its thresholds, without contact.
#[test]
fn the_method_of_hong24_reaches_its_goals_under_noise() {
    let mut docking = DockingConfig::default();
    docking.method = Method::Hong24;
    for scenario in Scenario::ALL {
        let run = run(&scenario.problem(), &docking, 3);
        assert!(run.settled && !run.contact, "{scenario:?}: settled {} contact {}", run.settled, run.contact);
    }
}

/// A pose known badly keeps farther from the wall than one known well.
#[test]
fn the_margin_follows_the_covariance() {
    let wall =
        ObstacleScene::new(&[Obstacle::Segment(Vector2::new(-2.0, 0.36), Vector2::new(2.0, 0.36))]).unwrap();
    let footprint = Footprint::KOBUKI;
    let (start, goal) = (Pose2::IDENTITY, Pose2::new(0.1, 0.08, 0.0));
    let nearest = |sigma: f64| {
        let mut positioner =
            Positioner::new(DockingConfig::default(), PositionerConfig::default(), footprint.clone(), goal)
                .unwrap();
        let covariance = nalgebra::Matrix3::from_diagonal_element(sigma * sigma);
        for i in 0..20 {
            let stamp = Stamp::default().after(i as f64 * DT);
            positioner.step(&PositionerInput { stamp, pose: start, covariance, scene: &wall });
        }
        let manoeuvre = positioner.manoeuvre().expect("planned").clone();
        (0..=200)
            .map(|i| manoeuvre.at(manoeuvre.duration() * f64::from(i) / 200.0).0)
            .map(|pose| wall.clearance(&footprint, &pose, 1.0).unwrap().0)
            .fold(f64::INFINITY, f64::min)
    };
    let (well, badly) = (nearest(0.001), nearest(0.01));
    assert!(well >= 0.01 - 1e-6 && badly >= 0.035 - 1e-6, "{well} {badly}");
}
