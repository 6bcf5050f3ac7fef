//! The recording of a run: written within the run's own loop, or by a thread of its own.

use crate::{AppError, checkpoint_writer::CheckpointWriter};
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

type Line = Box<dyn FnOnce(&mut FileRecorder) -> Result<(), IoError> + Send>;

/// Records a run into `recording.mcap`: within the run's own loop, or by a thread of its own, so that a slow disk does not delay
/// control. Writes checkpoints as well, where a file for them is given.
pub struct RunRecorder {
    sink: Sink,
    /// Lines that wait for the disk, counted each time a line is written.
    pub queue_lengths: Histogram,
    /// Lines left out because the disk could not follow; the recording ends before the first.
    pub lines_lost: u64,
    checkpoints: Option<CheckpointWriter>,
}

enum Sink {
    /// With what ended the recording, if something did.
    Inline(Box<FileRecorder>, Option<IoError>),
    Threaded {
        lines: SyncSender<Line>,
        waiting: Arc<AtomicUsize>,
        thread: Writer,
    },
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
        let recorder = Box::new(folder.recorder("recording.mcap")?);
        Ok(Self {
            sink: Sink::Inline(recorder, None),
            queue_lengths: Histogram::default(),
            lines_lost: 0,
            checkpoints: None,
        })
    }

    /// A recording onto a device that is full, for fault scenarios.
    ///
    /// # Errors
    /// On systems without a device that plays one.
    pub fn onto_full_disk() -> Result<Self, AppError> {
        let path = Path::new("/dev/full");
        let file = File::options().write(true).open(path);
        let file = file.map_err(|error| AppError::Environment(format!("{}: {error}", path.display())))?;
        let recorder = Box::new(Recorder::new(BufWriter::with_capacity(1 << 20, file), path)?);
        Ok(Self {
            sink: Sink::Inline(recorder, None),
            queue_lengths: Histogram::default(),
            lines_lost: 0,
            checkpoints: None,
        })
    }

    /// A recording into `folder`, written by a thread of its own at `place`.
    ///
    /// # Errors
    /// When the file cannot be created or the thread cannot be started.
    pub fn threaded(folder: &OutputFolder, place: ThreadPlacement) -> Result<Self, AppError> {
        let mut recorder = folder.recorder("recording.mcap")?;
        let (lines, inbox) = sync_channel::<Line>(MAX_WAITING_LINES);
        let waiting = Arc::<AtomicUsize>::default();
        let left = Arc::clone(&waiting);
        let write = move || {
            place.take();
            let mut result = Ok(());
            for line in inbox {
                left.fetch_sub(1, Ordering::Relaxed);
                // After a failure the rest is taken and let go, so that the run goes on.
                if result.is_ok() {
                    result = line(&mut recorder);
                }
            }
            (result.and_then(|()| recorder.finish().map(drop)), thread_time().unwrap_or_default())
        };
        let thread = std::thread::Builder::new().name("recorder".to_owned()).spawn(write);
        let thread = thread
            .map_err(|error| AppError::Environment(format!("cannot start a thread to record: {error}")))?;
        Ok(Self {
            sink: Sink::Threaded { lines, waiting, thread },
            queue_lengths: Histogram::default(),
            lines_lost: 0,
            checkpoints: None,
        })
    }

    /// The same recorder, which also writes the robot's checkpoints into `file`, where a file is given.
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

    /// Writes a checkpoint, where a file for checkpoints is given.
    pub fn write_checkpoint(&self, checkpoint: Arc<Checkpoint>) {
        if let Some(writer) = &self.checkpoints {
            writer.write(checkpoint);
        }
    }

    /// Writes a line. A full disk ends the recording, not the run.
    pub fn write(&mut self, line: impl FnOnce(&mut FileRecorder) -> Result<(), IoError> + Send + 'static) {
        match &mut self.sink {
            // A robot on its way does not stop because a disk is full.
            Sink::Inline(_, Some(_)) => {}
            Sink::Inline(recorder, failure) => {
                *failure = line(recorder).err();
                if let Some(failure) = failure {
                    tracing::warn!("{failure}; the recording ends here, the robot goes on");
                }
            }
            Sink::Threaded { .. } if self.lines_lost > 0 => {
                self.lines_lost += 1;
            }
            Sink::Threaded { lines, waiting, .. } => {
                let length = waiting.fetch_add(1, Ordering::Relaxed);
                self.queue_lengths.note(length as f64);
                if let Err(TrySendError::Full(_)) = lines.try_send(Box::new(line)) {
                    waiting.fetch_sub(1, Ordering::Relaxed);
                    self.lines_lost += 1;
                }
            }
        }
    }

    /// Ends the recording and writes the last checkpoint; the processor time of the recorder's thread, 0 without one.
    ///
    /// # Errors
    /// When the recording could not be written to its end.
    pub fn finish(self, last: Option<Checkpoint>) -> Result<Duration, AppError> {
        if let Some(writer) = self.checkpoints {
            writer.finish(last);
        }
        match self.sink {
            Sink::Inline(_, Some(failure)) => Err(failure.into()),
            Sink::Inline(recorder, None) => {
                recorder.finish()?;
                Ok(Duration::ZERO)
            }
            Sink::Threaded { lines, thread, .. } => {
                drop(lines);
                let (result, spent) = thread
                    .join()
                    .map_err(|_| AppError::Environment("the thread that records has died".to_owned()))?;
                result?;
                Ok(spent)
            }
        }
    }
}
