//! A run from setup to end.

use crate::encoded_body::{EncodedBody, RunInput};
use crate::operator::FrontEnd;
use crate::{AppError, FinishedRun, RunLog, RunRecorder, RunSession, RunSetup, ServiceNotifier, stop};
use std::time::Instant;

/// Time for which a run continues after the arrival of the robot \[s\]. Motion after this time is not recorded. Source: ours.
pub const AFTER_ARRIVAL_S: f64 = 0.5;

/// Runs the robot of `setup` on `body` until the mission ends, the time limit passes or the user interrupts; records everything. An
/// operated run continues after its mission.
///
/// # Errors
/// When the robot or the checkpoint is invalid, or the body failed.
pub fn run_on_body(
    setup: &RunSetup,
    body: &mut dyn EncodedBody,
    recorder: RunRecorder,
    log: RunLog,
    front_end: impl Into<FrontEnd>,
) -> Result<FinishedRun, AppError> {
    let mut session = RunSession::new(setup, recorder, log, front_end.into())?;
    let mut service =
        if setup.real_time { ServiceNotifier::from_environment() } else { ServiceNotifier::default() };
    let mut finished = None;
    while let Some(input) = next_input(body, &session)? {
        let is_finished = session.step(input, body)?;
        service.note_step(Instant::now());
        let now = session.log().now;
        let is_over =
            is_finished && !setup.is_operated && now - *finished.get_or_insert(now) >= AFTER_ARRIVAL_S;
        let is_out_of_time = setup.is_out_of_time(session.log());
        if is_out_of_time {
            tracing::info!("the time limit of {} s ends the run", setup.time_limit);
        }
        if is_over || is_out_of_time || session.is_interrupted() {
            break;
        }
    }
    service.note_end();
    session.finish(body)
}

/// The user's request to stop, an operator's request, or the body's next input.
fn next_input(body: &mut dyn EncodedBody, session: &RunSession<'_>) -> Result<Option<RunInput>, AppError> {
    if stop::is_requested(|| format!("{:.1} s of the robot's time", session.log().elapsed())) {
        return Ok(Some(RunInput::Interrupted));
    }
    if let Some(request) = session.next_request() {
        return Ok(Some(RunInput::Operator(request)));
    }
    body.next_input()
}
