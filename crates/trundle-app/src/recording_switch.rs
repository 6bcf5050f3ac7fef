//! The switch of a run's recording: front ends ask, the recorder reports.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// State of a run's recording.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct RecordingState {
    /// Whether a file is being written.
    pub is_on: bool,
    /// Name of the present or last file in the folder of results; `None` before the first.
    pub file: Option<String>,
    /// Reason why the recording is off, unless a person switched it off.
    pub reason: Option<String>,
    /// Free space of the disk \[bytes\], some seconds old; `None` if the system does not report it.
    pub free_bytes: Option<u64>,
    /// Names of the files that could not be written to their end.
    pub failed_files: Vec<String>,
}

/// The switch of a run's recording. Clones share it.
#[derive(Debug, Clone, Default)]
pub struct RecordingSwitch {
    shared: Arc<Mutex<Shared>>,
}

#[derive(Debug, Default)]
struct Shared {
    state: RecordingState,
    /// Request of a front end that the run has not yet taken.
    request: Option<bool>,
}

impl RecordingSwitch {
    /// State of the recording.
    #[must_use]
    pub fn state(&self) -> RecordingState {
        self.shared().state.clone()
    }

    /// Requests a recording, or its end. The run takes the request at its next step.
    pub fn turn(&self, on: bool) {
        self.shared().request = Some(on);
    }

    /// The newest request since the last call, if it changes the state.
    pub(crate) fn take_request(&self) -> Option<bool> {
        let mut shared = self.shared();
        let is_on = shared.state.is_on;
        shared.request.take().filter(|on| *on != is_on)
    }

    /// Changes the state.
    pub(crate) fn update(&self, change: impl FnOnce(&mut RecordingState)) {
        change(&mut self.shared().state);
    }

    fn shared(&self) -> MutexGuard<'_, Shared> {
        self.shared.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_request_counts_and_a_request_without_effect_is_dropped() {
        let switch = RecordingSwitch::default();
        assert_eq!(switch.take_request(), None);
        switch.turn(false);
        assert_eq!(switch.take_request(), None, "it is off");
        switch.turn(false);
        switch.turn(true);
        assert_eq!(switch.take_request(), Some(true));
        assert_eq!(switch.take_request(), None);
        switch.update(|state| state.is_on = true);
        switch.turn(true);
        assert_eq!(switch.take_request(), None, "it is on");
    }
}
