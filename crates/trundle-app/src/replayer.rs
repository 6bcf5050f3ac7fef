//! A recording as the robot's body: each event and each job's result at its place in the recording.

use crate::encoded_body::{EncodedBody, RunInput};
use crate::run_mark::{RunMark, RunMarkMessage};
use crate::{AppError, RecordingContent, RunSetup};
use std::collections::BTreeMap;
use std::path::Path;
use trundle_core::{Stamp, Twist2};
use trundle_io::{RecordedMessage, RecordingReader};
use trundle_runtime::{Answer, Job, Worker};

/// A recording as a body. Each job runs at the mark at which its result was applied.
pub struct RunReplayer {
    reader: RecordingReader,
    jobs: BTreeMap<Worker, Job>,
    contacts: Option<u32>,
    /// Stamps of the first and the newest event.
    span: Option<(Stamp, Stamp)>,
}

impl RunReplayer {
    /// Opens a recording of a run; returns the replayer and the recorded setup.
    ///
    /// # Errors
    /// When the file is not a recording of a run, or its robot is invalid. Names the file.
    pub fn open(file: &Path) -> Result<(Self, RunSetup), AppError> {
        Self::of(file, RecordingReader::open(file)?)
    }

    /// Opens a recording that may be cut at any byte: it is replayed up to the cut.
    ///
    /// # Errors
    /// As [`RunReplayer::open`], and when no event precedes the cut.
    pub fn open_to_cut(file: &Path) -> Result<(Self, RunSetup), AppError> {
        Self::of(file, RecordingReader::open_to_cut(file)?)
    }

    /// Whether a file has the recorded setup of a run, whichever program wrote the file.
    #[must_use]
    pub fn is_run(file: &Path) -> bool {
        RecordingReader::open_to_cut(file).is_ok_and(|reader| reader.config().is_some())
    }

    fn of(file: &Path, reader: RecordingReader) -> Result<(Self, RunSetup), AppError> {
        let name = file.display();
        let config = reader.config().ok_or_else(|| {
            AppError::Input(format!(
                "{name}: no trundle.Config message comes first: this is not a recording of a trundle run, or the disk was full when the run began"
            ))
        })?;
        let setup = RunSetup::of_recording(file, config.clone())?;
        if !setup.recording.is_all() {
            return Err(AppError::Input(format!("{name}: {}", RecordingContent::NO_IMAGES)));
        }
        if let Some(from) = setup.recorded_from_s {
            return Err(AppError::Input(format!(
                "{name}: the recording begins {from:.1} s after the start of its run, expected one from the start: `recording.mcap` of a run with --record all"
            )));
        }
        Ok((Self { reader, jobs: BTreeMap::new(), contacts: None, span: None }, setup))
    }

    /// Position of the cut and the share of events fed so far, in one sentence; `None` for a complete recording.
    #[must_use]
    pub fn cut_report(&self) -> Option<String> {
        let cut = self.reader.cut()?;
        Some(cut.report(self.span.map_or(0.0, |(first, last)| last - first)))
    }

    /// Reads the rest of the recording, which the run does not use.
    ///
    /// # Errors
    /// When the rest is broken.
    pub fn read_to_end(&mut self) -> Result<(), AppError> {
        while self.reader.next_message()?.is_some() {}
        Ok(())
    }

    fn read_mark(value: serde_json::Value) -> Result<RunMark, AppError> {
        let message: RunMarkMessage = serde_json::from_value(value)
            .map_err(|error| AppError::Input(format!("message on {}: {error}", RunMark::TOPIC)))?;
        Ok(message.mark)
    }

    /// The result of the worker's job, which runs now.
    fn run_job(&mut self, worker: Worker) -> Result<Option<RunInput>, AppError> {
        let answer = self.finish_job(worker).ok_or_else(|| {
            AppError::Input(format!("message on {}: {worker:?} has nothing to do here", RunMark::TOPIC))
        })?;
        Ok(Some(RunInput::Answer(answer)))
    }

    fn read_input(&mut self) -> Result<Option<RunInput>, AppError> {
        loop {
            match self.reader.next_message()? {
                Some(RecordedMessage::Event(event)) => {
                    let first = self.span.map_or(event.stamp(), |(first, _)| first);
                    self.span = Some((first, event.stamp()));
                    return Ok(Some(RunInput::Event(event)));
                }
                Some(RecordedMessage::Json { schema, value, .. }) if schema == RunMark::SCHEMA => {
                    match Self::read_mark(value)? {
                        RunMark::Contacts(count) => self.contacts = Some(count),
                        RunMark::Applied(worker) => return self.run_job(worker),
                        RunMark::Operator(request) => return Ok(Some(RunInput::Operator(request))),
                        RunMark::Interrupted => return Ok(Some(RunInput::Interrupted)),
                        RunMark::End => return Ok(None),
                    }
                }
                Some(RecordedMessage::Json { .. }) => {}
                None => return Ok(None),
            }
        }
    }
}

impl EncodedBody for RunReplayer {
    fn next_input(&mut self) -> Result<Option<RunInput>, AppError> {
        self.read_input()
    }

    /// A recorded body does not move.
    fn send_command(&mut self, _twist: Twist2) -> Result<(), AppError> {
        Ok(())
    }

    fn start_job(&mut self, job: Job) {
        self.jobs.insert(job.worker(), job);
    }

    fn finish_job(&mut self, worker: Worker) -> Option<Answer> {
        self.jobs.remove(&worker).map(Job::run)
    }

    fn true_contacts(&self) -> Option<u32> {
        self.contacts
    }

    fn fraction_read(&self) -> Option<f64> {
        Some(self.reader.progress())
    }
}
