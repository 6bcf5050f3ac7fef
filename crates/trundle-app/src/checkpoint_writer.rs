//! Writing of checkpoints into one file, in a thread of its own.

use crate::AppError;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::JoinHandle;
use trundle_io::{IoError, replace_file, require_replaceable};
use trundle_runtime::Checkpoint;

/// Writes the robot's newest checkpoint into a file, in a thread of its own: a slow disk does not delay control, and the file is
/// whole at any instant.
pub struct CheckpointWriter {
    inbox: SyncSender<Arc<Checkpoint>>,
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
        let (inbox, checkpoints) = sync_channel::<Arc<Checkpoint>>(1);
        let path = path.to_owned();
        let keep = move || {
            let mut last = Ok(());
            for checkpoint in checkpoints {
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
        Ok(Self { inbox, thread })
    }

    /// Writes `checkpoint` in place of the one before; skips `checkpoint` while two others wait.
    pub fn write(&self, checkpoint: Arc<Checkpoint>) {
        let _ = self.inbox.try_send(checkpoint);
    }

    /// Writes the last checkpoint, and waits until the file is written.
    ///
    /// # Errors
    /// When the last checkpoint could not be written.
    pub fn finish(self, last: Option<Checkpoint>) -> Result<(), IoError> {
        if let Some(last) = last {
            let _ = self.inbox.send(Arc::new(last));
        }
        drop(self.inbox);
        // A thread that panicked has logged it.
        self.thread.join().unwrap_or(Ok(()))
    }
}
