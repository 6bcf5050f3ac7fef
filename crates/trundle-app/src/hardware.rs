//! The hardware of a run: base and camera as one body, and the check of both before the first drive.

mod check;
mod check_log;
mod device_list;
mod drivers;
mod state_signals;

pub use check::{CheckRequest, HardwareReport, check_hardware};
pub use device_list::{device_rows, udev_rules};
pub use drivers::{Drivers, GyroOrigin, IntrinsicsSource, OpenCamera};

use crate::real_time::{EventFeed, EventObserver, LiveBody, TimedEvent};
use crate::{AppError, DisplayedState};
use state_signals::StateSignals;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;
use trundle_core::{PinholeCamera, SensorEvent};
use trundle_drivers::BaseSpec;
use trundle_runtime::real_time::InboxSender;

/// Waits for the end of standard input, then stops the base at the port given as standard output. This process guards a program that may
/// crash.
///
/// # Errors
/// When the port accepts no data, for example after the base was unplugged.
#[cfg(unix)]
pub fn guard_base() -> Result<(), AppError> {
    trundle_drivers::kobuki::base_guard::guard_base(std::io::stdin().lock(), std::io::stdout())
        .map_err(|error| AppError::Environment(format!("the base cannot be stopped: {error}")))
}

/// Elsewhere no serial port can be guarded.
#[cfg(not(unix))]
pub fn guard_base() -> Result<(), AppError> {
    Err(AppError::Environment(
        "no serial port can be guarded on this system, expected Linux or macOS".to_owned(),
    ))
}

/// Starts base and camera as the body of a run; `output` is the camera model used by the robot. Events go to `events`, their stamps count
/// from `origin`. `observer` is called with each event.
///
/// # Errors
/// When the base does not answer, or the system refuses a thread.
pub fn start_hardware(
    base: &BaseSpec,
    camera: OpenCamera,
    output: PinholeCamera,
    events: InboxSender<TimedEvent>,
    origin: Instant,
    observer: Option<EventObserver>,
) -> Result<LiveBody, AppError> {
    let feed = EventFeed::new(events, origin);
    let sink = feed.clone();
    let send = move |event: SensorEvent| {
        sink.send(&event);
        observer.iter().for_each(|observer| observer(&event));
    };
    let drivers = Drivers::start(base, camera, output, origin, send)?;
    let commands = drivers.commands();
    let signals = Arc::new(Mutex::new(StateSignals::new(drivers.accessories())));
    let shown = Arc::clone(&signals);
    let stop = move || {
        locked(&signals).end();
        drivers.report()
    };
    let body = LiveBody::start(feed, Some(commands), stop)?;
    Ok(body.with_state_display(Box::new(move |run: &DisplayedState<'_>| locked(&shown).show(run))))
}

fn locked(signals: &Mutex<StateSignals>) -> MutexGuard<'_, StateSignals> {
    signals.lock().unwrap_or_else(PoisonError::into_inner)
}
