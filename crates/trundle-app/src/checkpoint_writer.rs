//! Writing of checkpoints into one file, in a thread of its own.

use crate::AppError;
use std::path::Path;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use trundle_io::{IoError, replace_file, require_replaceable};
use trundle_runtime::Checkpoint;

/// The newest checkpoint that is not written yet.
type Newest = Arc<Mutex<Option<Arc<Checkpoint>>>>;

/// Writes the robot's newest checkpoint into a file, in a thread of its own: a slow disk does not delay control, and the file is
/// whole at any instant.
pub struct CheckpointWriter {
    newest: Newest,
    /// Wakes the thread, which then writes the newest checkpoint.
    wake: SyncSender<()>,
    thread: JoinHandle<Result<(), IoError>>,
}

impl CheckpointWriter {
    /// A writer of the file `path`.
    ///
    /// # Errors
    /// When no file can be written there, or the thread cannot be started. A later checkpoint that cannot be written is logged as a
    /// warning; the next one is tried again.
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
                    tracing::warn!("{error}; the robot goes on, the file stays as it was");
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

    /// Writes `checkpoint` in place of the one before; skips one that still waits.
    pub fn write(&self, checkpoint: Arc<Checkpoint>) {
        *self.newest.lock().unwrap_or_else(PoisonError::into_inner) = Some(checkpoint);
        // Where a wake-up waits already, the thread finds this checkpoint at it.
        let _ = self.wake.try_send(());
    }

    /// Writes the last checkpoint, and waits until the file is written.
    ///
    /// # Errors
    /// When the last checkpoint could not be written.
    pub fn finish(self, last: Option<Checkpoint>) -> Result<(), IoError> {
        last.into_iter().for_each(|last| self.write(Arc::new(last)));
        drop(self.wake);
        // A thread that panicked has logged it.
        self.thread.join().unwrap_or(Ok(()))
    }
}
