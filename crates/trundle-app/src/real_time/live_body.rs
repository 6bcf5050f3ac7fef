//! A body of drivers with their own threads: base, camera, laser.

use super::{BackgroundBody, BodyTiming, DeviceReport, EventFeed};
use crate::{AppError, StateDisplay};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;
use trundle_core::Twist2;

/// Time between two checks for silence: a tenth of the silence that is reported. Source: ours.
const SILENCE_CHECK_PERIOD: Duration = Duration::from_millis(10);
/// Time between two checks for events whose wait is over: a tenth of the period of a base. Source: ours.
const ORDER_CHECK_PERIOD: Duration = Duration::from_millis(2);

/// A body of drivers: their events come by an [`EventFeed`], the base takes commands from a channel.
pub struct LiveBody {
    commands: Sender<Twist2>,
    feed: EventFeed,
    is_over: Arc<AtomicBool>,
    watch: JoinHandle<()>,
    stop_drivers: Box<dyn FnOnce() -> DeviceReport + Send>,
    state_display: Option<StateDisplay>,
}

impl LiveBody {
    /// The body whose drivers send events to `feed`. `commands` leads to the base; without a base, commands have no effect.
    /// `stop_drivers` is called at the end of the run: it stops the base, joins the drivers' threads and gives their report.
    ///
    /// # Errors
    /// When the system refuses a thread.
    pub fn start(
        feed: EventFeed,
        commands: Option<Sender<Twist2>>,
        stop_drivers: impl FnOnce() -> DeviceReport + Send + 'static,
    ) -> Result<Self, AppError> {
        let is_over = Arc::<AtomicBool>::default();
        let (watched, over) = (feed.clone(), Arc::clone(&is_over));
        let watch = move || {
            let mut period = SILENCE_CHECK_PERIOD;
            while !over.load(Ordering::Relaxed) {
                std::thread::sleep(period);
                period = if watched.hand_on_due() { ORDER_CHECK_PERIOD } else { SILENCE_CHECK_PERIOD };
                watched.report_silence();
            }
        };
        let watch = std::thread::Builder::new()
            .name("silence".to_owned())
            .spawn(watch)
            .map_err(|error| AppError::Environment(format!("cannot start a thread: {error}")))?;
        let commands = commands.unwrap_or_else(|| channel().0);
        let stop_drivers = Box::new(stop_drivers);
        Ok(Self { commands, feed, is_over, watch, stop_drivers, state_display: None })
    }

    /// The body with lights and sounds that show the state of the run.
    #[must_use]
    pub fn with_state_display(self, display: StateDisplay) -> Self {
        Self { state_display: Some(display), ..self }
    }
}

impl BackgroundBody for LiveBody {
    fn commands(&self) -> Sender<Twist2> {
        self.commands.clone()
    }

    fn contacts(&self) -> Option<Arc<AtomicU32>> {
        None
    }

    fn state_display(&mut self) -> Option<StateDisplay> {
        self.state_display.take()
    }

    fn stop(self) -> Result<BodyTiming, AppError> {
        self.is_over.store(true, Ordering::Relaxed);
        let devices = (self.stop_drivers)();
        let gone = |_| AppError::Environment("the thread that watches for silence has died".to_owned());
        self.watch.join().map_err(gone)?;
        Ok(BodyTiming { devices, ..self.feed.timing() })
    }
}
