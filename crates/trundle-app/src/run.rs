//! A run from its setup to its end.

use crate::encoded_body::EncodedBody;
use crate::{AppError, BestView, Progress, RunLog, RunRecorder, RunSession, RunSetup};
use std::time::Duration;
use trundle_runtime::{Histogram, Robot};

/// A run that has ended.
pub struct FinishedRun {
    /// The robot, with its map and plan.
    pub robot: Robot,
    /// The log.
    pub log: RunLog,
    /// The view with the largest number of tracked features.
    pub view: BestView,
    /// Wall-clock time of the run \[s\].
    pub seconds: f64,
    /// The cost of recording.
    pub recording: RecordingCost,
}

/// The cost of recording a run.
#[derive(Debug, Default)]
pub struct RecordingCost {
    /// Lines that waited for the disk, counted each time a line was written.
    pub queue_lengths: Histogram,
    /// Lines left out because the disk could not follow.
    pub lines_lost: u64,
    /// Processor time of the recorder's thread, where there is one.
    pub cpu_time: Duration,
    /// Why the recording is not whole, if it is not.
    pub error: Option<AppError>,
}

/// Time that a run goes on after the robot has arrived \[s\]. A longer roll is not seen. Source: ours.
pub const AFTER_ARRIVAL_S: f64 = 0.5;

/// Runs the robot of `setup` on `body` until its mission is over, its time is over or the user interrupts; records everything.
///
/// # Errors
/// When the robot or the checkpoint cannot be accepted, or the body failed.
pub fn run_on_body(
    setup: &RunSetup,
    body: &mut dyn EncodedBody,
    recorder: RunRecorder,
    log: RunLog,
    progress: Progress,
) -> Result<FinishedRun, AppError> {
    let mut session = RunSession::new(setup, recorder, log, progress)?;
    let mut finished = None;
    while let Some(input) = body.next_input()? {
        let is_finished = session.step(input, body)?;
        let now = session.log().now;
        let is_over = is_finished && now - *finished.get_or_insert(now) >= AFTER_ARRIVAL_S;
        if is_over || session.is_interrupted() || session.log().elapsed() > setup.time_limit {
            break;
        }
    }
    session.finish(body)
}
