//! A run by the clock on the wall: the simulator in two threads on one core, the robot on another.
//!
//! | thread | core | what it does |
//! |---|---|---|
//! | base | simulator's | dynamics at 1 kHz, wheels, gyro, bumper; takes commands |
//! | camera | simulator's | draws and encodes images |
//! | control | robot's | the robot's steps |
//! | lookout, captain | robot's | the robot's long work |
//! | recorder | robot's | the recording |

mod interrupt;
mod live_body;
mod memory;
mod world;

use crate::run::{Run, RunSetup, drive};
use crate::{failure::Failure, logbook::Logbook, tape::Tape};
use live_body::LiveBody;
use memory::MemoryCurve;
use rayon::ThreadPoolBuilder;
use serde::Serialize;
use std::path::Path;
use trundle::io::OutputFolder;
use trundle::runtime::Histogram;
use trundle::runtime::real_time::{Place, PulseConfig, PulseReport, thread_time};
use trundle::sim::Simulator;
use world::{World, WorldReport};

/// Images a second.
pub const CAMERA_HZ: f64 = 30.0;
/// The base stops by itself when it had no command for so long, s.
pub const COMMAND_TIMEOUT: f64 = 0.2;
/// So much nicer than control are the helpers, and the recorder.
const NICER: (i32, i32) = (5, 10);

/// How a run kept time.
#[derive(Debug, Clone, Serialize)]
pub struct Timing {
    /// The control loop.
    pub control: Option<PulseReport>,
    /// Processor time of the robot's threads, as parts of its core.
    pub load: Vec<Load>,
    /// All of them.
    pub load_total: f64,
    /// What waited where.
    pub queues: Vec<QueueLength>,
    /// Events that the control thread was too slow to get.
    pub refused: u64,
    /// Lines of the recording left out because the disk could not follow: it ends before the first.
    pub lines_lost: u64,
    /// The simulator's own trouble.
    pub world: WorldReport,
    /// Resident memory of the whole program.
    pub memory: MemoryCurve,
    /// Whether the user ended the run.
    pub interrupted: bool,
}

/// A thread's part of a core.
#[derive(Debug, Clone, Serialize)]
pub struct Load {
    /// The thread.
    pub thread: String,
    /// 0 to 1.
    pub part: f64,
}

/// How many things wait in a queue.
#[derive(Debug, Clone, Serialize)]
pub struct QueueLength {
    /// Which.
    pub queue: String,
    /// Median.
    pub median: f64,
    /// 99 of 100 times at most.
    pub p99: f64,
    /// The most.
    pub most: f64,
}

impl QueueLength {
    fn of(queue: &str, lengths: &Histogram) -> Option<Self> {
        // A histogram has no zero: what is below 1 is none.
        let whole = |fraction| Some(lengths.quantile(fraction)?.round());
        let (median, p99) = (whole(0.5)?, whole(0.99)?);
        Some(Self { queue: queue.to_owned(), median, p99, most: lengths.most()? })
    }
}

/// Lets the robot of `setup` live beside `body` until its mission is over or the user interrupts; records everything.
///
/// # Errors
/// When the system refuses threads, or the recording cannot be written.
pub fn drive_live(
    setup: &RunSetup,
    body: Simulator,
    folder: &OutputFolder,
    memory: Option<&Path>,
    log: Logbook,
    quiet: bool,
) -> Result<(Run, Timing), Failure> {
    let stop = interrupt::flag()?;
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let (outside, inside) = if cores > 1 { (Some(0), Some(cores - 1)) } else { (None, None) };
    let at = move |nice| Place { core: inside, nice, is_first: false };
    let tape = Tape::aside(folder, at(NICER.1))?.keeping(memory)?;
    let pool = ThreadPoolBuilder::new()
        .num_threads(1)
        .thread_name(|_| "control".to_owned())
        .start_handler(move |_| _ = Place { is_first: true, ..at(0) }.take())
        .build()
        .map_err(|error| Failure::Environment(format!("cannot start a thread: {error}")))?;
    pool.install(|| {
        let mut live = LiveBody::start(PulseConfig::default(), at(NICER.0), stop)?;
        let world = World::start(body, live.door(), Place { core: outside, ..Place::default() })?;
        live.listen(world.commands(), world.contacts());
        let before = thread_time().unwrap_or_default();
        let result = drive(setup, &mut live, tape, log, quiet);
        let control = thread_time().unwrap_or_default().saturating_sub(before);
        let world = world.stop();
        let run = result?;
        let timing = live.timing(&run, control, world?);
        Ok((run, timing))
    })
}

impl Timing {
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
            rows.push(row("control jitter: median, p99, p99.9, most".to_owned(), milliseconds(&jitter)));
            let response = [control.response_median_ms, control.response_p999_ms, control.response_most_ms];
            rows.push(row("reading to command: median, p99.9, most".to_owned(), milliseconds(&response)));
            rows.push(row("missed deadlines".to_owned(), control.missed_deadlines.to_string()));
        }
        let part = |part: f64| format!("{:.1} %", part * 100.0);
        rows.extend(self.load.iter().map(|load| row(format!("load of {}", load.thread), part(load.part))));
        rows.push(row("load of all".to_owned(), part(self.load_total)));
        for QueueLength { queue, median, p99, most } in &self.queues {
            let lengths = format!("{median}, {p99}, {most}");
            rows.push(row(format!("waiting for {queue}: median, p99, most"), lengths));
        }
        rows.push(row("events refused".to_owned(), self.refused.to_string()));
        rows.push(row("lines of the recording lost".to_owned(), self.lines_lost.to_string()));
        let world = &self.world;
        let late = [world.lateness_p999_ms, world.lateness_most_ms];
        rows.push(row("simulated base late: p99.9, most".to_owned(), milliseconds(&late)));
        let age = [world.image_age_median_ms, world.image_age_p99_ms];
        rows.push(row("age of images on arrival: median, p99".to_owned(), milliseconds(&age)));
        let images = format!("{} of {}", world.images_not_taken, world.images);
        rows.push(row("images the simulator did not get drawn".to_owned(), images));
        let half = self.memory.samples.last().map_or(0.0, |(time, _)| time / 2.0);
        if let Some(growth) = self.memory.growth_mb_an_hour(half) {
            rows.push(row("growth of memory in the second half".to_owned(), format!("{growth:.1} MB/h")));
        }
        rows
    }
}

fn milliseconds(values: &[f64]) -> String {
    values.iter().map(|ms| format!("{ms:.2}")).collect::<Vec<_>>().join(", ") + " ms"
}
