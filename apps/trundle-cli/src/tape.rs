use crate::{console, failure::Failure, keeper::Keeper};
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{SyncSender, TrySendError, sync_channel};
use std::thread::JoinHandle;
use std::time::Duration;
use trundle::io::{IoError, OutputFolder, Recorder};
use trundle::runtime::real_time::{Place, thread_time};
use trundle::runtime::{Histogram, Memory};

/// A recording into a file.
pub type FileRecorder = Recorder<BufWriter<File>>;

type Line = Box<dyn FnOnce(&mut FileRecorder) -> Result<(), IoError> + Send>;

/// Where a run is recorded: at once, or in a thread of its own, so that no disk holds control up.
pub struct Tape {
    way: Way,
    /// Lines that wait, each time one is put in.
    pub lengths: Histogram,
    /// Lines left out because the disk could not follow; the recording ends before the first.
    pub lost: u64,
    keeper: Option<Keeper>,
}

enum Way {
    /// With what ended the recording, if something did.
    Here(Box<FileRecorder>, Option<IoError>),
    Aside {
        lines: SyncSender<Line>,
        waiting: Arc<AtomicUsize>,
        thread: Writer,
    },
}

type Writer = JoinHandle<(Result<(), IoError>, Duration)>;

/// So many lines wait for the disk at most: about 10 s of a run.
const MOST_LINES: usize = 4096;

impl Tape {
    /// A recording that is written as it is made.
    pub fn here(folder: &OutputFolder) -> Result<Self, Failure> {
        let recorder = Box::new(folder.recorder("recording.mcap")?);
        Ok(Self { way: Way::Here(recorder, None), lengths: Histogram::default(), lost: 0, keeper: None })
    }

    /// A recording onto a disk that is full.
    ///
    /// # Errors
    /// On systems without a device that plays one.
    pub fn full() -> Result<Self, Failure> {
        let path = Path::new("/dev/full");
        let file = File::options().write(true).open(path);
        let file = file.map_err(|error| Failure::Environment(format!("{}: {error}", path.display())))?;
        let recorder = Box::new(Recorder::new(BufWriter::with_capacity(1 << 20, file), path)?);
        Ok(Self { way: Way::Here(recorder, None), lengths: Histogram::default(), lost: 0, keeper: None })
    }

    /// A recording that is written by a thread at `place`.
    pub fn aside(folder: &OutputFolder, place: Place) -> Result<Self, Failure> {
        let mut recorder = folder.recorder("recording.mcap")?;
        let (lines, inbox) = sync_channel::<Line>(MOST_LINES);
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
            .map_err(|error| Failure::Environment(format!("cannot start a thread to record: {error}")))?;
        Ok(Self {
            way: Way::Aside { lines, waiting, thread },
            lengths: Histogram::default(),
            lost: 0,
            keeper: None,
        })
    }

    /// The same, with what the robot remembers kept in a file where one is given.
    pub fn keeping(self, file: Option<&Path>) -> Result<Self, Failure> {
        Ok(Self { keeper: file.map(Keeper::new).transpose()?, ..self })
    }

    /// Whether what the robot remembers is wanted.
    pub fn keeps(&self) -> bool {
        self.keeper.is_some()
    }

    /// Keeps what the robot remembers, where that is wanted.
    pub fn keep(&self, memory: Arc<Memory>) {
        if let Some(keeper) = &self.keeper {
            keeper.keep(memory);
        }
    }

    /// Writes something down.
    pub fn put(
        &mut self,
        line: impl FnOnce(&mut FileRecorder) -> Result<(), IoError> + Send + 'static,
    ) -> Result<(), Failure> {
        match &mut self.way {
            // A robot on its way does not stop because a disk is full.
            Way::Here(_, Some(_)) => Ok(()),
            Way::Here(recorder, failure) => {
                *failure = line(recorder).err();
                if let Some(failure) = failure {
                    console::warn(&format!("{failure}; the recording ends here, the robot goes on"));
                }
                Ok(())
            }
            Way::Aside { .. } if self.lost > 0 => {
                self.lost += 1;
                Ok(())
            }
            Way::Aside { lines, waiting, .. } => {
                let length = waiting.fetch_add(1, Ordering::Relaxed);
                self.lengths.note(length as f64);
                if let Err(TrySendError::Full(_)) = lines.try_send(Box::new(line)) {
                    waiting.fetch_sub(1, Ordering::Relaxed);
                    self.lost += 1;
                }
                Ok(())
            }
        }
    }

    /// Ends the recording, and keeps what the robot remembers last; what its thread has computed, where it had one.
    pub fn finish(self, last: Option<Memory>) -> Result<Duration, Failure> {
        if let Some(keeper) = self.keeper {
            keeper.finish(last);
        }
        match self.way {
            Way::Here(_, Some(failure)) => Err(failure.into()),
            Way::Here(recorder, None) => {
                recorder.finish()?;
                Ok(Duration::ZERO)
            }
            Way::Aside { lines, thread, .. } => {
                drop(lines);
                let (result, spent) = thread
                    .join()
                    .map_err(|_| Failure::Environment("the thread that records has died".to_owned()))?;
                result?;
                Ok(spent)
            }
        }
    }
}
