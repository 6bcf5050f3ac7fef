//! The recording of a run, written within the run's loop or by a separate thread.

use crate::recording_file::{FileRecorder, RecordingFile, first_file};
use crate::{AppError, FreeSpace, RecordingContent, RecordingSwitch, checkpoint_writer::CheckpointWriter};
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

type Line = Box<dyn FnOnce(&mut RecordingFile) + Send>;

/// Records a run into `recording.mcap`, within the run's loop or by a separate thread. With the thread a slow disk does not delay control.
/// A recording that is switched on later is a further file. Writes checkpoints as well, if their file is given.
pub struct RunRecorder {
    sink: Sink,
    /// Lines that wait for the disk, counted each time a line is written.
    pub queue_lengths: Histogram,
    /// Lines left out because the disk could not follow; a file ends before its first.
    pub lines_lost: u64,
    /// Whether the present file has ended because the disk could not follow.
    is_cut: bool,
    switch: RecordingSwitch,
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
        let switch = RecordingSwitch::default();
        let file = RecordingFile::new(content, folder, switch.clone())?;
        Ok(Self::of(Sink::Inline(Box::new(file)), switch))
    }

    /// This recorder, whose recording ends if `space` is short; without effect for a recorder with a thread.
    #[must_use]
    pub fn watching(mut self, space: FreeSpace) -> Self {
        if let Sink::Inline(file) = &mut self.sink {
            file.watch(space);
        }
        self
    }

    fn of(sink: Sink, switch: RecordingSwitch) -> Self {
        let queue_lengths = Histogram::default();
        Self { sink, queue_lengths, lines_lost: 0, is_cut: false, switch, checkpoints: None }
    }

    /// The switch of the recording.
    pub fn switch(&self) -> &RecordingSwitch {
        &self.switch
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
        let switch = RecordingSwitch::default();
        let file = RecordingFile::onto(recorder, switch.clone());
        Ok(Self::of(Sink::Inline(Box::new(file)), switch))
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
        let switch = RecordingSwitch::default();
        let mut file = RecordingFile::new(content, folder, switch.clone())?;
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
        Ok(Self::of(Sink::Threaded { lines, waiting, thread }, switch))
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
        if self.is_cut {
            self.lines_lost += 1;
        } else {
            self.change(move |file| file.write(line));
        }
    }

    /// Ends the present file. The run continues.
    pub fn end(&mut self) {
        self.change(RecordingFile::end);
    }

    /// Begins a further file: the next lines are its first. If the disk is short of space, there is none.
    pub fn begin_part(&mut self) {
        self.is_cut = false;
        self.change(RecordingFile::begin_part);
    }

    /// Reports the free space to the switch, unless the disk cannot follow.
    pub fn report_space(&mut self) {
        _ = self.queue(|file| file.report_space());
    }

    /// Changes the file. If the disk cannot follow, the present file is cut here.
    fn change(&mut self, change: impl FnOnce(&mut RecordingFile) + Send + 'static) {
        if self.queue(change) {
            return;
        }
        self.lines_lost += 1;
        self.is_cut = true;
        self.switch.update(|state| {
            state.is_on = false;
            state.reason = Some("the disk could not follow".to_owned());
        });
    }

    /// Changes the file after the lines before; returns whether the queue had space.
    fn queue(&mut self, change: impl FnOnce(&mut RecordingFile) + Send + 'static) -> bool {
        let (lines, waiting) = match &mut self.sink {
            Sink::Inline(file) => {
                change(file);
                return true;
            }
            Sink::Threaded { lines, waiting, .. } => (lines, waiting),
        };
        let length = waiting.fetch_add(1, Ordering::Relaxed);
        self.queue_lengths.note(length as f64);
        let is_full = matches!(lines.try_send(Box::new(change)), Err(TrySendError::Full(_)));
        if is_full {
            waiting.fetch_sub(1, Ordering::Relaxed);
        }
        !is_full
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
                    path: first_file().to_owned(),
                    problem: "the thread that records has died".to_owned(),
                };
                let (result, spent) = thread.join().map_err(died)?;
                result?;
                Ok(spent)
            }
        }
    }
}
