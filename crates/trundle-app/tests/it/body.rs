//! Bodies for tests: a base at rest, and a base whose user ends the run.

use std::io;
use trundle_app::{
    AppError, EncodedBody, FinishedRun, Progress, RunInput, RunLog, RunRecorder, RunSetup, run_on_body,
};
use trundle_core::{GyroRate, Pose2, RobotBody, SensorEvent, Stamp, Touch, Twist2, WheelTicks};
use trundle_io::OutputFolder;
use trundle_runtime::{Answer, Job, Mission, RobotConfig, Task, Worker};

/// The goal of all runs, map frame.
pub const GOAL: Pose2 = Pose2 { x: 1.0, y: 0.0, theta: 0.0 };

/// A base at rest that ignores commands: gyro, wheels and truth at 50 Hz, no camera.
#[derive(Debug, Default)]
pub struct StillBody {
    /// Events left.
    pub events: std::collections::VecDeque<SensorEvent>,
    /// Commands so far.
    pub commands: Vec<Twist2>,
    /// True contacts; `None` if not counted.
    pub contacts: Option<u32>,
    /// Whether the sensors fail once the events are used up.
    pub fails: bool,
    /// Whether the base refuses commands.
    pub refuses: bool,
}

/// Stamp of step `i` at 50 Hz.
pub fn stamp(i: i64) -> Stamp {
    Stamp::from_nanos(i * 20_000_000)
}

/// Events of a base at rest in steps `from` to `to`.
pub fn at_rest(from: i64, to: i64) -> impl Iterator<Item = SensorEvent> {
    (from..to).flat_map(|i| {
        let stamp = stamp(i);
        [
            SensorEvent::Gyro(GyroRate { stamp, omega: 0.0 }),
            SensorEvent::Wheels(WheelTicks { stamp, left: 0, right: 0 }),
            SensorEvent::Truth { stamp, pose: Pose2::IDENTITY },
        ]
    })
}

impl StillBody {
    /// A body with events of a number of steps at 50 Hz.
    pub fn new(steps: i64) -> Self {
        Self { events: at_rest(0, steps).collect(), ..Self::default() }
    }

    /// A body whose bumper is pressed and released three times from step 10 on, with events for 4 s in all.
    pub fn touched() -> Self {
        let touch = |i: i64, pressed| SensorEvent::Touch(Touch { stamp: stamp(i), pressed });
        let touches = (10..13).flat_map(|i| at_rest(i, i + 1).chain([touch(i, true), touch(i, false)]));
        Self { events: at_rest(0, 10).chain(touches).chain(at_rest(13, 200)).collect(), ..Self::default() }
    }
}

impl RobotBody for StillBody {
    type Error = io::Error;

    fn next_event(&mut self) -> io::Result<Option<SensorEvent>> {
        match self.events.pop_front() {
            None if self.fails => Err(io::Error::other("the sensor bus is lost")),
            event => Ok(event),
        }
    }

    fn command(&mut self, twist: Twist2) -> io::Result<()> {
        if self.refuses {
            return Err(io::Error::other("the base is in charge mode"));
        }
        self.commands.push(twist);
        Ok(())
    }

    fn contact_count(&self) -> Option<u32> {
        self.contacts
    }
}

/// A still body with a function that is called before each input, with its number from 1. What the function returns replaces the input.
pub struct HookedBody<F> {
    /// The body.
    pub body: StillBody,
    hook: F,
    inputs: usize,
}

impl<F: FnMut(usize) -> Option<RunInput>> HookedBody<F> {
    /// The body with its function.
    pub fn new(body: StillBody, hook: F) -> Self {
        Self { body, hook, inputs: 0 }
    }
}

/// A still body whose user ends the run after `inputs` inputs.
pub fn interrupted(inputs: usize) -> HookedBody<impl FnMut(usize) -> Option<RunInput>> {
    HookedBody::new(StillBody::new(1000), move |input| (input > inputs).then_some(RunInput::Interrupted))
}

impl<F: FnMut(usize) -> Option<RunInput>> EncodedBody for HookedBody<F> {
    fn next_input(&mut self) -> Result<Option<RunInput>, AppError> {
        self.inputs += 1;
        match (self.hook)(self.inputs) {
            None => self.body.next_input(),
            input => Ok(input),
        }
    }

    fn send_command(&mut self, twist: Twist2) -> Result<(), AppError> {
        self.body.send_command(twist)
    }

    fn start_job(&mut self, job: Job) {
        self.body.start_job(job);
    }

    fn finish_job(&mut self, worker: Worker) -> Option<Answer> {
        self.body.finish_job(worker)
    }

    fn true_contacts(&self) -> Option<u32> {
        self.body.true_contacts()
    }
}

/// A run to [`GOAL`] by the default robot.
pub fn setup() -> RunSetup {
    RunSetup::new("nowhere", Mission::new(vec![Task::go(GOAL)]).unwrap(), RobotConfig::default())
}

/// Runs `setup` on `body`, recorded into a temporary folder.
pub fn run(setup: &RunSetup, body: &mut dyn EncodedBody) -> Result<FinishedRun, AppError> {
    let scratch = tempfile::tempdir().unwrap();
    let folder = OutputFolder::create(&scratch.path().join("run")).unwrap();
    run_into(setup, body, &folder)
}

/// Runs `setup` on `body`, recorded into `folder`.
pub fn run_into(
    setup: &RunSetup,
    body: &mut dyn EncodedBody,
    folder: &OutputFolder,
) -> Result<FinishedRun, AppError> {
    run_on_body(setup, body, RunRecorder::to_folder(folder)?, RunLog::default(), Progress::hidden())
}
