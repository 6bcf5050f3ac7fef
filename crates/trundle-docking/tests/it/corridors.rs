//! Corridor problems: their generator, their text form, and the text form of answers.

use crate::common::at;
use proptest::prelude::*;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::collections::BTreeSet;
use trundle_core::{Footprint, Pose2, wrap_angle};
use trundle_docking::corridor::{
    PathPiece, Problem, Scenario, generate, parse, parse_answers, time_of, write, write_answers,
};
use trundle_docking::{MotionLimits, Obstacle};

fn problems(seed: u64, count: usize) -> Vec<Problem> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    (0..count).map(|i| generate(format!("p{i}"), &mut rng)).collect()
}

#[test]
fn one_seed_gives_one_list_and_another_seed_another() {
    assert_eq!(problems(7, 50), problems(7, 50));
    let shared = problems(7, 50).iter().zip(&problems(8, 50)).filter(|(a, b)| a.start == b.start).count();
    assert_eq!(shared, 0);
}

#[test]
fn a_longer_list_begins_with_the_shorter_one() {
    assert_eq!(problems(5, 30)[..10], problems(5, 10)[..]);
}

#[test]
fn start_and_goal_of_every_problem_are_clear_by_a_centimetre_and_near_each_other() {
    for problem in problems(9, 300) {
        let scene = problem.scene().unwrap();
        for pose in [problem.start, problem.goal] {
            assert_eq!(scene.clearance(&problem.footprint, &pose, 0.01), None, "{}", problem.name);
        }
        assert!(problem.start.distance(&problem.goal) <= 0.3 * std::f64::consts::SQRT_2 + 1e-9);
        assert!(problem.goal.theta.abs() <= 0.15);
    }
}

#[test]
fn the_corridors_are_of_many_kinds() {
    let problems = problems(10, 300);
    let discs = problems.iter().filter(|p| matches!(p.footprint, Footprint::Disc { .. })).count();
    let turned = problems.iter().filter(|p| wrap_angle(p.start.theta - p.goal.theta).abs() > 2.0).count();
    let counts: BTreeSet<usize> = problems.iter().map(|p| p.obstacles.len()).collect();
    assert!((10..60).contains(&discs) && (3..40).contains(&turned), "{discs} discs, {turned} turned");
    assert!(counts.len() >= 6, "{counts:?}");
}

#[test]
fn the_walls_of_every_corridor_are_between_55_and_110_cm_apart() {
    for problem in problems(11, 200) {
        let Obstacle::Segment(lower, _) = problem.obstacles[0] else { panic!("{}", problem.name) };
        let Obstacle::Segment(upper, _) = problem.obstacles[1] else { panic!("{}", problem.name) };
        let width = upper.y - lower.y;
        assert!((0.55..=1.10).contains(&width), "{}: {width} m", problem.name);
    }
}

#[test]
fn the_scenarios_are_free_at_both_ends_and_named_by_their_letter() {
    for (scenario, letter) in Scenario::ALL.into_iter().zip('a'..) {
        let problem = scenario.problem();
        assert_eq!((scenario.letter(), problem.name.as_str()), (letter, format!("hong24-{letter}").as_str()));
        let scene = problem.scene().unwrap();
        for pose in [problem.start, problem.goal] {
            assert_eq!(scene.clearance(&problem.footprint, &pose, 0.01), None, "{letter}");
        }
    }
}

#[test]
fn text_keeps_every_kind_of_footprint_and_obstacle_exactly() {
    let problem = Problem {
        name: "all kinds".into(),
        footprint: Footprint::disc(0.1 + 0.2).unwrap(),
        start: Pose2::new(1.0 / 3.0, -2.0 / 7.0, 0.5),
        goal: Pose2::new(1e-17, 1e9, -3.0),
        obstacles: vec![
            Obstacle::Point(at(0.1, 0.7)),
            Obstacle::Segment(at(-0.0, 1e-300), at(2.0, 3.0)),
            Obstacle::Polygon(vec![at(0.0, 0.0), at(0.3, 0.0), at(0.1, 0.2)]),
        ],
    };
    let read = parse(&write(std::slice::from_ref(&problem))).unwrap();
    assert_eq!((read.len(), &read[0].name), (1, &problem.name));
    assert_eq!((&read[0].footprint, &read[0].obstacles), (&problem.footprint, &problem.obstacles));
    assert_eq!(read[0].start.position(), problem.start.position());
    assert!(wrap_angle(read[0].goal.theta - problem.goal.theta).abs() < 1e-15);
}

const WHOLE: &str = "trundle-corridors 1\nproblem a\ndisc 0.2\nstart 0 0 0\ngoal 1 0 90\n";

#[test]
fn comments_and_empty_lines_say_nothing() {
    let commented = WHOLE.replace('\n', "   # a comment with problem 5\n\n  \n# wall 0 0 1 1\n");
    assert_eq!(parse(&commented).unwrap(), parse(WHOLE).unwrap());
    assert_eq!(parse("trundle-corridors 1\n").unwrap(), []);
}

#[test]
fn angles_are_degrees_and_several_points_may_stand_in_one_line() {
    let read = parse(&format!("{WHOLE}point 1 2 3 4\n")).unwrap();
    assert!((read[0].goal.theta - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    assert_eq!(read[0].obstacles, [Obstacle::Point(at(1.0, 2.0)), Obstacle::Point(at(3.0, 4.0))]);
}

#[test]
fn every_broken_line_is_refused_with_its_number_and_text() {
    let refused = |line: &str| parse(&format!("{WHOLE}{line}\n")).unwrap_err().to_string();
    for (line, expected) in [
        ("wall 0 0 1", "line 6 is `0 0 1`, expected pairs X Y"),
        ("wall 0 0", "line 6 is `0 0`, expected wall X Y X Y"),
        ("wall 0 0 1 1 2 2", "line 6 is `0 0 1 1 2 2`, expected wall X Y X Y"),
        ("point", "line 6 is ``, expected pairs X Y"),
        ("point 1 inf", "line 6 is `1 inf`, expected finite numbers, as many as the word takes"),
        ("start 1 2", "line 6 is `1 2`, expected finite numbers, as many as the word takes"),
        ("goal a b c", "line 6 is `a b c`, expected finite numbers, as many as the word takes"),
        ("disc 0.1 0.2", "line 6 is `0.1 0.2`, expected finite numbers, as many as the word takes"),
        ("disc -0.1", "line 6: footprint radius is -0.1 m, expected a finite number above 0"),
        ("footprint 0 0 1 0", "line 6: footprint corners is 2, expected 3 or more"),
    ] {
        assert_eq!(refused(line), expected, "{line}");
    }
    let long = refused(&format!("point {}", "1 ".repeat(41)));
    assert!(long.contains("...`, expected pairs X Y") && long.len() < 120, "{long}");
}

#[test]
fn a_file_of_another_kind_is_refused_in_its_first_line() {
    for text in ["", "# nothing\n", "trundle-corridors 2\n", "trundle-answers 1\n"] {
        assert!(parse(text).unwrap_err().to_string().ends_with("expected trundle-corridors 1"), "{text}");
        let answers = text.replace("trundle-answers 1", "trundle-corridors 1");
        assert!(
            parse_answers(&answers).unwrap_err().to_string().ends_with("expected trundle-answers 1"),
            "{text}"
        );
    }
}

fn any_piece() -> impl Strategy<Value = PathPiece> {
    (-1.0..1.0_f64, -2.0..2.0_f64, 0..3).prop_map(|(distance, turn, kind)| match kind {
        0 => PathPiece { distance, turn: 0.0 },
        1 => PathPiece { distance: 0.0, turn },
        _ => PathPiece { distance, turn },
    })
}

proptest! {
    #[test]
    fn half_a_piece_twice_is_the_whole_piece(piece in any_piece(), x in -3.0..3.0_f64, t in -3.0..3.0_f64) {
        let start = Pose2::new(x, -x, t);
        let half = PathPiece { distance: piece.distance / 2.0, turn: piece.turn / 2.0 };
        let (whole, twice) = (piece.after(&start, 1.0), half.after(&half.after(&start, 1.0), 1.0));
        prop_assert!(whole.distance(&twice) < 1e-9 && wrap_angle(whole.theta - twice.theta).abs() < 1e-9);
        prop_assert!(half.after(&start, 1.0).distance(&piece.after(&start, 0.5)) < 1e-12);
    }

    #[test]
    fn a_path_takes_at_least_the_time_of_its_pieces_and_at_most_a_pause_more_between_two(
        path in prop::collection::vec(any_piece(), 1..8),
    ) {
        let limits = MotionLimits::default();
        let moving: f64 = path.iter().map(|piece| piece.time(&limits)).sum();
        let time = time_of(&path, &limits);
        prop_assert!(time >= moving - 1e-12);
        prop_assert!(time <= moving + (path.len() - 1) as f64 * limits.switch_time + 1e-12);
    }

    #[test]
    fn an_arc_takes_as_long_as_the_longer_of_its_distance_and_its_turn(distance in -1.0..1.0_f64, turn in -2.0..2.0_f64) {
        let limits = MotionLimits::default();
        let (straight, turned) = (PathPiece { distance, turn: 0.0 }.time(&limits), PathPiece { distance: 0.0, turn }.time(&limits));
        prop_assert_eq!(PathPiece { distance, turn }.time(&limits), straight.max(turned));
    }

    #[test]
    fn written_answers_have_one_line_a_piece(path in prop::collection::vec(any_piece(), 0..8)) {
        let answer = trundle_docking::corridor::ProblemAnswer { problem: "a b".into(), path: Some(path.clone()) };
        let text = write_answers(&[answer]);
        prop_assert_eq!(text.lines().filter(|line| !line.is_empty()).count(), 2 + path.len());
        let read = parse_answers(&text).unwrap();
        prop_assert_eq!(&read[0].problem, "a b");
        prop_assert_eq!(read[0].path.as_ref().map(Vec::len), Some(path.len()));
    }
}

#[test]
fn a_path_that_rolls_on_in_one_direction_has_no_pause_and_one_that_turns_back_has() {
    let limits = MotionLimits::default();
    let piece = |distance: f64| PathPiece { distance, turn: 0.3 };
    let (on, back) =
        (time_of(&[piece(0.5), piece(0.5)], &limits), time_of(&[piece(0.5), piece(-0.5)], &limits));
    assert!((back - on - limits.switch_time).abs() < 1e-12);
}
