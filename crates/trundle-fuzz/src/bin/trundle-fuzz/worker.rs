//! Runs one target on many inputs.

use crate::coverage::Coverage;
use crate::current_input::CurrentInput;
use crate::mutation::mutate;
use crate::{MEMORY, finding, watchdog};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook};
use std::path::Path;
use std::sync::Mutex;
use std::time::{Duration, Instant};
use trundle_fuzz::FuzzTarget;
use trundle_fuzz::corpus::{committed_inputs, inputs_below};

/// Folder of further inputs, relative to the workspace. Skipped if absent.
const CASES: &str = "../shared/cases";

/// The place and the message of the last panic.
static LAST_PANIC: Mutex<String> = Mutex::new(String::new());

/// Runs `target` for some time. Returns whether no fault was found. A panic is reported and the run continues.
pub fn run(target: &FuzzTarget, time: Duration, seed: u64, folder: &Path) -> Result<bool, String> {
    watchdog::start();
    record_panics();
    let mut work = Work::new(target, seed, folder)?;
    let end = Instant::now() + time;
    for input in work.inputs.clone() {
        work.read(&input)?;
    }
    while Instant::now() < end {
        let input = work.next_input();
        if work.read(&input)? {
            work.inputs.push(input);
        }
    }
    let (inputs, edges) = (work.inputs.len(), work.coverage.edges());
    let guided = if edges > 0 { format!(", {inputs} kept, {edges} edges") } else { String::new() };
    println!("{}: {} inputs{guided}", target.name, work.count);
    Ok(work.found.is_empty())
}

/// Runs `target` on one file, with the panic's own message.
pub fn reproduce(target: &FuzzTarget, file: &Path) -> Result<bool, String> {
    let input = std::fs::read(file).map_err(|error| format!("{}: {error}", file.display()))?;
    watchdog::start();
    watchdog::begin();
    let start = MEMORY.start();
    (target.run)(&input);
    let (peak, limit) = (MEMORY.peak_above(start), target.memory_limit(input.len()));
    println!("{}: {} bytes read, peak memory {peak} bytes, limit {limit} bytes", target.name, input.len());
    Ok(peak <= limit)
}

struct Work<'a> {
    target: &'a FuzzTarget,
    rng: ChaCha8Rng,
    inputs: Vec<Vec<u8>>,
    coverage: Coverage,
    current: CurrentInput,
    count: u64,
    /// The reported text.
    found: BTreeSet<String>,
}

impl<'a> Work<'a> {
    fn new(target: &'a FuzzTarget, seed: u64, folder: &Path) -> Result<Self, String> {
        let mut inputs = committed_inputs(target);
        inputs.extend(inputs_below(Path::new(CASES), target));
        Ok(Self {
            target,
            rng: ChaCha8Rng::seed_from_u64(seed),
            inputs,
            coverage: Coverage::new(),
            current: CurrentInput::create(folder)?,
            count: 0,
            found: BTreeSet::new(),
        })
    }

    fn next_input(&mut self) -> Vec<u8> {
        let mut any = || self.rng.random_range(0..self.inputs.len());
        let (parent, other) = (any(), any());
        mutate(&self.inputs[parent], &self.inputs[other], self.target.words, &mut self.rng)
    }

    /// Reads an input. Returns whether it reached new code.
    fn read(&mut self, input: &[u8]) -> Result<bool, String> {
        self.count += 1;
        self.current.set(input)?;
        self.coverage.reset();
        let start = MEMORY.start();
        watchdog::begin();
        let is_panic = catch_unwind(AssertUnwindSafe(|| (self.target.run)(input))).is_err();
        watchdog::end();
        let (peak, limit) = (MEMORY.peak_above(start), self.target.memory_limit(input.len()));
        if is_panic {
            let panic = LAST_PANIC.lock().map(|text| text.clone()).unwrap_or_default();
            self.report(input, &panic, &format!("panic: {panic}"))?;
        } else if peak > limit {
            self.report(input, "memory", &format!("memory of {peak} bytes, at most {limit} expected"))?;
        }
        Ok(!is_panic && self.coverage.is_new())
    }

    /// Reports a finding of each kind once.
    fn report(&mut self, input: &[u8], kind: &str, what: &str) -> Result<(), String> {
        let place = kind.split(": ").next().unwrap_or(kind);
        if self.found.insert(place.to_owned()) { finding::report(self.target, input, what) } else { Ok(()) }
    }
}

/// Stores the message of a panic instead of printing it.
fn record_panics() {
    set_hook(Box::new(|panic| {
        let place = panic.location().map(ToString::to_string).unwrap_or_default();
        let message = panic.payload_as_str().unwrap_or("no message");
        if let Ok(mut last) = LAST_PANIC.lock() {
            *last = format!("{place}: {message}");
        }
    }));
}
