//! Laws of the positioner: its commands, its rest, and its convergence with slip and a noisy gyro.

use crate::common::{at, robot, scene, solid, wall};
use crate::world::{DT, covariance};
use nalgebra::Matrix3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trundle_core::{Footprint, Pose2, Stamp, Twist2, wrap_angle};
use trundle_docking::{
    DockingConfig, DockingRefusal, Method, Obstacle, ObstacleScene, Positioner, PositionerConfig,
    PositionerInput, PositionerReason, PositionerReport,
};

fn positioner(method: Method, footprint: Footprint, goal: Pose2) -> Positioner {
    let mut docking = DockingConfig::default();
    docking.method = method;
    Positioner::new(docking, PositionerConfig::default(), footprint, goal).unwrap()
}

/// A base with wheels that slip and a pose that drifts with the gyro between two absolute fixes.
struct SlippingBase {
    pose: Pose2,
    /// Part of the commanded speeds that reaches the floor: straight, turning.
    grip: (f64, f64),
    /// Error of the measured heading, rad, a random walk that is pulled back to zero.
    heading_error: f64,
    rng: ChaCha8Rng,
}

impl SlippingBase {
    fn new(pose: Pose2, grip: (f64, f64), seed: u64) -> Self {
        Self { pose, grip, heading_error: 0.0, rng: ChaCha8Rng::seed_from_u64(seed) }
    }

    fn advance(&mut self, command: Twist2) {
        let uneven = 1.0 + self.rng.random_range(-0.1..0.1);
        let twist = Twist2::new(command.v * self.grip.0 * uneven, command.omega * self.grip.1 * uneven);
        self.pose = self.pose.advance(twist, DT);
        self.heading_error = 0.9 * self.heading_error + self.rng.random_range(-0.002..0.002);
    }

    fn measured(&mut self) -> Pose2 {
        let mut noise = || self.rng.random_range(-0.002..0.002);
        Pose2::new(self.pose.x + noise(), self.pose.y + noise(), self.pose.theta + self.heading_error)
    }
}

/// One run of at most `secs`; returns every report.
fn run(
    positioner: &mut Positioner,
    base: &mut SlippingBase,
    scene: &ObstacleScene,
    secs: f64,
) -> Vec<PositionerReport> {
    let mut reports = Vec::new();
    for i in 0..(secs / DT) as usize {
        let stamp = Stamp::default().after(i as f64 * DT);
        let input = PositionerInput { stamp, pose: base.measured(), covariance: covariance(), scene };
        reports.push(positioner.step(&input));
        base.advance(reports[i].twist);
        if positioner.is_settled() {
            break;
        }
    }
    reports
}

fn corridor() -> ObstacleScene {
    scene(&[wall((-3.0, 0.45), (3.0, 0.45)), wall((-3.0, -0.45), (3.0, -0.45))])
}

#[test]
fn slip_and_gyro_noise_do_not_keep_it_from_its_goal() {
    let (scene, goal) = (corridor(), Pose2::new(0.2, 0.1, 0.0));
    for (seed, grip) in [(1, (0.8, 0.8)), (2, (1.1, 0.9)), (3, (0.9, 1.1)), (4, (0.7, 1.0)), (5, (1.0, 0.7))]
    {
        let mut positioner = positioner(Method::Optimal, robot(), goal);
        let mut base = SlippingBase::new(Pose2::new(0.0, -0.1, 0.1), grip, seed);
        run(&mut positioner, &mut base, &scene, 120.0);
        let error = goal.inverse() * base.pose;
        assert!(positioner.is_settled(), "grip {grip:?}: {error:?}");
        assert!(error.position().norm() < 0.015 && error.theta.abs() < 0.03, "grip {grip:?}: {error:?}");
    }
}

#[test]
fn every_command_keeps_the_speeds_and_is_a_turn_or_a_straight_move() {
    let limits = DockingConfig::default().limits;
    for method in [Method::Optimal, Method::Hong24] {
        let mut positioner = positioner(method, robot(), Pose2::new(0.3, 0.1, 0.2));
        let mut base = SlippingBase::new(Pose2::new(0.0, -0.05, -0.1), (0.9, 0.9), 6);
        for report in run(&mut positioner, &mut base, &corridor(), 60.0) {
            let Twist2 { v, omega } = report.twist;
            assert!(v.abs() <= limits.speed + 1e-9 && omega.abs() <= limits.turn_rate + 1e-9, "{report:?}");
            // A straight move corrects its heading by at most 0.1 rad/s.
            assert!(v == 0.0 || omega.abs() <= 0.1 + 1e-9, "{report:?}");
            let moving = matches!(report.reason, PositionerReason::Moving(_));
            assert!(moving || report.twist == Twist2::ZERO, "{report:?}");
        }
    }
}

#[test]
fn the_same_inputs_give_the_same_reports() {
    let reports = || {
        let mut positioner = positioner(Method::Optimal, robot(), Pose2::new(0.2, 0.1, 0.0));
        let mut base = SlippingBase::new(Pose2::new(0.0, -0.1, 0.1), (0.9, 0.9), 7);
        run(&mut positioner, &mut base, &corridor(), 60.0)
    };
    assert_eq!(reports(), reports());
}

/// A positioner with exact poses at a fixed place; the reason of its last step.
struct Standing<'s> {
    positioner: Positioner,
    time: f64,
    scene: &'s ObstacleScene,
}

impl<'s> Standing<'s> {
    fn new(footprint: Footprint, goal: Pose2, scene: &'s ObstacleScene) -> Self {
        Self { positioner: positioner(Method::Optimal, footprint, goal), time: 0.0, scene }
    }

    fn step(&mut self, pose: Pose2) -> PositionerReport {
        self.time += DT;
        let (stamp, covariance) = (Stamp::default().after(self.time), Matrix3::zeros());
        self.positioner.step(&PositionerInput { stamp, pose, covariance, scene: self.scene })
    }

    /// The last of as many steps as fill `secs`.
    fn stand(&mut self, pose: Pose2, secs: f64) -> PositionerReport {
        (1..(secs / DT) as usize).for_each(|_| drop(self.step(pose)));
        self.step(pose)
    }
}

#[test]
fn it_measures_at_rest_before_it_decides() {
    let free = scene(&[]);
    let mut standing = Standing::new(robot(), Pose2::new(0.5, 0.0, 0.0), &free);
    let measuring = (PositionerConfig::default().measure_time / DT) as usize;
    for _ in 0..measuring {
        let report = standing.step(Pose2::IDENTITY);
        assert_eq!((report.twist, report.reason), (Twist2::ZERO, PositionerReason::Measuring));
    }
    assert!(matches!(standing.stand(Pose2::IDENTITY, 0.2).reason, PositionerReason::Moving(_)));
}

#[test]
fn at_its_goal_it_settles_and_stays_within_twice_the_tolerance_and_moves_again_beyond() {
    let (free, goal) = (scene(&[]), Pose2::new(1.0, -2.0, 2.0));
    let mut standing = Standing::new(robot(), goal, &free);
    assert_eq!(standing.stand(goal, 1.0).reason, PositionerReason::Settled);
    assert!(standing.positioner.is_settled());
    let beside = goal * Pose2::new(0.019, 0.0, 0.0);
    assert_eq!(standing.stand(beside, 2.0).reason, PositionerReason::Settled);
    let away = goal * Pose2::new(0.021, 0.0, 0.0);
    assert_eq!(standing.step(away).reason, PositionerReason::Measuring);
    assert!(matches!(standing.stand(away, 0.6).reason, PositionerReason::Moving(_)));
}

#[test]
fn the_error_is_the_pose_in_the_frame_of_the_goal() {
    let (free, goal) = (scene(&[]), Pose2::new(1.0, -2.0, 2.0));
    let mut standing = Standing::new(robot(), goal, &free);
    let error = standing.step(goal * Pose2::new(0.3, -0.1, 0.2)).error;
    assert!(
        error.distance(&Pose2::new(0.3, -0.1, 0.2)) < 1e-12 && wrap_angle(error.theta - 0.2).abs() < 1e-12
    );
    assert_eq!(standing.positioner.goal(), goal);
}

#[test]
fn a_pose_that_is_not_finite_stops_it_at_once_and_a_finite_one_lets_it_go_on() {
    let free = scene(&[]);
    let mut standing = Standing::new(robot(), Pose2::new(0.5, 0.0, 0.0), &free);
    standing.stand(Pose2::IDENTITY, 1.0);
    for bad in [f64::NAN, f64::INFINITY] {
        let report = standing.step(Pose2 { x: bad, y: 0.0, theta: 0.0 });
        assert_eq!((report.twist, report.reason), (Twist2::ZERO, PositionerReason::BadPose));
    }
    assert!(matches!(standing.step(Pose2::IDENTITY).reason, PositionerReason::Moving(_)));
}

#[test]
fn after_an_interruption_it_measures_and_plans_again() {
    let free = scene(&[]);
    let mut standing = Standing::new(robot(), Pose2::new(0.5, 0.0, 0.0), &free);
    assert!(matches!(standing.stand(Pose2::IDENTITY, 1.0).reason, PositionerReason::Moving(_)));
    standing.positioner.interrupted(Stamp::default().after(standing.time));
    let report = standing.step(Pose2::IDENTITY);
    assert_eq!((report.twist, report.reason), (Twist2::ZERO, PositionerReason::Measuring));
    assert!(matches!(standing.stand(Pose2::IDENTITY, 1.0).reason, PositionerReason::Moving(_)));
}

#[test]
fn an_occupied_goal_is_refused_by_name_and_it_goes_on_once_the_goal_is_free() {
    let (free, blocked) = (scene(&[]), scene(&[solid((0.7, -0.1), (0.9, 0.1))]));
    let mut standing = Standing::new(robot(), Pose2::new(0.8, 0.0, 0.0), &blocked);
    let report = standing.stand(Pose2::IDENTITY, 1.0);
    let PositionerReason::Refused(DockingRefusal::GoalBlocked(by)) = report.reason else {
        panic!("{report:?}")
    };
    assert!(by.to_string().starts_with("obstacle 0 at"), "{by}");
    assert!(report.twist == Twist2::ZERO && standing.positioner.is_waiting());
    standing.scene = &free;
    assert!(matches!(standing.stand(Pose2::IDENTITY, 2.0).reason, PositionerReason::Moving(_)));
    assert!(!standing.positioner.is_waiting());
}

#[test]
fn behind_a_closed_wall_it_waits_and_names_the_wall() {
    let walls = [
        ((-0.5, -0.5), (0.5, -0.5)),
        ((0.5, -0.5), (0.5, 0.5)),
        ((0.5, 0.5), (-0.5, 0.5)),
        ((-0.5, 0.5), (-0.5, -0.5)),
    ];
    let closed = scene(&walls.map(|(a, b)| wall(a, b)));
    let mut standing = Standing::new(robot(), Pose2::new(1.2, 0.0, 0.0), &closed);
    let mut reason = PositionerReason::Measuring;
    for _ in 0..200 {
        let report = standing.step(Pose2::IDENTITY);
        assert_eq!(report.twist, Twist2::ZERO);
        if let PositionerReason::NoWay(_) = report.reason {
            reason = report.reason;
        }
    }
    assert!(matches!(reason, PositionerReason::NoWay(Some(_))), "{reason:?}");
}

#[test]
fn a_goal_too_far_away_is_refused_with_both_distances() {
    let free = scene(&[]);
    let mut standing = Standing::new(robot(), Pose2::new(3.6, 4.8, 0.0), &free);
    let report = standing.stand(Pose2::IDENTITY, 1.0);
    assert_eq!(report.reason, PositionerReason::Refused(DockingRefusal::TooFar { distance: 6.0, max: 5.0 }));
}

#[test]
fn something_in_front_of_a_straight_move_stops_it_in_the_same_step() {
    let (free, blocked) = (scene(&[]), scene(&[Obstacle::Point(at(0.31, 0.0))]));
    let mut standing = Standing::new(robot(), Pose2::new(0.8, 0.0, 0.0), &free);
    assert!(standing.stand(Pose2::IDENTITY, 1.0).twist.v > 0.0);
    standing.scene = &blocked;
    let report = standing.step(Pose2::IDENTITY);
    assert_eq!(report.twist, Twist2::ZERO);
    assert!(matches!(report.reason, PositionerReason::Obstacle(by) if (by.at - at(0.31, 0.0)).norm() < 1e-9));
}

#[test]
fn stamps_that_stand_still_or_run_back_do_not_make_it_faster() {
    let free = scene(&[]);
    let mut standing = Standing::new(robot(), Pose2::new(0.8, 0.0, 0.0), &free);
    let before = standing.stand(Pose2::IDENTITY, 0.6).twist.v;
    standing.time -= 10.0;
    let after = standing.step(Pose2::IDENTITY).twist.v;
    assert!(
        after <= before.max(PositionerConfig::default().creep_speed) + 1e-9,
        "{before} m/s, then {after} m/s"
    );
}
