//! Laws of contact queries: contact, free turns, free straight moves and blocked headings.

use crate::common::{any_pose, at, mapped, mirrored, mirrored_footprint, robot, scene, wall};
use crate::contact::{distance, footprint, obstacle, sides};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::{PI, TAU};
use trundle_core::{Footprint, Pose2};
use trundle_docking::{ContactSpace, FreeDrive, FreeTurn, Motion, Obstacle, ObstacleScene};

/// Random cases of each law.
const CASES: usize = 1_500;
/// Largest requested distance of a straight move, m.
const REACH: f64 = 0.9;

/// A footprint with a clearance of 2 mm plus a margin among some obstacles.
struct Case {
    footprint: Footprint,
    obstacles: Vec<Obstacle>,
    pose: Pose2,
    margin: f64,
}

impl Case {
    fn scene(&self) -> ObstacleScene {
        scene(&self.obstacles)
    }

    fn free(&self) -> (FreeTurn, FreeDrive) {
        free(&self.footprint, self.margin, &self.scene(), &self.pose)
    }
}

fn free(footprint: &Footprint, margin: f64, scene: &ObstacleScene, pose: &Pose2) -> (FreeTurn, FreeDrive) {
    let mut space = ContactSpace::new(footprint, margin, scene);
    (space.turn(pose), space.drive(pose, REACH))
}

fn cases(seed: u64) -> impl Iterator<Item = Case> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    std::iter::from_fn(move || {
        loop {
            let (footprint, pose) = (footprint(&mut rng), any_pose(&mut rng, 0.6));
            let obstacles: Vec<_> = (0..rng.random_range(1..5)).map(|_| obstacle(&mut rng)).collect();
            let margin = rng.random_range(0.0..0.05);
            if distance(&footprint, &pose, &sides(&obstacles)) > margin + 2e-3 {
                return Some(Case { footprint, obstacles, pose, margin });
            }
        }
    })
    .take(CASES)
}

/// Whether two free amounts are equal; amounts without a contact are infinite.
fn same(a: f64, b: f64) -> bool {
    a == b || (a - b).abs() < 1e-6
}

#[test]
fn a_contact_is_a_distance_of_no_more_than_the_margin() {
    let mut rng = ChaCha8Rng::seed_from_u64(61);
    let mut touching = 0;
    for _ in 0..CASES {
        let (footprint, pose) = (footprint(&mut rng), any_pose(&mut rng, 0.8));
        let obstacles: Vec<_> = (0..3).map(|_| obstacle(&mut rng)).collect();
        let (margin, scene) = (rng.random_range(0.0..0.1_f64), scene(&obstacles));
        let apart = distance(&footprint, &pose, &sides(&obstacles));
        let contact = ContactSpace::new(&footprint, margin, &scene).contact(&pose);
        touching += usize::from(contact.is_some());
        if apart > margin + 1e-9 {
            // Only the inside of a solid touches without a side near by.
            let inside = scene.clearance(&footprint, &pose, 1.0).is_some_and(|(distance, _)| distance == 0.0);
            assert!(contact.is_none() || inside, "{apart} m apart, margin {margin}");
        } else {
            assert!(contact.is_some(), "{apart} m apart, margin {margin}");
        }
    }
    assert!(touching > CASES / 5 && touching < 4 * CASES / 5, "{touching} of {CASES}");
}

#[test]
fn one_more_obstacle_never_frees_a_motion() {
    let mut rng = ChaCha8Rng::seed_from_u64(62);
    for mut case in cases(63) {
        let (turn, drive) = case.free();
        case.obstacles.push(obstacle(&mut rng));
        let (less_turn, less_drive) = case.free();
        assert!(less_turn.left <= turn.left && less_turn.right <= turn.right);
        assert!(less_drive.ahead <= drive.ahead && less_drive.behind <= drive.behind);
    }
}

#[test]
fn a_larger_margin_never_frees_a_motion() {
    for case in cases(64) {
        let ((turn, drive), scene) = (case.free(), case.scene());
        let (less_turn, less_drive) = free(&case.footprint, case.margin + 1e-3, &scene, &case.pose);
        assert!(less_turn.left <= turn.left + 1e-9 && less_turn.right <= turn.right + 1e-9);
        assert!(less_drive.ahead <= drive.ahead + 1e-9 && less_drive.behind <= drive.behind + 1e-9);
    }
}

#[test]
fn the_mirror_exchanges_left_and_right() {
    for case in cases(65) {
        let (turn, drive) = case.free();
        let image = Case {
            footprint: mirrored_footprint(&case.footprint),
            obstacles: mapped(&case.obstacles, |p| at(p.x, -p.y)),
            pose: mirrored(case.pose),
            margin: case.margin,
        };
        let (image_turn, image_drive) = image.free();
        assert!(
            same(turn.left, image_turn.right) && same(turn.right, image_turn.left),
            "{turn:?} {image_turn:?}"
        );
        assert!(same(drive.ahead, image_drive.ahead) && same(drive.behind, image_drive.behind));
    }
}

#[test]
fn free_motions_are_the_same_in_every_frame() {
    let mut rng = ChaCha8Rng::seed_from_u64(66);
    for case in cases(67) {
        let frame = any_pose(&mut rng, 4.0);
        let moved = scene(&mapped(&case.obstacles, |p| frame.transform(p)));
        let (turn, drive) = case.free();
        let (there_turn, there_drive) = free(&case.footprint, case.margin, &moved, &(frame * case.pose));
        assert!(same(turn.left, there_turn.left) && same(turn.right, there_turn.right));
        assert!(same(drive.ahead, there_drive.ahead) && same(drive.behind, there_drive.behind));
    }
}

#[test]
fn a_footprint_turned_about_drives_ahead_where_it_drove_back() {
    for case in cases(68) {
        let about = Pose2::new(0.0, 0.0, PI);
        let turned = match &case.footprint {
            Footprint::Polygon { corners } => {
                Footprint::polygon(corners.iter().map(|corner| about.transform(*corner)).collect()).unwrap()
            }
            disc => disc.clone(),
        };
        let (turn, drive) = case.free();
        let (about_turn, about_drive) = free(&turned, case.margin, &case.scene(), &(case.pose * about));
        assert!(same(drive.ahead, about_drive.behind) && same(drive.behind, about_drive.ahead));
        assert!(same(turn.left, about_turn.left) && same(turn.right, about_turn.right));
    }
}

#[test]
fn the_free_rest_after_a_part_of_a_motion_is_the_rest_before() {
    for case in cases(69) {
        let ((turn, drive), scene) = (case.free(), case.scene());
        if turn.left.is_finite() && turn.left > 1e-3 {
            let part = Motion::Turn(turn.left / 2.0);
            let (rest, _) = free(&case.footprint, case.margin, &scene, &part.after(case.pose, part.amount()));
            assert!((rest.left - turn.left / 2.0).abs() < 1e-6, "{} after half of {}", rest.left, turn.left);
        }
        if drive.ahead_by.is_some() && drive.ahead > 1e-3 {
            let part = Motion::Drive(drive.ahead / 2.0);
            let (_, rest) = free(&case.footprint, case.margin, &scene, &part.after(case.pose, part.amount()));
            assert!((rest.ahead - drive.ahead / 2.0).abs() < 1e-6);
        }
    }
}

#[test]
fn a_disc_turns_freely_wherever_it_stands_free() {
    for case in cases(70) {
        let disc = Footprint::disc(0.01).unwrap();
        let (turn, _) = free(&disc, 0.0, &case.scene(), &case.pose);
        if distance(&disc, &case.pose, &sides(&case.obstacles)) > 1e-3 {
            assert_eq!((turn.left, turn.right), (f64::INFINITY, f64::INFINITY));
            assert_eq!((turn.left_by, turn.right_by), (None, None));
        }
    }
}

#[test]
fn headings_are_blocked_exactly_where_brute_force_finds_a_contact() {
    let mut compared = 0;
    for case in cases(71).take(CASES / 5) {
        let (scene, mut blocked) = (case.scene(), Vec::new());
        let pieces = sides(&case.obstacles);
        ContactSpace::new(&case.footprint, case.margin, &scene)
            .blocked_headings(case.pose.position(), &mut blocked);
        for i in 0..360 {
            let heading = f64::from(i) * TAU / 360.0;
            let pose = Pose2::new(case.pose.x, case.pose.y, heading);
            let apart = distance(&case.footprint, &pose, &pieces) - case.margin;
            let is_blocked = blocked.iter().any(|arc| (heading - arc.start).rem_euclid(TAU) <= arc.length);
            // Within a tenth of a millimetre of contact either answer is right.
            if apart.abs() > 1e-4 {
                compared += 1;
                assert_eq!(is_blocked, apart < 0.0, "{apart} m at {heading}: {blocked:?}");
            }
        }
    }
    assert!(compared > 50_000, "{compared} headings compared");
}

#[test]
fn blocked_headings_are_sorted_and_do_not_meet() {
    for case in cases(72) {
        let (scene, mut blocked) = (case.scene(), Vec::new());
        ContactSpace::new(&case.footprint, case.margin, &scene)
            .blocked_headings(case.pose.position(), &mut blocked);
        for pair in blocked.windows(2) {
            assert!(pair[0].start + pair[0].length < pair[1].start, "{blocked:?}");
        }
        if let (Some(first), Some(last)) = (blocked.first(), blocked.last()) {
            assert!(last.start + last.length - TAU < first.start + 1e-9 || blocked.len() == 1, "{blocked:?}");
        }
    }
}

#[test]
fn a_motion_has_a_blocker_exactly_when_it_is_not_free() {
    let mut rng = ChaCha8Rng::seed_from_u64(73);
    for case in cases(74) {
        let ((turn, drive), scene) = (case.free(), case.scene());
        let mut space = ContactSpace::new(&case.footprint, case.margin, &scene);
        let (angle, distance) = (rng.random_range(-3.0..3.0), rng.random_range(-0.8..0.8));
        let turned = space.blocker_of(&case.pose, Motion::Turn(angle));
        assert_eq!(turned.is_none(), turn.allows(angle), "{angle} rad: {turn:?}");
        let driven = space.blocker_of(&case.pose, Motion::Drive(distance));
        assert_eq!(driven.is_none(), drive.allows(distance), "{distance} m: {drive:?}");
    }
}

#[test]
fn a_change_of_heading_takes_the_shorter_turn_where_it_is_free_and_else_the_longer() {
    let free = |left: f64, right: f64| FreeTurn { left, right, left_by: None, right_by: None };
    let close = |turn: Option<f64>, expected: f64| turn.is_some_and(|turn| (turn - expected).abs() < 1e-12);
    assert!(close(free(2.0, 2.0).turn_by(1.0), 1.0) && close(free(2.0, 2.0).turn_by(-1.0), -1.0));
    assert!(close(free(0.5, 6.0).turn_by(1.0), 1.0 - TAU) && close(free(6.0, 0.5).turn_by(-1.0), TAU - 1.0));
    assert_eq!((free(0.5, 0.5).turn_by(1.0), free(0.5, 0.5).turn_by(-1.0)), (None, None));
    assert!(close(free(0.0, 0.0).turn_by(0.0), 0.0));
}

#[test]
fn a_straight_move_is_cut_at_the_reach_without_a_blocker_and_before_a_wall_with_it() {
    let wall = scene(&[wall((1.0, -1.0), (1.0, 1.0))]);
    let space = ContactSpace::new(&robot(), 0.05, &wall);
    let free = space.drive(&Pose2::IDENTITY, 5.0);
    assert!((free.ahead - 0.65).abs() < 1e-4 && free.ahead < 0.65, "{}", free.ahead);
    assert!(free.ahead_by.is_some() && free.behind_by.is_none());
    assert!((free.behind - 5.0).abs() < 1e-4);
    assert!((space.drive(&Pose2::IDENTITY, 0.3).ahead - 0.3).abs() < 1e-4);
}

#[test]
fn every_query_is_counted() {
    let wall = scene(&[wall((1.0, -1.0), (1.0, 1.0))]);
    let mut space = ContactSpace::new(&robot(), 0.0, &wall);
    let mut last = space.work();
    let mut grows = |space: &ContactSpace<'_>| {
        let before = std::mem::replace(&mut last, space.work());
        assert!(space.work() > before);
    };
    space.turn(&Pose2::IDENTITY);
    grows(&space);
    space.drive(&Pose2::IDENTITY, 2.0);
    grows(&space);
    space.contact(&Pose2::IDENTITY);
    grows(&space);
    space.blocked_headings(at(0.0, 0.0), &mut Vec::new());
    grows(&space);
}
