//! The state of a run by the first light and the melodies of a Kobuki.
//!
//! | light | state |
//! |---|---|
//! | green | the robot is ready or drives |
//! | orange | it waits, looks for a path or for its pose, or a condition or a person holds it |
//! | red | its mission has failed |
//! | off | no run, or the user ended it |
//!
//! | melody | event |
//! |---|---|
//! | cleaning start | the run begins |
//! | cleaning end | a task is done, for example a goal is reached |
//! | error | the light turns red |

use crate::DisplayedState;
use trundle_drivers::kobuki::Accessories;
use trundle_drivers::kobuki::protocol::{Led, Outputs, SoundSequence};
use trundle_runtime::{DriveState, ReasonKind};

/// Signals as last shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Shown {
    light: Led,
    tasks_done: usize,
}

/// The light of a state of the run.
fn light_of(run: &DisplayedState<'_>) -> Led {
    let reason = run.state.reason();
    if reason.is_some_and(|reason| reason.kind() == ReasonKind::Interrupted) {
        Led::OFF
    } else if run.is_finished && matches!(run.state, DriveState::Stopped { .. }) {
        Led::RED
    } else if run.is_held || reason.is_some() {
        Led::ORANGE
    } else {
        Led::GREEN
    }
}

/// The melody of the change from `before` to `now`; `before` is `None` at the start of a run. Red comes before a done task.
fn melody_of(before: Option<Shown>, now: Shown) -> Option<SoundSequence> {
    match before {
        None => Some(SoundSequence::CleaningStart),
        Some(before) if now.light == Led::RED && before.light != Led::RED => Some(SoundSequence::Error),
        Some(before) if now.tasks_done > before.tasks_done => Some(SoundSequence::CleaningEnd),
        Some(_) => None,
    }
}

/// Shows the state of a run on a base; only changes are sent.
pub(super) struct StateSignals {
    base: Accessories,
    shown: Option<Shown>,
}

impl StateSignals {
    pub(super) fn new(base: Accessories) -> Self {
        Self { base, shown: None }
    }

    pub(super) fn show(&mut self, run: &DisplayedState<'_>) {
        let now = Shown { light: light_of(run), tasks_done: run.tasks_done };
        let before = self.shown.replace(now);
        if before.is_none_or(|before| before.light != now.light) {
            self.set_light(now.light);
        }
        if let Some(melody) = melody_of(before, now) {
            self.base.play(melody);
        }
    }

    /// Ends the signals with the run. Red remains: a person who comes later sees that the mission has failed.
    pub(super) fn end(&mut self) {
        if self.shown.is_some_and(|shown| shown.light != Led::RED) {
            self.set_light(Led::OFF);
        }
    }

    fn set_light(&self, led1: Led) {
        self.base.set_outputs(Outputs { led1, ..Outputs::default() });
    }
}

#[cfg(test)]
mod tests;
