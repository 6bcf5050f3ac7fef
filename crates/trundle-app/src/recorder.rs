//! The recording of a run, written within the run's loop or by a separate thread.

use crate::{AppError, FreeSpace, RecordingContent, checkpoint_writer::CheckpointWriter};
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{SyncSender, TrySendError, sync_channel};
use std::thread::JoinHandle;
use std::time::Duration;
use trundle_io::{IoError, OutputFolder, Recorder};
use trundle_runtime::real_time::{ThreadPlacement, thread_time};
use trundle_runtime::{Checkpoint, Histogram};

/// A recording into a file.
pub type FileRecorder = Recorder<BufWriter<File>>;

type Line = Box<dyn FnOnce(&mut RecordingFile) + Send>;

/// Records a run into `recording.mcap`, within the run's loop or by a separate thread. With the thread a slow disk does not delay control.
/// Writes checkpoints as well, if their file is given.
pub struct RunRecorder {
    sink: Sink,
    /// Lines that wait for the disk, counted each time a line is written.
    pub queue_lengths: Histogram,
    /// Lines left out because the disk could not follow; the recording ends before the first.
    pub lines_lost: u64,
    checkpoints: Option<CheckpointWriter>,
}

enum Sink {
    Inline(Box<RecordingFile>),
    Threaded { lines: SyncSender<Line>, waiting: Arc<AtomicUsize>, thread: Writer },
}

type Writer = JoinHandle<(Result<(), IoError>, Duration)>;

/// Largest number of lines that wait for the disk: about 10 s of a run. The next line ends the recording. Source: ours.
const MAX_WAITING_LINES: usize = 4096;

impl RunRecorder {
    /// A recording into `folder`, written within the run's own loop.
    ///
    /// # Errors
    /// When the file cannot be created.
    pub fn to_folder(folder: &OutputFolder) -> Result<Self, AppError> {
        Self::of_content(RecordingContent::All, folder)
    }

    /// A recording of `content` into `folder`; no recording if `content` is [`RecordingContent::None`].
    ///
    /// # Errors
    /// When the file cannot be created.
    pub fn of_content(content: RecordingContent, folder: &OutputFolder) -> Result<Self, AppError> {
        Ok(Self::of(Sink::Inline(Box::new(RecordingFile::new(content, folder)?))))
    }

    /// This recorder, whose recording ends if `space` is short; without effect for a recorder with a thread.
    #[must_use]
    pub fn watching(mut self, space: FreeSpace) -> Self {
        if let Sink::Inline(file) = &mut self.sink {
            file.space = Some(space);
        }
        self
    }

    fn of(sink: Sink) -> Self {
        Self { sink, queue_lengths: Histogram::default(), lines_lost: 0, checkpoints: None }
    }

    /// A recording onto a device that is full, for fault scenarios.
    ///
    /// # Errors
    /// On systems without a device that plays one.
    pub fn onto_full_disk() -> Result<Self, AppError> {
        let path = Path::new("/dev/full");
        let file = File::options().write(true).open(path);
        let file = file.map_err(|error| AppError::Environment(format!("{}: {error}", path.display())))?;
        let recorder = Recorder::new(BufWriter::with_capacity(1 << 20, file), path)?;
        let file = RecordingFile { recorder: Some(recorder), space: None, failure: None };
        Ok(Self::of(Sink::Inline(Box::new(file))))
    }

    /// A recording into `folder`, written by its own thread at `place`. With [`RecordingContent::None`] no data is recorded.
    ///
    /// # Errors
    /// When the file cannot be created or the thread cannot be started.
    pub fn threaded(
        content: RecordingContent,
        folder: &OutputFolder,
        place: ThreadPlacement,
    ) -> Result<Self, AppError> {
        let mut file = RecordingFile::new(content, folder)?;
        let (lines, inbox) = sync_channel::<Line>(MAX_WAITING_LINES);
        let waiting = Arc::<AtomicUsize>::default();
        let left = Arc::clone(&waiting);
        let write = move || {
            place.take();
            for line in inbox {
                left.fetch_sub(1, Ordering::Relaxed);
                line(&mut file);
            }
            (file.finish(), thread_time().unwrap_or_default())
        };
        let thread = std::thread::Builder::new().name("recorder".to_owned()).spawn(write);
        let thread = thread
            .map_err(|error| AppError::Environment(format!("cannot start a thread to record: {error}")))?;
        Ok(Self::of(Sink::Threaded { lines, waiting, thread }))
    }

    /// This recorder, which also writes the robot's checkpoints into `file`, if a file is given.
    ///
    /// # Errors
    /// When the writer's thread cannot be started.
    pub fn with_checkpoint_file(self, file: Option<&Path>) -> Result<Self, AppError> {
        Ok(Self { checkpoints: file.map(CheckpointWriter::new).transpose()?, ..self })
    }

    /// Whether checkpoints are written.
    pub fn writes_checkpoints(&self) -> bool {
        self.checkpoints.is_some()
    }

    /// Writes a checkpoint, if a file for checkpoints is given.
    pub fn write_checkpoint(&self, checkpoint: Arc<Checkpoint>) {
        if let Some(writer) = &self.checkpoints {
            writer.write(checkpoint);
        }
    }

    /// Writes a line. A full disk ends the recording, not the run.
    pub fn write(&mut self, line: impl FnOnce(&mut FileRecorder) -> Result<(), IoError> + Send + 'static) {
        match &mut self.sink {
            Sink::Inline(file) => file.write(line),
            Sink::Threaded { .. } if self.lines_lost > 0 => {
                self.lines_lost += 1;
            }
            Sink::Threaded { lines, waiting, .. } => {
                let length = waiting.fetch_add(1, Ordering::Relaxed);
                self.queue_lengths.note(length as f64);
                if let Err(TrySendError::Full(_)) = lines.try_send(Box::new(move |file| file.write(line))) {
                    waiting.fetch_sub(1, Ordering::Relaxed);
                    self.lines_lost += 1;
                }
            }
        }
    }

    /// Runs `work` in the recorder's thread, which does not delay control. Without a thread the work runs immediately; with a busy thread
    /// the work is dropped.
    pub fn beside(&self, work: impl FnOnce() + Send + 'static) {
        match &self.sink {
            Sink::Inline(_) => work(),
            Sink::Threaded { lines, waiting, .. } => {
                waiting.fetch_add(1, Ordering::Relaxed);
                if lines.try_send(Box::new(move |_| work())).is_err() {
                    waiting.fetch_sub(1, Ordering::Relaxed);
                }
            }
        }
    }

    /// Writes the last checkpoint, if a file for them is given.
    ///
    /// # Errors
    /// When the checkpoint could not be written.
    pub fn finish_checkpoints(&mut self, last: Option<Checkpoint>) -> Result<(), IoError> {
        self.checkpoints.take().map_or(Ok(()), |writer| writer.finish(last))
    }

    /// Ends the recording; the processor time of the recorder's thread, 0 without one.
    ///
    /// # Errors
    /// When the recording could not be written to its end.
    pub fn finish(self) -> Result<Duration, IoError> {
        match self.sink {
            Sink::Inline(file) => file.finish().map(|()| Duration::ZERO),
            Sink::Threaded { lines, thread, .. } => {
                drop(lines);
                let died = |_| IoError::Malformed {
                    path: "recording.mcap".into(),
                    problem: "the thread that records has died".to_owned(),
                };
                let (result, spent) = thread.join().map_err(died)?;
                result?;
                Ok(spent)
            }
        }
    }
}

/// The file of a recording, until it ends: with the run, or if the disk is full or short of space.
struct RecordingFile {
    /// `None` without a recording, and after its end.
    recorder: Option<FileRecorder>,
    space: Option<FreeSpace>,
    failure: Option<IoError>,
}

impl RecordingFile {
    fn new(content: RecordingContent, folder: &OutputFolder) -> Result<Self, AppError> {
        if content == RecordingContent::None {
            return Ok(Self { recorder: None, space: None, failure: None });
        }
        let recorder = Some(folder.recorder("recording.mcap")?);
        Ok(Self { recorder, space: Some(FreeSpace::of(&folder.staged(""))), failure: None })
    }

    /// Writes a line, or drops it after the recording has ended: a full disk does not stop a robot.
    fn write(&mut self, line: impl FnOnce(&mut FileRecorder) -> Result<(), IoError>) {
        let Some(recorder) = &mut self.recorder else { return };
        let shortage = self.space.as_mut().and_then(FreeSpace::shortage_at_message);
        let failure = if shortage.is_none() { line(recorder).err() } else { None };
        if let Some(why) = shortage.or_else(|| failure.as_ref().map(ToString::to_string)) {
            tracing::warn!("{why}; the recording ends here, the robot continues");
            let finished = self.recorder.take().map_or(Ok(()), |recorder| recorder.finish().map(drop));
            self.failure = failure.or(finished.err());
        }
    }

    fn finish(self) -> Result<(), IoError> {
        match (self.failure, self.recorder) {
            (Some(failure), _) => Err(failure),
            (None, recorder) => recorder.map_or(Ok(()), |recorder| recorder.finish().map(drop)),
        }
    }
}
