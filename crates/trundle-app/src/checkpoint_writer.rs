//! Writes checkpoints into one file on a thread.

use crate::AppError;
use std::path::Path;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use trundle_io::{IoError, replace_file, require_replaceable};
use trundle_runtime::Checkpoint;

/// The newest checkpoint that is not yet written.
type Newest = Arc<Mutex<Option<Arc<Checkpoint>>>>;

/// Writes the robot's newest checkpoint into a file on a thread: a slow disk does not delay control, and a reader always finds a complete
/// file.
pub struct CheckpointWriter {
    newest: Newest,
    /// Starts a write of the newest checkpoint by the thread.
    wake: SyncSender<()>,
    thread: JoinHandle<Result<(), IoError>>,
}

impl CheckpointWriter {
    /// A writer of the file `path`.
    ///
    /// # Errors
    /// When the file cannot be created, or the thread cannot be started. A failure to write a later checkpoint is logged as a warning; the
    /// next checkpoint is tried again.
    pub fn new(path: &Path) -> Result<Self, AppError> {
        require_replaceable(path)?;
        let (wake, wakes) = sync_channel::<()>(1);
        let (path, newest) = (path.to_owned(), Newest::default());
        let waiting = Arc::clone(&newest);
        let take = move || waiting.lock().unwrap_or_else(PoisonError::into_inner).take();
        let keep = move || {
            let mut last = Ok(());
            for checkpoint in wakes.into_iter().filter_map(|()| take()) {
                let kept = replace_file(&path, &checkpoint.to_bytes());
                if let (Err(error), true) = (&kept, last.is_ok()) {
                    tracing::warn!("{error}; the robot continues, the file is unchanged");
                }
                last = kept;
            }
            last
        };
        let thread = std::thread::Builder::new().name("checkpoint".to_owned()).spawn(keep);
        let thread = thread.map_err(|error| {
            AppError::Environment(format!("cannot start the thread that writes checkpoints: {error}"))
        })?;
        Ok(Self { newest, wake, thread })
    }

    /// Writes `checkpoint` in place of the previous one; replaces a checkpoint that waits.
    pub fn write(&self, checkpoint: Arc<Checkpoint>) {
        *self.newest.lock().unwrap_or_else(PoisonError::into_inner) = Some(checkpoint);
        // If a wake-up already waits, the thread finds this checkpoint when it wakes.
        let _ = self.wake.try_send(());
    }

    /// Writes the last checkpoint, and waits until the file is written.
    ///
    /// # Errors
    /// When the last checkpoint could not be written.
    pub fn finish(self, last: Option<Checkpoint>) -> Result<(), IoError> {
        last.into_iter().for_each(|last| self.write(Arc::new(last)));
        drop(self.wake);
        // The panic of the thread is already logged.
        self.thread.join().unwrap_or(Ok(()))
    }
}
