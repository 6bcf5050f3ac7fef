//! A run of a base at rest in real time, with its live page.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use trundle_app::operator::{FrontEnd, MapFolder, Operator, RunView, operator_link};
use trundle_app::{Progress, RunLog, RunRecorder, RunSetup, run_on_body};
use trundle_core::{RobotBody, SensorEvent, Stamp, Twist2, WheelTicks};
use trundle_io::OutputFolder;
use trundle_live::{Access, LiveOptions, LivePage, RunFacts, Tokens};
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

/// A run with its live page. A drop ends the run.
pub struct LiveRun {
    pub page: LivePage,
    pub operator: Operator,
    pub tokens: Tokens,
    is_over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    /// A folder; its maps may be loaded.
    pub place: tempfile::TempDir,
}

impl LiveRun {
    /// A run that takes commands.
    pub fn start() -> Self {
        Self::with_steering(true)
    }

    /// A run, steered or not.
    pub fn with_steering(is_steered: bool) -> Self {
        Self::with_options(is_steered, |_| ())
    }

    /// A run, steered or not, with changed options of its page.
    pub fn with_options(is_steered: bool, change: impl FnOnce(&mut LiveOptions)) -> Self {
        let place = tempfile::tempdir().unwrap();
        let setup = RunSetup::new("nowhere", Mission::default(), RobotConfig::default()).operated();
        let (operator, link) = operator_link();
        let tokens = Tokens::random().unwrap();
        let address = "127.0.0.1:0".parse().unwrap();
        let maps = Some(MapFolder::open(place.path().to_owned(), setup.robot.clone()).unwrap());
        let mut options = LiveOptions::new(address, tokens.clone(), is_steered, maps);
        change(&mut options);
        let page = LivePage::start(options, operator.clone(), RunFacts::of(&setup).unwrap()).unwrap();
        let is_over = Arc::<AtomicBool>::default();
        let mut body = PacedBody { step: 0, is_over: Arc::clone(&is_over) };
        let folder = OutputFolder::create(&place.path().join("run")).unwrap();
        let run = move || {
            let recorder = RunRecorder::to_folder(&folder).unwrap();
            let front_end = FrontEnd { progress: Progress::hidden(), operator: Some(link) };
            run_on_body(&setup, &mut body, recorder, RunLog::default(), front_end).unwrap();
        };
        let thread = Some(std::thread::spawn(run));
        Self { page, operator, tokens, is_over, thread, place }
    }

    /// The token of an access.
    pub fn token(&self, access: Access) -> &str {
        self.tokens.of(access)
    }

    /// The newest view, after the first step.
    pub fn view(&self) -> Arc<RunView> {
        self.operator.peek().unwrap()
    }

    /// Waits until the view satisfies `is`, at most 5 s.
    pub fn wait_for(&self, what: &str, is: impl Fn(&RunView) -> bool) {
        let start = Instant::now();
        while !self.operator.peek().is_some_and(|view| is(&view)) {
            let seen = self.operator.peek().map(|view| (view.state.clone(), view.hold, view.estimate.pose));
            assert!(start.elapsed() < Duration::from_secs(5), "{what}: {seen:?}");
            std::thread::sleep(Duration::from_millis(5));
        }
    }
}

impl Drop for LiveRun {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        self.thread.take().map(JoinHandle::join);
    }
}
