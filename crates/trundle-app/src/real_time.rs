//! A run in real time: the threads of the body on one core, those of the robot on another.
//!
//! | thread | core | work |
//! |---|---|---|
//! | the body's | first | sensors and base |
//! | control | last | the robot's steps |
//! | perception, decision | last | the robot's long work |
//! | recorder | last | the recording |

mod background_body;
pub(crate) mod device_report;
mod event_feed;
mod event_order;
mod live_body;
mod memory_usage;
mod pacer;
mod report;
mod threaded_body;

pub use background_body::{BackgroundBody, BodyTiming, EventOrderCounts, Lateness, TimedEvent};
pub use device_report::DeviceReport;
pub use event_feed::{EventFeed, EventObserver};
pub use live_body::LiveBody;
pub use memory_usage::MemoryUsage;
pub use pacer::RealTimePacer;
pub use report::{QueueLength, RealTimeReport, ThreadLoad};

use crate::operator::FrontEnd;
use crate::{AppError, FinishedRun, RunLog, RunRecorder, RunSetup, run_on_body};
use rayon::ThreadPoolBuilder;
use std::path::Path;
use threaded_body::ThreadedBody;
use trundle_io::OutputFolder;
use trundle_runtime::real_time::{InboxSender, LoopTimerConfig, ThreadPlacement, thread_time};

/// Image rate of a run in real time \[Hz\]. Source: ours, the rate of a Kinect.
pub const CAMERA_HZ: f64 = 30.0;
/// Time without a command after which the base stops automatically \[s\]. Source: ours.
pub const COMMAND_TIMEOUT_S: f64 = 0.2;
/// Niceness of the worker threads above that of control. Source: ours.
const WORKER_NICENESS: i32 = 5;
/// Niceness of the recorder's thread above that of control. Source: ours.
const RECORDER_NICENESS: i32 = 10;

/// Runs the robot of `setup` in real time with the body that `start_body` starts, until the mission ends or the user interrupts. Everything
/// is recorded into `folder`.
///
/// # Errors
/// When the system refuses a thread, the body cannot be started, or the robot is invalid.
pub fn run_in_real_time<B: BackgroundBody>(
    setup: &RunSetup,
    start_body: impl FnOnce(InboxSender<TimedEvent>, ThreadPlacement) -> Result<B, AppError> + Send,
    folder: &OutputFolder,
    checkpoint_file: Option<&Path>,
    log: RunLog,
    front_end: impl Into<FrontEnd> + Send,
) -> Result<(FinishedRun, RealTimeReport), AppError> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let (outside, inside) = if cores > 1 { (Some(0), Some(cores - 1)) } else { (None, None) };
    let at = move |nice| ThreadPlacement { core: inside, nice, is_first: false };
    let recorder = RunRecorder::threaded(setup.recording, folder, at(RECORDER_NICENESS))?
        .with_checkpoint_file(checkpoint_file)?;
    let pool = ThreadPoolBuilder::new()
        .num_threads(1)
        .thread_name(|_| "control".to_owned())
        .start_handler(move |_| _ = ThreadPlacement { is_first: true, ..at(0) }.take())
        .build()
        .map_err(|error| AppError::Environment(format!("cannot start a thread: {error}")))?;
    pool.install(|| {
        let mut live = ThreadedBody::start(LoopTimerConfig::default(), at(WORKER_NICENESS))?;
        let mut body =
            start_body(live.event_sender(), ThreadPlacement { core: outside, ..ThreadPlacement::default() })?;
        live.connect(&mut body);
        let before = thread_time().unwrap_or_default();
        let result = run_on_body(setup, &mut live, recorder, log, front_end);
        let control = thread_time().unwrap_or_default().saturating_sub(before);
        let body = body.stop();
        let run = result?;
        let report = live.report(&run, control, body?);
        Ok((run, report))
    })
}
