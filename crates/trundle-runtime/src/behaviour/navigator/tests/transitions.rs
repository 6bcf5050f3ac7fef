//! Changes of state: each one is in the table, and no data outlives its state.

use super::*;
use crate::behaviour::relative_motion::RelativeMotion;
use crate::behaviour::state::Recover;
use crate::behaviour::station_drive::StationGoal;
use proptest::sample::select;
use trundle_control::MotionHold;

/// An event that affects the robot for some time.
#[derive(Debug, Clone)]
struct Episode {
    goal: Option<Goal>,
    /// Standard deviation of the position \[m\].
    sigma: f64,
    pressed: bool,
    over_edge: bool,
    sees: bool,
    is_held: bool,
    motion: MotionSense,
    wall: Cell,
    /// Number of control steps.
    steps: usize,
}

fn goals() -> impl Strategy<Value = Option<Goal>> {
    let near = Pose2::new(4.2, 2.4, 1.0);
    select(vec![
        None,
        Some(Goal::Exact(AHEAD)),
        Some(Goal::Exact(near)),
        Some(Goal::Viewpoint(AHEAD)),
        Some(Goal::Align(near)),
        Some(Goal::Relative(RelativeMotion::Straight { distance: 0.3, speed: 0.2 })),
        Some(Goal::Station(StationGoal::BackOff(0.3))),
        Some(Goal::Spin),
        Some(Goal::Stay),
    ])
}

fn episodes() -> impl Strategy<Value = Episode> {
    let motions =
        select(vec![MotionSense::Wheels, MotionSense::Wheels, MotionSense::Sight, MotionSense::Nothing]);
    let world =
        (select(vec![0.01, 0.01, 0.01, 0.8, 60.0]), select(vec![Cell::Free, Cell::Occupied]), motions);
    let flags = [0.1, 0.05, 0.8, 0.1].map(proptest::bool::weighted);
    (prop_oneof![2 => Just(None), 1 => goals()], world, flags, 5..120_usize).prop_map(
        |(goal, (sigma, wall, motion), [pressed, over_edge, sees, is_held], steps)| Episode {
            goal,
            sigma,
            pressed,
            over_edge,
            sees,
            is_held,
            motion,
            wall,
            steps,
        },
    )
}

impl Base {
    fn endure(&mut self, episode: &Episode) {
        if let Some(goal) = episode.goal {
            self.navigator.set_goal(goal);
        }
        self.navigator.touch(episode.pressed);
        self.navigator.cliff(episode.over_edge);
        self.wall(episode.wall);
        for _ in 0..episode.steps {
            self.step_with(|s| {
                s.estimate.covariance = nalgebra::Matrix3::from_diagonal_element(episode.sigma.powi(2));
                s.seen = s.seen.filter(|_| episode.sees);
                s.hold = episode.is_held.then_some(MotionHold::Paused);
                s.motion = episode.motion;
            });
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// A change that the table lacks stops this test by an assertion of the state machine.
    #[test]
    fn no_course_of_events_leaves_the_table_of_transitions(
        first in goals(), course in proptest::collection::vec(episodes(), 10..30),
    ) {
        let mut base = Base::to(first.unwrap_or(Goal::Exact(AHEAD)));
        base.navigator.change(RunSetting::Patience(20.0));
        for episode in &course {
            base.endure(episode);
        }
    }
}

#[test]
#[cfg(debug_assertions)]
#[should_panic(expected = "is in the table of transitions")]
fn a_change_that_the_table_lacks_stops_a_debug_build() {
    let mut navigator = navigator();
    navigator.machine.change(State::Drive(Drive::default()).because(TransitionReason::GoalReached));
}

#[test]
fn the_reason_for_the_last_change_of_state_is_kept_until_the_next_change() {
    let mut base = Base::to(Goal::Exact(AHEAD));
    assert_eq!(base.navigator.transition(), Some(TransitionReason::GoalGiven));
    base.run_to("driving").unwrap();
    assert_eq!(base.navigator.transition(), Some(TransitionReason::PlanFound));
    base.run(0.1);
    assert_eq!(base.navigator.transition(), Some(TransitionReason::PlanFound));
    base.navigator.set_goal(Goal::Stay);
    assert_eq!(base.navigator.transition(), Some(TransitionReason::GoalDropped));
}

#[test]
fn a_robot_that_was_wedged_observes_unseen_floor_and_does_not_back_out() {
    let goal = Pose2::new(2.9, 3.2, 1.57);
    let mut base = Base::new(Pose2::new(2.6, 1.1, 0.0));
    base.grid = super::visibility_constraint::unseen_bend();
    base.navigator.set_goal(Goal::Exact(goal));
    let (reason, search) = (Reason::MovingObstacle, PathSearch::default());
    base.navigator.machine.place(State::Recover(Recover { reason, is_wedged: true, search }));
    base.run(1.0);
    assert_eq!(base.navigator.state().reason().unwrap().kind(), ReasonKind::UnseenFloor);
    let twists = base.run(1.0);
    assert!(twists.iter().all(|twist| twist.v > -0.01), "{twists:?}");
}

#[test]
fn time_without_a_pose_is_no_time_without_a_path() {
    let mut base = Base::to(Goal::Exact(AHEAD));
    base.navigator.end_without_path(true);
    base.wall(Cell::Occupied);
    base.run(settings().opening + 1.0);
    assert_eq!(base.navigator.state().name(), "recovering");
    let unsure = nalgebra::Matrix3::from_diagonal_element(1.0);
    (0..100).for_each(|_| _ = base.step_with(|s| s.estimate.covariance = unsure));
    assert_eq!(base.navigator.state().name(), "lost");
    let seconds = base.run_to("stopped").unwrap() as f64 * STEP_S;
    assert!((2.0..2.5).contains(&seconds), "{seconds} s");
}
