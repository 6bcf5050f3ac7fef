//! The user's request to stop, by Ctrl-C or SIGTERM: one for the whole process, which every long loop reads.

use crate::AppError;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;
use trundle_io::OutputFolder;

/// Period at which a waiting loop checks for the user's interrupt. Source: ours.
pub const POLL_PERIOD: Duration = Duration::from_millis(50);
/// The number of the first signal; 0 without one.
static SIGNAL: AtomicUsize = AtomicUsize::new(0);
/// Progress at the end of a loop that the signal ended; `None` without one.
static STOPPED_AFTER: Mutex<Option<String>> = Mutex::new(None);

/// A signal that requests the end of the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StopSignal(usize);

/// Number of the signal of a terminal that is closed. Source: POSIX, `kill`.
const SIGHUP_NUMBER: usize = 1;
/// Number of the signal of Ctrl-C. Source: POSIX, `kill`.
const SIGINT_NUMBER: usize = 2;
/// Exit code of a program that a signal has ended, less the signal's number. Source: POSIX shells.
const SIGNAL_EXIT_CODE: u8 = 128;

impl StopSignal {
    #[cfg(unix)]
    fn of(number: i32) -> Self {
        Self(usize::try_from(number).unwrap_or_default())
    }

    /// The exit code: 130 for Ctrl-C, 143 for SIGTERM, 129 for a closed terminal.
    #[must_use]
    pub fn exit_code(self) -> u8 {
        SIGNAL_EXIT_CODE + u8::try_from(self.0).unwrap_or_default()
    }

    /// Name of the signal, for a person.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self.0 {
            SIGINT_NUMBER => "Ctrl-C",
            SIGHUP_NUMBER => "SIGHUP (the terminal was closed)",
            _ => "SIGTERM",
        }
    }
}

/// Whether the user interrupted: the calling loop ends then. `done`: the finished work, as "3 of 7 frames".
pub fn is_requested(done: impl FnOnce() -> String) -> bool {
    if SIGNAL.load(Ordering::Relaxed) == 0 {
        return false;
    }
    STOPPED_AFTER.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_with(done);
    true
}

/// The signal and the finished work, if a signal ended a loop.
#[must_use]
pub fn stopped() -> Option<(StopSignal, String)> {
    let done = STOPPED_AFTER.lock().unwrap_or_else(PoisonError::into_inner).clone()?;
    Some((received()?, done))
}

/// The signal and the finished work at the end of the program. A signal after the last loop counts too: it also ends the script that called
/// the program.
#[must_use]
pub fn ended() -> Option<(StopSignal, String)> {
    stopped().or_else(|| Some((received()?, "the end of its work".to_owned())))
}

fn received() -> Option<StopSignal> {
    Some(SIGNAL.load(Ordering::Relaxed)).filter(|number| *number != 0).map(StopSignal)
}

/// Notes in the summary of `folder` that the user ended the work, if a signal has.
///
/// # Errors
/// When the summary cannot be read or written.
pub fn note_in(folder: &OutputFolder) -> Result<(), AppError> {
    let file = folder.staged("summary.json");
    if stopped().is_none() || !file.exists() {
        return Ok(());
    }
    let mut summary = read_json(&file)?;
    summary["interrupted"] = true.into();
    summary["success"] = false.into();
    Ok(folder.write("summary.json", format!("{summary:#}\n").as_bytes())?)
}

fn read_json(file: &Path) -> Result<serde_json::Value, AppError> {
    let bytes = std::fs::read(file).map_err(AppError::input)?;
    serde_json::from_slice(&bytes).map_err(AppError::input)
}

/// Handles Ctrl-C, SIGTERM and a closed terminal as interrupts, which the loops of the running command read. The second signal ends the
/// program after `abandon`, which removes its unfinished results. The third signal ends the program in the signal's handler, in case
/// `abandon` hangs.
///
/// # Errors
/// When the system refuses.
#[cfg(unix)]
pub fn listen(abandon: impl Fn(StopSignal) + Send + 'static) -> Result<(), AppError> {
    use signal_hook::flag::register_conditional_shutdown;
    use std::sync::Arc;
    use std::sync::atomic::AtomicBool;
    let is_ending = Arc::<AtomicBool>::default();
    for signal in ending_signals() {
        let code = i32::from(StopSignal::of(signal).exit_code());
        register_conditional_shutdown(signal, code, Arc::clone(&is_ending)).map_err(refused)?;
    }
    on_signal(move |signal| {
        let first = SIGNAL.compare_exchange(0, signal.0, Ordering::Relaxed, Ordering::Relaxed);
        if first.is_err() {
            is_ending.store(true, Ordering::Relaxed);
            let _exit = ExitOnDrop(signal);
            abandon(signal);
        }
    })
}

/// Makes a write beyond the limit of a file's size (`ulimit -f`) an error of the write. Without this, the system ends the program and the
/// results so far are lost.
///
/// # Errors
/// When the system refuses.
#[cfg(unix)]
pub fn survive_file_limits() -> Result<(), AppError> {
    let signal = signal_hook::consts::SIGXFSZ;
    signal_hook::flag::register(signal, std::sync::Arc::default()).map_err(refused)?;
    Ok(())
}

/// Ignores the signals that request the end of a program.
///
/// # Errors
/// When the system refuses.
#[cfg(unix)]
pub fn ignore() -> Result<(), AppError> {
    on_signal(|_| {})
}

/// The signals that request the end of this program. A program started by `nohup` ignores the loss of its terminal.
#[cfg(unix)]
fn ending_signals() -> Vec<i32> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    if ignores_closed_terminal(&status) { vec![SIGINT, SIGTERM] } else { vec![SIGINT, SIGTERM, SIGHUP] }
}

/// Whether the status of a process (the form of Linux's /proc) shows that SIGHUP is ignored.
#[cfg(unix)]
fn ignores_closed_terminal(status: &str) -> bool {
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (SIGHUP_NUMBER - 1) & 1 == 1)
}

/// Ends the program at Ctrl-C or SIGTERM if `prepare` returns true: for commands that write nothing before their end. If `prepare` returns
/// false, the program is ending already and continues to its end.
///
/// # Errors
/// When the system refuses.
#[cfg(unix)]
pub fn end_at_once(prepare: impl Fn(StopSignal) -> bool + Send + 'static) -> Result<(), AppError> {
    on_signal(move |signal| {
        let exit = ExitOnDrop(signal);
        if !prepare(signal) {
            std::mem::forget(exit);
        }
    })
}

/// Ends the process on drop, also during a panic: the lock of abandoned results is never released.
#[cfg(unix)]
struct ExitOnDrop(StopSignal);

#[cfg(unix)]
impl Drop for ExitOnDrop {
    fn drop(&mut self) {
        signal_hook::low_level::exit(i32::from(self.0.exit_code()));
    }
}

#[cfg(unix)]
fn on_signal(act: impl Fn(StopSignal) + Send + 'static) -> Result<(), AppError> {
    let mut signals = signal_hook::iterator::Signals::new(ending_signals()).map_err(refused)?;
    let wait = move || signals.forever().for_each(|signal| act(StopSignal::of(signal)));
    std::thread::Builder::new().name("signals".to_owned()).spawn(wait).map_err(refused)?;
    Ok(())
}

#[cfg(unix)]
fn refused(error: std::io::Error) -> AppError {
    AppError::Environment(format!("cannot listen for signals: {error}"))
}

/// On other systems Ctrl-C ends the program immediately.
#[cfg(not(unix))]
pub fn listen(_abandon: impl Fn(StopSignal) + Send + 'static) -> Result<(), AppError> {
    Ok(())
}

/// Other systems have no such signal.
#[cfg(not(unix))]
pub fn survive_file_limits() -> Result<(), AppError> {
    Ok(())
}

/// Elsewhere no signal is ignored.
#[cfg(not(unix))]
pub fn ignore() -> Result<(), AppError> {
    Ok(())
}

/// On other systems Ctrl-C ends the program immediately.
#[cfg(not(unix))]
pub fn end_at_once(_prepare: impl Fn(StopSignal) -> bool + Send + 'static) -> Result<(), AppError> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exit_codes_and_names_are_those_of_shells() {
        let [interrupt, terminate] = [2, 15].map(StopSignal);
        assert_eq!((interrupt.exit_code(), interrupt.name()), (130, "Ctrl-C"));
        assert_eq!((terminate.exit_code(), terminate.name()), (143, "SIGTERM"));
        assert_eq!(StopSignal(1).exit_code(), 129);
    }

    #[test]
    fn a_program_under_nohup_goes_on_without_its_terminal() {
        assert!(ignores_closed_terminal("Name:\ttrundle\nSigIgn:\t0000000000001001\n"));
        assert!(!ignores_closed_terminal("Name:\ttrundle\nSigIgn:\t0000000000001000\n"));
        assert!(!ignores_closed_terminal(""));
    }

    #[test]
    fn without_a_signal_nothing_stops() {
        assert!(!is_requested(|| unreachable!("no signal has come")));
        assert_eq!(stopped(), None);
    }
}
