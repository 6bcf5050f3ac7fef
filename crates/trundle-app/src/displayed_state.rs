//! The state of a run for people near the robot.

use trundle_runtime::DriveState;

/// The state of a run after a step, for lights and sounds.
#[derive(Debug, Clone, Copy)]
pub struct DisplayedState<'r> {
    /// State of the robot.
    pub state: &'r DriveState,
    /// Whether the mission is over; `state` then holds its outcome.
    pub is_finished: bool,
    /// Whether a condition of the body, or a person, forbids motion.
    pub is_held: bool,
    /// Number of tasks of the present mission that are done.
    pub tasks_done: usize,
}

/// Shows the state of a run. Called after each step, on the control thread: it must not wait.
pub type StateDisplay = Box<dyn FnMut(&DisplayedState<'_>) + Send>;
