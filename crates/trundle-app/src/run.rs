//! A run from its setup to its end.

use crate::encoded_body::EncodedBody;
use crate::{AppError, FinishedRun, Progress, RunLog, RunRecorder, RunSession, RunSetup};

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
