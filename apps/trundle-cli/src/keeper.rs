use crate::{console, failure::Failure};
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::JoinHandle;
use trundle::io::replace_file;
use trundle::runtime::Memory;

/// Keeps what the robot remembers in a file, in a thread of its own: no disk holds control up, and the file is whole at any
/// instant.
pub struct Keeper {
    inbox: SyncSender<Arc<Memory>>,
    thread: JoinHandle<()>,
}

impl Keeper {
    /// Keeps it in `path`.
    ///
    /// # Errors
    /// When its thread cannot be started. What cannot be written is warned of, and tried again with the next.
    pub fn new(path: &Path) -> Result<Self, Failure> {
        let (inbox, memories) = sync_channel::<Arc<Memory>>(1);
        let path = path.to_owned();
        let keep = move || {
            let mut is_failing = false;
            for memory in memories {
                let kept = replace_file(&path, &memory.to_bytes());
                if let (Err(error), false) = (&kept, is_failing) {
                    console::warn(&format!("{error}; the robot goes on, the file stays as it was"));
                }
                is_failing = kept.is_err();
            }
        };
        let thread = std::thread::Builder::new().name("keeper".to_owned()).spawn(keep);
        let thread = thread
            .map_err(|error| Failure::Environment(format!("cannot start a thread to remember: {error}")))?;
        Ok(Self { inbox, thread })
    }

    /// Keeps this in place of what was; not when the last but one is still being written.
    pub fn keep(&self, memory: Arc<Memory>) {
        let _ = self.inbox.try_send(memory);
    }

    /// Keeps this last one too, and waits until all is written.
    pub fn finish(self, last: Option<Memory>) {
        if let Some(last) = last {
            let _ = self.inbox.send(Arc::new(last));
        }
        drop(self.inbox);
        let _ = self.thread.join();
    }
}
