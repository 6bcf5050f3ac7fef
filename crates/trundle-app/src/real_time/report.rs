//! Timing of a run in real time: jitter, load, queues, memory.

use super::{BodyTiming, MemoryUsage};
use serde::Serialize;
use trundle_runtime::Histogram;
use trundle_runtime::real_time::LoopTimerReport;

/// Half of a run above which the growth of memory is shown \[s\]: 5 minutes. A shorter run is still filling its maps. Source: ours.
const MIN_MEMORY_HALF_S: f64 = 300.0;

/// Timing of a run in real time.
#[derive(Debug, Clone, Serialize)]
pub struct RealTimeReport {
    /// The control loop.
    pub control: Option<LoopTimerReport>,
    /// Processor time of the robot's threads, as parts of its core.
    pub load: Vec<ThreadLoad>,
    /// Sum of the loads.
    pub load_total: f64,
    /// Lengths of the queues.
    pub queues: Vec<QueueLength>,
    /// Events refused because the control thread's inbox was full.
    pub refused: u64,
    /// Lines of the recording left out because the disk could not follow: it ends before the first.
    pub lines_lost: u64,
    /// Timing of the body.
    #[serde(rename = "world")]
    pub body: BodyTiming,
    /// Resident memory of the whole program.
    pub memory: MemoryUsage,
    /// Whether the user ended the run.
    pub interrupted: bool,
}

/// A thread's share of a core.
#[derive(Debug, Clone, Serialize)]
pub struct ThreadLoad {
    /// The thread.
    pub thread: String,
    /// 0 to 1.
    pub part: f64,
}

/// Length of a queue.
#[derive(Debug, Clone, Serialize)]
pub struct QueueLength {
    /// The queue's name.
    pub queue: String,
    /// Median.
    pub median: f64,
    /// 99th percentile.
    pub p99: f64,
    /// Maximum.
    #[serde(rename = "most")]
    pub max: f64,
}

impl QueueLength {
    pub(super) fn of(queue: &str, lengths: &Histogram) -> Option<Self> {
        // A histogram has no bin for zero: a value below 1 is zero.
        let whole = |fraction| Some(lengths.quantile(fraction)?.round());
        let (median, p99) = (whole(0.5)?, whole(0.99)?);
        Some(Self { queue: queue.to_owned(), median, p99, max: lengths.max()? })
    }
}

impl RealTimeReport {
    /// For the terminal.
    pub fn rows(&self) -> Vec<Vec<String>> {
        let row = |name: String, value: String| vec![name, value];
        let mut rows = Vec::new();
        if let Some(control) = &self.control {
            let jitter = [
                control.jitter_median_ms,
                control.jitter_p99_ms,
                control.jitter_p999_ms,
                control.jitter_most_ms,
            ];
            rows.push(row("control jitter: median, p99, p99.9, max".to_owned(), milliseconds(&jitter)));
            let response = [control.response_median_ms, control.response_p999_ms, control.response_most_ms];
            rows.push(row("reading to command: median, p99.9, max".to_owned(), milliseconds(&response)));
            rows.push(row("missed deadlines".to_owned(), control.missed_deadlines.to_string()));
        }
        let part = |part: f64| format!("{:.1} %", part * 100.0);
        rows.extend(self.load.iter().map(|load| row(format!("load of {}", load.thread), part(load.part))));
        rows.push(row("load of all".to_owned(), part(self.load_total)));
        for QueueLength { queue, median, p99, max } in &self.queues {
            let lengths = format!("{median}, {p99}, {max}");
            rows.push(row(format!("waiting for {queue}: median, p99, max"), lengths));
        }
        rows.push(row("events refused".to_owned(), self.refused.to_string()));
        rows.push(row("lines of the recording lost".to_owned(), self.lines_lost.to_string()));
        let body = &self.body;
        if let Some(late) = body.lateness {
            let late = [late.p999_ms, late.max_ms];
            rows.push(row("simulated base late: p99.9, max".to_owned(), milliseconds(&late)));
        }
        let age = [body.image_age_median_ms, body.image_age_p99_ms];
        rows.push(row("age of images on arrival: median, p99".to_owned(), milliseconds(&age)));
        let images = format!("{} of {}", body.images_not_taken, body.images);
        rows.push(row("images not taken".to_owned(), images));
        let order = &body.order;
        let order = format!("{}, {}", order.reordered, order.late);
        rows.push(row("events put in order, too late".to_owned(), order));
        rows.extend(body.devices.rows());
        let half = self.memory.samples.last().map_or(0.0, |(time, _)| time / 2.0);
        if let Some(growth) = self.memory.growth_mb_an_hour(half).filter(|_| half >= MIN_MEMORY_HALF_S) {
            rows.push(row("growth of memory in the second half".to_owned(), format!("{growth:.1} MB/h")));
        }
        rows
    }
}

fn milliseconds(values: &[f64]) -> String {
    values.iter().map(|ms| format!("{ms:.2}")).collect::<Vec<_>>().join(", ") + " ms"
}
