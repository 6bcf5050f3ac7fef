//! A body whose events arrive in the encoding of a recording: any [`RobotBody`], a recording, or live hardware.

use crate::{AppError, DisplayedState, operator::OperatorRequest};
use trundle_core::{RobotBody, Twist2};
use trundle_io::EncodedEvent;
use trundle_runtime::{Answer, Job, Worker};

/// Input of a run.
#[non_exhaustive]
pub enum RunInput {
    /// A sensor event in the encoding of the recording.
    Event(EncodedEvent),
    /// The result of a background job.
    Answer(Answer),
    /// A command of an operator.
    Operator(OperatorRequest),
    /// The user ends the run.
    Interrupted,
}

/// A body whose events arrive in the encoding of the recording. Background jobs of the robot run at the same time.
pub trait EncodedBody {
    /// The next input; `None` at the end.
    ///
    /// # Errors
    /// When a sensor, the connection or the recording failed for good.
    fn next_input(&mut self) -> Result<Option<RunInput>, AppError>;

    /// Commands the base to move with `twist` until the next command.
    ///
    /// # Errors
    /// When the base cannot be reached or refuses the command.
    fn send_command(&mut self, twist: Twist2) -> Result<(), AppError>;

    /// Starts a background job of the robot.
    fn start_job(&mut self, job: Job);

    /// The result of a job that is running at the end of a run; `None` without one.
    fn finish_job(&mut self, worker: Worker) -> Option<Answer>;

    /// Separate contacts so far, in truth; `None` if only the bumper reports contacts.
    fn true_contacts(&self) -> Option<u32>;

    /// Shows the state of the run to people near the robot, by lights and sounds. The motion must not depend on it.
    fn show_state(&mut self, _run: &DisplayedState<'_>) {}

    /// Share of the events that was read, 0 to 1; `None` if their number is unknown.
    fn fraction_read(&self) -> Option<f64> {
        None
    }
}

/// Every body that works in the data's time: the robot's long work is done within its steps.
impl<B: RobotBody> EncodedBody for B {
    fn next_input(&mut self) -> Result<Option<RunInput>, AppError> {
        let event = self.next_event().map_err(|error| AppError::Input(error.to_string()))?;
        let event = event.map(|event| EncodedEvent::encode(&event)).transpose();
        Ok(event.map_err(|error| AppError::Input(error.to_string()))?.map(RunInput::Event))
    }

    fn send_command(&mut self, twist: Twist2) -> Result<(), AppError> {
        self.command(twist).map_err(|error| AppError::Input(error.to_string()))
    }

    fn start_job(&mut self, _job: Job) {}

    fn finish_job(&mut self, _helper: Worker) -> Option<Answer> {
        None
    }

    fn true_contacts(&self) -> Option<u32> {
        self.contact_count()
    }
}
