//! Rules of the navigator: its transitions between states, and its commands in each state.

mod arrival;
mod fallback;
mod lost_pose;
mod no_path;
mod progress_checker;
mod transitions;
mod view_monitor;
mod visibility_constraint;
mod zones;

use super::testing::{at_rest, floor, navigator, settings, waiting};
use super::*;
use crate::behaviour::contacts::MAX_BUMPER_CONTACTS;
use crate::behaviour::path_search::PathSearch;
use crate::pose_status::UNKNOWN_POSITION_SIGMA_M;
use proptest::prelude::*;
use std::f64::consts::FRAC_PI_2;
use trundle_control::{SafetyScan, StopReason};
use trundle_core::{Beam, Cell, CellIndex, DriveLimits, OccupancyGrid, Pose2, Scan, Stamp, Vector2};

/// Period of the control loop \[s\].
const STEP_S: f64 = 0.02;

/// A navigator on an ideal base: the base executes commands without a delay.
struct Base {
    navigator: Navigator,
    grid: OccupancyGrid,
    pose: Pose2,
    twist: Twist2,
    now: Stamp,
}

impl Base {
    /// A robot at rest in a closed room of 6 x 4 m.
    fn new(pose: Pose2) -> Self {
        let mut grid = floor(|_| false);
        let sides = (0..80).flat_map(|row| [0, 119].map(|col| CellIndex { col, row }));
        let ends = (0..120).flat_map(|col| [0, 79].map(|row| CellIndex { col, row }));
        sides.chain(ends).for_each(|cell| grid.set(cell, Cell::Occupied));
        Self { navigator: navigator(), grid, pose, twist: Twist2::ZERO, now: Stamp::default() }
    }

    /// A base with a goal.
    fn to(goal: Goal) -> Self {
        let mut base = Self::new(Pose2::new(3.0, 2.0, 0.0));
        base.navigator.set_goal(goal);
        base
    }

    /// Executes one control step; `change` modifies the navigator's input.
    fn step_with(&mut self, change: impl FnOnce(&mut WorldState<'_>)) -> Decision {
        self.now = self.now.after(STEP_S);
        let scan = free_all_around(self.now);
        let mut s = shown(&self.grid, &scan, (self.now, self.pose, self.twist));
        change(&mut s);
        s.pose_status.certainty = PoseCertainty::of(&s.estimate, settings().lost_sigma);
        let decision = self.navigator.step(&s, &mut StageTimes::default());
        self.pose = self.pose.advance(decision.twist, STEP_S);
        self.twist = decision.twist;
        decision
    }

    /// Steps for `seconds`; the twists.
    fn run(&mut self, seconds: f64) -> Vec<Twist2> {
        let steps = (seconds / STEP_S).round() as usize;
        (0..steps).map(|_| self.step_with(|_| ()).twist).collect()
    }

    /// Steps until the state has this name; the number of steps.
    fn run_to(&mut self, name: &str) -> Option<usize> {
        (0..5000).find(|_| {
            self.step_with(|_| ());
            self.navigator.state().name() == name
        })
    }

    /// Blocks all cells beyond x = 4 m, or frees them again.
    fn wall(&mut self, cell: Cell) {
        (1..79).for_each(|row| self.grid.set(CellIndex { col: 80, row }, cell));
    }
}

/// A scan that shows 5 m of free floor in every direction.
fn free_all_around(now: Stamp) -> Scan {
    let step = 2_f64.to_radians();
    Scan::new(now, Vector2::zeros(), -180.0_f64.to_radians(), step, vec![Beam::Free { range: 5.0 }; 180])
        .unwrap()
}

fn shown<'a>(
    grid: &'a OccupancyGrid,
    scan: &'a Scan,
    (now, pose, twist): (Stamp, Pose2, Twist2),
) -> WorldState<'a> {
    let carried = SafetyScan { scan, odom_at_scan: pose, odom_now: pose };
    let mut s = WorldState { scan: Some(carried), seen: Some(now), ..at_rest(grid, now, pose) };
    s.estimate.twist = twist;
    s
}

const AHEAD: Pose2 = Pose2 { x: 4.8, y: 2.0, theta: 0.0 };

#[test]
fn of_all_states_only_driving_rolls_on_to_the_next_goal() {
    let reason = Reason::MovingObstacle;
    let states = [
        State::Idle,
        State::Plan(PathSearch::default()),
        State::Drive(Drive::default()),
        State::Approach,
        State::Face(0.0),
        State::Maneuver,
        waiting(reason.clone(), None),
        State::Relocalize { reason: reason.clone() },
        State::Arrived,
        State::Stopped { reason },
    ];
    let after = |state: &State, goal| {
        let mut navigator = navigator();
        navigator.machine.place(state.clone());
        navigator.set_goal(goal);
        navigator.state().name()
    };
    for state in states {
        let next = if matches!(state, State::Drive(_)) { "driving" } else { "initializing" };
        assert_eq!(after(&state, Goal::Exact(AHEAD)), next, "{state:?}");
        assert_eq!(after(&state, Goal::Viewpoint(AHEAD)), next, "{state:?}");
        assert_eq!(after(&state, Goal::Spin), "initializing", "{state:?}");
        assert_eq!(after(&state, Goal::Stay), "idle", "{state:?}");
    }
}

#[test]
fn a_bumper_that_stays_pressed_is_one_contact() {
    let mut navigator = navigator();
    navigator.set_goal(Goal::Exact(AHEAD));
    (0..50).for_each(|_| navigator.touch(true));
    assert_eq!((navigator.tools.contacts.count, navigator.state().name()), (1, "initializing"));
    [false, true, false].into_iter().for_each(|pressed| navigator.touch(pressed));
    assert!(!navigator.state().is_over());
    navigator.touch(true);
    let reason = Reason::RepeatedContact { contacts: MAX_BUMPER_CONTACTS };
    assert_eq!(navigator.state(), DriveState::Stopped { reason });
    navigator.set_goal(Goal::Exact(AHEAD));
    assert!(!navigator.state().is_over() && navigator.tools.contacts.count == 0, "another goal counts anew");
}

#[test]
fn contacts_change_nothing_for_a_robot_that_has_arrived() {
    let mut navigator = navigator();
    for pressed in [true, false].repeat(5) {
        navigator.touch(pressed);
    }
    assert_eq!(navigator.state(), DriveState::Idle);
}

#[test]
fn nothing_moves_before_the_opening_is_over_and_a_scan_is_there() {
    let mut base = Base::to(Goal::Exact(AHEAD));
    let opening = settings().opening;
    for _ in 0..(2.0 * opening / STEP_S) as usize {
        assert_eq!(base.step_with(|s| s.scan = None).twist, Twist2::ZERO);
    }
    assert_eq!(base.navigator.state(), DriveState::Initializing, "no scan shows the floor");
    let mut base = Base::to(Goal::Exact(AHEAD));
    assert!(base.run(opening - STEP_S).iter().all(|twist| *twist == Twist2::ZERO));
    assert_eq!(base.navigator.state(), DriveState::Initializing);
    assert!(base.run_to("driving").unwrap() < 15);
}

#[test]
fn a_spin_turns_once_around_and_ends_at_rest() {
    let mut base = Base::to(Goal::Spin);
    base.run(settings().opening);
    let mut turned = 0.0;
    while !base.navigator.state().is_over() {
        let twist = base.step_with(|_| ()).twist;
        assert_eq!(twist.v, 0.0);
        turned += twist.omega * STEP_S;
    }
    assert_eq!(base.navigator.state(), DriveState::Arrived);
    assert!((1.0..1.1).contains(&(turned / std::f64::consts::TAU)), "{turned} rad");
    assert_eq!(base.run(0.1).last(), Some(&Twist2::ZERO));
}

#[test]
fn an_order_to_stay_brakes_at_the_limit_of_acceleration_and_then_the_robot_stands() {
    let mut base = Base::to(Goal::Exact(AHEAD));
    base.run_to("driving").unwrap();
    base.run(1.2);
    let (speed, from) = (base.twist.v, base.pose);
    assert!(speed > 0.4, "{speed} m/s");
    base.navigator.set_goal(Goal::Stay);
    let limit = DriveLimits::KOBUKI.acceleration;
    for (i, twist) in base.run(speed / limit + 0.1).iter().enumerate() {
        let expected = (speed - limit * STEP_S * (i + 1) as f64).max(0.0);
        assert!((twist.v - expected).abs() < 1e-6, "step {i}: {} m/s, not {expected}", twist.v);
    }
    assert_eq!(base.twist, Twist2::ZERO);
    let rolled = base.pose.distance(&from);
    assert!((rolled - speed * speed / (2.0 * limit)).abs() < 0.02, "{rolled} m");
}

#[test]
fn a_pose_that_is_lost_is_known_again_only_well_below_the_limit() {
    let mut base = Base::to(Goal::Exact(AHEAD));
    let limit = settings().lost_sigma;
    let mut with_sigma = |sigma: f64| {
        base.step_with(|s| s.estimate.covariance = nalgebra::Matrix3::from_diagonal_element(sigma * sigma));
        base.navigator.state()
    };
    assert_eq!(with_sigma(0.99 * limit).name(), "initializing");
    let DriveState::Lost { reason } = with_sigma(1.01 * limit) else { panic!("{limit} m is the limit") };
    assert_eq!(reason.kind(), ReasonKind::PoseUncertain);
    assert_eq!(with_sigma(0.6 * limit).name(), "lost", "the limit is not crossed to and fro");
    assert_eq!(with_sigma(0.4 * limit).name(), "initializing");
    let DriveState::Lost { reason } = with_sigma(1.1 * UNKNOWN_POSITION_SIGMA_M) else { panic!("50 m") };
    assert_eq!(reason.kind(), ReasonKind::PoseUnknown);
}

#[test]
fn each_cause_of_a_lost_pose_has_its_own_reason() {
    let lost = |change: &dyn Fn(&mut WorldState<'_>)| {
        let mut base = Base::to(Goal::Exact(AHEAD));
        base.step_with(change);
        base.navigator.state().reason().map(Reason::kind)
    };
    let unsure = nalgebra::Matrix3::from_diagonal_element(1.0);
    let wheels = |s: &mut WorldState<'_>| {
        (s.estimate.covariance, s.motion) = (unsure, MotionSense::Sight);
    };
    assert_eq!(lost(&wheels), Some(ReasonKind::WheelsUnresponsive));
    assert_eq!(lost(&|s| s.estimate.covariance = unsure), Some(ReasonKind::PoseUncertain));
}

#[test]
fn a_robot_that_loses_its_pose_on_the_way_brakes_and_then_turns_on_the_spot() {
    let mut base = Base::to(Goal::Exact(AHEAD));
    base.run_to("driving").unwrap();
    base.run(1.0);
    let mut twists = Vec::new();
    let unknown = nalgebra::Matrix3::from_diagonal_element(UNKNOWN_POSITION_SIGMA_M.powi(2) * 2.0);
    for _ in 0..150 {
        twists.push(base.step_with(|s| s.estimate.covariance = unknown).twist);
    }
    assert_eq!(base.navigator.state().name(), "lost");
    assert!(base.navigator.plan().is_none(), "a plan is of a place that is known");
    let last = twists.last().unwrap();
    assert!(last.v == 0.0 && last.omega > 0.1, "{last:?}");
    assert!(twists.windows(2).all(|pair| pair[1].v <= pair[0].v), "it never speeds up");
}

#[test]
fn patience_counts_from_the_last_progress_and_names_the_state() {
    for goal in [Goal::Exact(AHEAD), Goal::Viewpoint(AHEAD)] {
        let mut base = Base::to(goal);
        base.navigator.change(RunSetting::Patience(3.0));
        let steps = (0..500).take_while(|_| {
            base.step_with(|s| s.scan = None);
            !base.navigator.state().is_over()
        });
        let seconds = steps.count() as f64 * STEP_S;
        let opening = settings().opening;
        assert!((seconds - opening - 3.0).abs() < 0.1, "{seconds} s");
        let DriveState::Stopped { reason: Reason::NoProgress { state, cause, .. } } = base.navigator.state()
        else {
            panic!("{}", base.navigator.state())
        };
        assert_eq!((state, cause), ("initializing", None));
    }
}

#[test]
fn a_safety_stop_holds_a_driving_robot_and_ends_with_its_cause() {
    let mut base = Base::to(Goal::Exact(AHEAD));
    base.run_to("driving").unwrap();
    base.run(0.5);
    let old = base.now;
    for _ in 0..60 {
        base.step_with(|s| s.seen = Some(old));
    }
    assert_eq!(base.twist, Twist2::ZERO);
    let DriveState::Waiting { reason: Reason::Safety(StopReason::StaleImage { age }) } =
        base.navigator.state()
    else {
        panic!("{}", base.navigator.state())
    };
    assert!((1.1..1.3).contains(&age), "{age} s");
    assert_eq!(base.run_to("driving"), Some(0), "with the first image that shows something");
    assert!(base.run_to("arrived").is_some() && base.pose.distance(&AHEAD) < 0.03, "{:?}", base.pose);
}

#[test]
fn a_maneuver_whose_straight_move_ends_before_a_wall_goes_on_by_a_turn() {
    let goal = Pose2::new(3.0, 2.38, 0.0);
    let mut base = Base::to(Goal::Align(goal));
    base.run_to("maneuvering").unwrap();
    let (mut seen, mut blind_steps) = (base.now, 0);
    for _ in 0..6000 {
        // Beside the goal a wall is nearer than the camera measures.
        let faces_wall = (base.pose.theta - FRAC_PI_2).abs() < 0.5 && base.pose.y > goal.y - 0.05;
        blind_steps += usize::from(faces_wall);
        seen = if faces_wall { seen } else { base.now };
        base.step_with(|s| s.seen = Some(seen));
        if base.navigator.state().is_over() {
            break;
        }
    }
    assert_eq!(base.navigator.state().name(), "arrived", "{} {:?}", base.navigator.state(), base.pose);
    assert!(base.pose.distance(&goal) < 0.03, "{:?}", base.pose);
    assert!(blind_steps as f64 * STEP_S > 3.0, "{blind_steps}");
}

#[test]
fn only_states_that_may_plan_are_given_to_a_worker() {
    let grid = floor(|_| false);
    let s = at_rest(&grid, Stamp::default().after(10.0), AHEAD);
    let reason = || Reason::MovingObstacle;
    let takes_long = |state: State, goal| {
        let mut navigator = navigator();
        navigator.set_goal(goal);
        navigator.machine.place(state);
        navigator.may_take_long(&s)
    };
    let goal = Goal::Exact(AHEAD);
    for state in [State::Idle, State::Arrived, State::Approach, State::Face(0.0)] {
        assert!(!takes_long(state, goal));
    }
    assert!(!takes_long(State::Stopped { reason: reason() }, goal));
    assert!(!takes_long(State::Relocalize { reason: reason() }, goal));
    for state in [
        State::Initialize,
        State::Plan(PathSearch::default()),
        State::Maneuver,
        State::Drive(Drive::default()),
    ] {
        assert!(takes_long(state.clone(), goal), "{state:?}");
        assert!(!takes_long(state, Goal::Spin), "a turn needs no plan");
    }
    assert!(takes_long(waiting(reason(), None), goal), "a check is due");
}

#[test]
fn the_fallback_goes_on_exactly_as_the_navigator_would() {
    let mut base = Base::to(Goal::Exact(AHEAD));
    base.run_to("driving").unwrap();
    base.run(0.4);
    let (mut fallback, mut pose, mut twist) = (base.navigator.fallback(), base.pose, base.twist);
    for i in 1..=40 {
        let now = base.now.after(STEP_S);
        let (scan, grid) = (free_all_around(now), base.grid.clone());
        twist = fallback.step(&shown(&grid, &scan, (now, pose, twist)));
        pose = pose.advance(twist, STEP_S);
        assert_eq!(twist, base.step_with(|_| ()).twist, "step {i}");
        assert_eq!(fallback.sent, twist);
    }
    assert!(twist.v > 0.3);
    fallback.touched = true;
    let scan = free_all_around(base.now);
    let stopped = fallback.step(&shown(&base.grid, &scan, (base.now, pose, twist)));
    assert_eq!(stopped, Twist2::ZERO, "safety has the last word");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn any_goal_on_free_floor_is_reached_within_the_limits_of_the_base(
        theta in -3.1..3.1_f64, x in 1.0..5.0_f64, y in 1.0..3.0_f64, heading in -3.1..3.1_f64,
    ) {
        let (mut base, goal) = (Base::new(Pose2::new(3.0, 2.0, theta)), Pose2::new(x, y, heading));
        base.navigator.set_goal(Goal::Exact(goal));
        let (limits, mut last) = (DriveLimits::KOBUKI, Twist2::ZERO);
        let wheelbase = RobotConfig::default().drive.wheelbase;
        for _ in 0..4000 {
            let twist = base.step_with(|_| ()).twist;
            let allowed = limits.saturate(twist, wheelbase);
            prop_assert!((allowed.v - twist.v).abs() + (allowed.omega - twist.omega).abs() < 1e-9, "{twist:?}");
            let rise = twist.v.abs() - last.v.abs();
            prop_assert!(rise <= limits.acceleration * STEP_S + 1e-9, "{last:?} to {twist:?}");
            last = twist;
            if base.navigator.state().is_over() {
                break;
            }
        }
        prop_assert_eq!(base.navigator.state(), DriveState::Arrived);
        let off = goal.inverse() * base.pose;
        prop_assert!(off.position().norm() < 0.03 && off.theta.abs() < 0.05, "{off:?}");
    }

    #[test]
    fn without_a_goal_nothing_that_is_seen_or_felt_moves_the_robot(
        sigma in 0.0..90.0_f64, is_seen in any::<bool>(), pressed in any::<bool>(),
    ) {
        let mut base = Base::new(AHEAD);
        base.navigator.touch(pressed);
        base.navigator.cliff(!pressed);
        for _ in 0..300 {
            let decision = base.step_with(|s| {
                s.estimate.covariance = nalgebra::Matrix3::from_diagonal_element(sigma * sigma);
                s.seen = s.seen.filter(|_| is_seen);
            });
            prop_assert_eq!((decision.twist, decision.replanned), (Twist2::ZERO, false));
        }
        prop_assert_eq!(base.navigator.state(), DriveState::Idle);
    }
}
