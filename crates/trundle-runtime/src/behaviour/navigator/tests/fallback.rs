//! The fallback controller during a decision job: it brakes when halted, and the safety monitor stops each of its twists.

use super::*;
use crate::workers::fallback_controller::FallbackController;
use trundle_control::MotionHold;

/// A robot at speed, with the controller that continues its drive.
fn at_speed() -> (Base, FallbackController) {
    let mut base = Base::to(Goal::Exact(AHEAD));
    base.run_to("driving").unwrap();
    base.run(1.0);
    assert!(base.twist.v > 0.3, "{:?}", base.twist);
    let fallback = base.navigator.fallback();
    (base, fallback)
}

/// The twists of `count` steps, each with its world changed by `change`.
fn steps(
    base: &mut Base,
    fallback: &mut FallbackController,
    count: usize,
    change: impl Fn(&mut WorldState<'_>),
) -> Vec<Twist2> {
    let step = |_| {
        base.now = base.now.after(STEP_S);
        let scan = free_all_around(base.now);
        let mut s = shown(&base.grid, &scan, (base.now, base.pose, base.twist));
        change(&mut s);
        base.twist = fallback.step(&s);
        base.pose = base.pose.advance(base.twist, STEP_S);
        base.twist
    };
    (0..count).map(step).collect()
}

#[test]
fn a_halted_controller_brakes_at_the_limit_of_acceleration_and_stays_at_rest() {
    let (mut base, mut fallback) = at_speed();
    let before = base.twist.v;
    fallback.halt();
    let twists = steps(&mut base, &mut fallback, 100, |_| ());
    let speeds: Vec<f64> = std::iter::once(before).chain(twists.iter().map(|twist| twist.v)).collect();
    let limit = DriveLimits::KOBUKI.acceleration * STEP_S;
    assert!(
        speeds.windows(2).all(|pair| pair[1] <= pair[0] && pair[0] - pair[1] <= limit + 1e-9),
        "{speeds:?}"
    );
    let moving = speeds.iter().filter(|speed| **speed > 0.0).count() as f64;
    assert!(moving <= before / limit + 3.0, "{moving} steps from {before} m/s");
    assert_eq!(twists[99], Twist2::ZERO);
}

#[test]
fn each_cause_of_a_stop_stops_it_in_the_same_step() {
    type Change = fn(&mut WorldState<'_>);
    let causes: [(&str, Change); 4] = [
        ("hold of the body", |s| s.hold = Some(MotionHold::WheelDrop)),
        ("image too old", |s| s.seen = Some(s.now.after(-5.0))),
        ("no source of the motion", |s| s.motion = MotionSense::Nothing),
        ("wheels silent", |s| s.wheels = Some(s.now.after(-1.0))),
    ];
    for (cause, change) in causes {
        let (mut base, mut fallback) = at_speed();
        assert_eq!(steps(&mut base, &mut fallback, 1, change), [Twist2::ZERO], "{cause}");
        let after = steps(&mut base, &mut fallback, 30, |_| ());
        assert!(after.last().unwrap().v > 0.0, "it drives on without the cause: {cause}");
        let rise = DriveLimits::KOBUKI.acceleration * STEP_S;
        assert!(after[0].v <= rise + 1e-9, "from rest: {:?}", after[0]);
    }
}

#[test]
fn bumper_and_edge_stop_a_drive_ahead() {
    for (touched, over_edge) in [(true, false), (false, true), (true, true)] {
        let (mut base, mut fallback) = at_speed();
        (fallback.touched, fallback.over_edge) = (touched, over_edge);
        let twists = steps(&mut base, &mut fallback, 20, |_| ());
        assert!(twists.iter().all(|twist| twist.v <= 0.0), "{touched} {over_edge}: {twists:?}");
    }
}

#[test]
fn a_turn_on_the_spot_goes_on_at_its_rate() {
    let mut base = Base::to(Goal::Spin);
    base.run(settings().opening + 1.0);
    let (turning, mut fallback) = (base.twist, base.navigator.fallback());
    assert!(turning.omega > 0.2 && turning.v == 0.0, "{turning:?}");
    let twists = steps(&mut base, &mut fallback, 25, |_| ());
    assert!(twists.iter().all(|twist| *twist == turning), "{twists:?}");
    fallback.halt();
    assert_eq!(steps(&mut base, &mut fallback, 100, |_| ())[99], Twist2::ZERO);
}
