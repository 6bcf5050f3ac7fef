//! Laws of the guard.

use super::*;

fn at(seconds: f64) -> Stamp {
    Stamp::default().after(seconds)
}

/// Without a drive.
fn left(rest: f64) -> Remaining {
    Remaining { rest, results: 0, is_driving: false }
}

/// On a drive.
fn driving(rest: f64) -> Remaining {
    Remaining { is_driving: true, ..left(rest) }
}

#[test]
fn only_a_fall_of_the_potential_is_progress() {
    let mut guard = ProgressGuard::default();
    assert_eq!(guard.time_without_progress(at(0.0), &left(f64::INFINITY)), 0.0);
    assert_eq!(guard.time_without_progress(at(5.0), &left(f64::INFINITY)), 5.0);
    assert_eq!(guard.time_without_progress(at(6.0), &left(4.0)), 0.0);
    // To and fro along the path.
    for (i, rest) in [3.9, 4.5, 3.88, 5.0, 3.86, 9.0].into_iter().enumerate() {
        let seconds = 1.0 + i as f64;
        assert_eq!(guard.time_without_progress(at(6.0 + seconds), &left(rest)), seconds, "{rest} m");
    }
    assert_eq!(guard.time_without_progress(at(20.0), &left(3.84)), 0.0);
}

#[test]
fn a_robot_on_its_path_makes_progress_at_any_speed_above_fall_over_patience() {
    for speed in [0.01, 0.05, 0.5] {
        let mut guard = ProgressGuard::default();
        let waits = (0..2000).map(|i| {
            let time = 0.1 * f64::from(i);
            guard.time_without_progress(at(time), &driving(200.0 - speed * time))
        });
        let longest = waits.fold(0.0, f64::max);
        assert!(longest <= MIN_FALL_M / speed + 0.2, "{speed} m/s: {longest} s");
    }
}

#[test]
fn an_observation_with_a_result_is_progress_until_an_obstacle_blocks_the_path() {
    let mut guard = ProgressGuard::default();
    let seen = |rest, results| Remaining { results, ..left(rest) };
    guard.time_without_progress(at(0.0), &seen(3.0, 0));
    assert_eq!(guard.time_without_progress(at(9.0), &seen(3.2, 1)), 0.0);
    guard.allow_detour(at(20.0), 1);
    assert_eq!(guard.time_without_progress(at(25.0), &seen(3.2, 9)), 5.0);
    assert_eq!(guard.time_without_progress(at(30.0), &seen(2.8, 9)), 0.0, "nearer than ever");
    assert_eq!(guard.time_without_progress(at(40.0), &seen(2.8, 10)), 0.0, "observations count again");
}

#[test]
fn an_obstacle_allows_one_detour_until_the_robot_is_nearer_than_before() {
    let mut guard = ProgressGuard::default();
    let lost = left(f64::INFINITY);
    guard.time_without_progress(at(0.0), &left(1.0));
    assert!(guard.is_longer(12.0, 0) && !guard.is_longer(0.9, 0));
    guard.allow_detour(at(10.0), 0);
    assert_eq!(guard.time_without_progress(at(11.0), &lost), 1.0);
    guard.allow_detour(at(12.0), 0);
    assert_eq!(guard.time_without_progress(at(13.0), &lost), 3.0, "a second obstacle");
    guard.time_without_progress(at(14.0), &left(0.8));
    guard.allow_detour(at(20.0), 0);
    assert_eq!(guard.time_without_progress(at(21.0), &lost), 1.0, "nearer than ever");
    guard.restart();
    assert!(!guard.is_longer(100.0, 0));
}

#[test]
fn the_drive_along_a_detour_does_not_count_and_the_stops_between_do() {
    let mut guard = ProgressGuard::default();
    guard.time_without_progress(at(0.0), &left(1.0));
    guard.time_without_progress(at(30.0), &left(f64::INFINITY));
    guard.start_drive(at(30.0));
    // 40 m at 0.5 m/s.
    for i in 0..800 {
        let time = 30.0 + 0.1 * f64::from(i);
        let stood = guard.time_without_progress(at(time), &driving(45.0 - 0.05 * f64::from(i)));
        assert!((0.0..0.5).contains(&stood), "{stood} s");
    }
    let stood = guard.time_without_progress(at(112.0), &left(f64::INFINITY));
    assert!((32.0..33.0).contains(&stood), "{stood} s");
    guard.start_drive(at(112.0));
    assert_eq!(guard.time_without_progress(at(113.0), &driving(60.0)), 0.0);
    assert_eq!(guard.time_without_progress(at(193.0), &driving(60.0)), 80.0, "a drive that stands");
}

#[test]
fn drives_to_and_fro_do_not_keep_a_goal_for_ever() {
    let (mut guard, patience) = (ProgressGuard::default(), 75.0);
    guard.time_without_progress(at(0.0), &left(2.0));
    let mut now = 0.0;
    // Each drive of 8 s ends with a stop of 1 s.
    let cycles = (0..10_000).take_while(|_| {
        guard.allow_detour(at(now), 0);
        guard.start_drive(at(now));
        for i in 0..80 {
            let rest = 12.0 - 0.05 * f64::from(i);
            guard.time_without_progress(at(now + 0.1 * f64::from(i)), &driving(rest));
        }
        now += 9.0;
        guard.time_without_progress(at(now), &left(f64::INFINITY)) <= patience
    });
    assert!((30..76).contains(&cycles.count()), "{now} s");
}

#[test]
fn a_pause_does_not_count() {
    let mut guard = ProgressGuard::default();
    guard.time_without_progress(at(0.0), &left(2.0));
    guard.pause(at(10.0));
    guard.pause(at(100.0));
    assert_eq!(guard.time_without_progress(at(101.0), &left(2.0)), 11.0, "10 s before, 1 s after");
    let mut fresh = ProgressGuard::default();
    fresh.pause(at(7.0));
    assert_eq!(fresh.time_without_progress(at(9.0), &left(f64::INFINITY)), 2.0);
}

#[test]
fn the_final_observation_ends_after_its_time_and_is_forgotten_with_the_next_progress() {
    let (mut guard, door) = (ProgressGuard::default(), Vector2::new(3.0, 1.0));
    guard.time_without_progress(at(0.0), &left(1.0));
    assert!(guard.final_observation().is_none());
    guard.begin_final_observation(at(80.0), door);
    assert_eq!(guard.final_observation().unwrap().nearest, door);
    guard.arrived_at_final_viewpoint(at(90.0));
    let continues = |seconds| guard.final_observation().unwrap().continues(at(seconds));
    assert!(continues(104.9) && !continues(105.1));
    guard.time_without_progress(at(120.0), &left(0.5));
    assert!(guard.final_observation().is_none());
}

#[test]
fn a_long_drive_to_the_final_viewpoint_leaves_time_for_the_search_there() {
    let mut guard = ProgressGuard::default();
    guard.begin_final_observation(at(80.0), Vector2::zeros());
    let continues =
        |guard: &ProgressGuard, seconds| guard.final_observation().unwrap().continues(at(seconds));
    assert!(continues(&guard, 139.9) && !continues(&guard, 140.1), "the drive has a limit");
    guard.arrived_at_final_viewpoint(at(125.0));
    assert!(continues(&guard, 134.9) && !continues(&guard, 135.1));
}
