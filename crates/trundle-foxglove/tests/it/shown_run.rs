//! A run of a base at rest in real time, shown in Foxglove.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;
use trundle_app::operator::{FrontEnd, Operator, OperatorLink, operator_link};
use trundle_app::{Progress, RunLog, RunRecorder, RunSetup, run_on_body};
use trundle_core::{RobotBody, SensorEvent, Stamp, Twist2, WheelTicks};
use trundle_foxglove::{FoxgloveOptions, FoxgloveServer};
use trundle_io::OutputFolder;
use trundle_runtime::{Mission, RobotConfig};

/// A base at rest: wheels at 50 Hz of real time, until the end.
struct PacedBody {
    step: i64,
    is_over: Arc<AtomicBool>,
}

impl RobotBody for PacedBody {
    type Error = io::Error;

    fn next_event(&mut self) -> io::Result<Option<SensorEvent>> {
        std::thread::sleep(Duration::from_millis(20));
        self.step += 1;
        let stamp = Stamp::from_nanos(self.step * 20_000_000);
        let wheels = SensorEvent::Wheels(WheelTicks { stamp, left: 0, right: 0 });
        Ok((!self.is_over.load(Ordering::Relaxed)).then_some(wheels))
    }

    fn command(&mut self, _twist: Twist2) -> io::Result<()> {
        Ok(())
    }
}

/// A server without a run, and the end of the link by which a test publishes views.
pub fn served() -> (FoxgloveServer, OperatorLink) {
    let (operator, link) = operator_link();
    let options = FoxgloveOptions::new("127.0.0.1:0".parse().unwrap(), "test".to_owned());
    (FoxgloveServer::start(options, operator).unwrap(), link)
}

/// A run that is shown in Foxglove. A drop ends the run.
pub struct ShownRun {
    pub server: FoxgloveServer,
    pub operator: Operator,
    is_over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    _place: tempfile::TempDir,
}

impl ShownRun {
    /// A run on loopback.
    pub fn start() -> Self {
        Self::with_options(|_| ())
    }

    /// A run with changed options of the server.
    pub fn with_options(change: impl FnOnce(&mut FoxgloveOptions)) -> Self {
        let place = tempfile::tempdir().unwrap();
        let setup = RunSetup::new("nowhere", Mission::default(), RobotConfig::default()).operated();
        let (operator, link) = operator_link();
        let mut options = FoxgloveOptions::new("127.0.0.1:0".parse().unwrap(), "run: nowhere".to_owned());
        change(&mut options);
        let server = FoxgloveServer::start(options, operator.clone()).unwrap();
        let is_over = Arc::<AtomicBool>::default();
        let mut body = PacedBody { step: 0, is_over: Arc::clone(&is_over) };
        let folder = OutputFolder::create(&place.path().join("run")).unwrap();
        let run = move || {
            let recorder = RunRecorder::to_folder(&folder).unwrap();
            let front_end = FrontEnd { progress: Progress::hidden(), operator: Some(link) };
            run_on_body(&setup, &mut body, recorder, RunLog::default(), front_end).unwrap();
        };
        let thread = Some(std::thread::spawn(run));
        Self { server, operator, is_over, thread, _place: place }
    }
}

impl Drop for ShownRun {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        self.thread.take().map(JoinHandle::join);
    }
}
