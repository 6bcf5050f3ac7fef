//! The log of a program: lines on standard error, and the lines that an output folder keeps.

use crate::AppError;
use std::fmt;
use std::io::{self, Write};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use tracing::{Event, Level, Subscriber};
use tracing_subscriber::EnvFilter;
use tracing_subscriber::fmt::format::Writer;
use tracing_subscriber::fmt::{FmtContext, FormatEvent, FormatFields};
use tracing_subscriber::layer::{Layer, SubscriberExt};
use tracing_subscriber::registry::LookupSpan;

/// The environment variable that filters the log on standard error, as `trundle_runtime=debug`.
const FILTER_VARIABLE: &str = "TRUNDLE_LOG";
/// Content of the lines that an output folder keeps.
const FILE_FILTER: &str = "trundle=info,trundle_app=info,trundle_runtime=info,trundle_experiments=info";

/// The lines for output folders, from the start of the program on.
static LINES: OnceLock<Arc<Mutex<Vec<u8>>>> = OnceLock::new();

/// Starts the log. `verbosity`: 0 warnings, 1 state changes and corrections, 2 everything. At 0, the variable `TRUNDLE_LOG` may set another
/// filter.
///
/// # Errors
/// When `TRUNDLE_LOG` is not a filter.
pub fn start_log(verbosity: u8) -> Result<(), AppError> {
    let filter = stderr_filter(verbosity)?;
    let lines = Arc::clone(LINES.get_or_init(Arc::default));
    // A standard error without a reader is not an error of the run. By default, tracing would print such an error there, and panic.
    let terminal = tracing_subscriber::fmt::layer()
        .event_format(PlainLine("trundle: "))
        .with_writer(io::stderr)
        .log_internal_errors(false);
    let file = tracing_subscriber::fmt::layer()
        .event_format(PlainLine(""))
        .with_writer(move || LogBuffer(Arc::clone(&lines)));
    let subscriber = tracing_subscriber::registry()
        .with(terminal.with_filter(filter))
        .with(file.with_filter(EnvFilter::new(FILE_FILTER)));
    // A second start, as in a test, keeps the first log.
    let _ = tracing::subscriber::set_global_default(subscriber);
    Ok(())
}

/// The lines of the log so far, for `log.txt` of an output folder: with the data's time, without the wall clock.
#[must_use]
pub fn log_lines() -> Vec<u8> {
    LINES.get_or_init(Arc::default).lock().unwrap_or_else(PoisonError::into_inner).clone()
}

fn stderr_filter(verbosity: u8) -> Result<EnvFilter, AppError> {
    let level = ["warn", "info", "debug"][usize::from(verbosity.min(2))];
    match std::env::var(FILTER_VARIABLE) {
        Ok(text) if verbosity == 0 => EnvFilter::try_new(&text).map_err(|error| {
            AppError::Input(format!(
                "{FILTER_VARIABLE} is '{text}', expected a filter as trundle_runtime=debug: {error}"
            ))
        }),
        _ => Ok(EnvFilter::new(format!(
            "warn,trundle={level},trundle_app={level},trundle_runtime={level},trundle_slam={level},trundle_experiments={level}"
        ))),
    }
}

/// Appends lines to a buffer in memory.
struct LogBuffer(Arc<Mutex<Vec<u8>>>);

impl Write for LogBuffer {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A line of the log: prefix, level, message and fields; no wall clock.
struct PlainLine(&'static str);

impl<S, N> FormatEvent<S, N> for PlainLine
where
    S: Subscriber + for<'a> LookupSpan<'a>,
    N: for<'a> FormatFields<'a> + 'static,
{
    fn format_event(
        &self,
        context: &FmtContext<'_, S, N>,
        mut writer: Writer<'_>,
        event: &Event<'_>,
    ) -> fmt::Result {
        write!(writer, "{}{}: ", self.0, name_of(*event.metadata().level()))?;
        context.field_format().format_fields(writer.by_ref(), event)?;
        writer.write_char('\n')
    }
}

fn name_of(level: Level) -> &'static str {
    match level {
        Level::ERROR => "error",
        Level::WARN => "warning",
        Level::INFO => "info",
        _ => "debug",
    }
}
