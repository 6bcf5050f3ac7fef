//! The end of a server, as its viewers are informed of it.

use std::time::Duration;
use tokio::sync::watch;

/// Longest wait until the viewers have sent the end to their other side. Source: ours; a viewer on the same network receives it within
/// milliseconds.
const GOODBYE_TIMEOUT: Duration = Duration::from_millis(300);

/// Informs the viewers of a server of its end.
#[derive(Debug, Default)]
pub struct EndNotice(watch::Sender<bool>);

impl EndNotice {
    /// The reader of a viewer. The end of the server waits for a bounded time until all readers are gone.
    #[must_use]
    pub fn reader(&self) -> EndReader {
        EndReader(self.0.subscribe())
    }

    /// Informs all readers, and waits for a bounded time until they are gone.
    pub(crate) async fn announce(&self) {
        self.0.send_replace(true);
        _ = tokio::time::timeout(GOODBYE_TIMEOUT, self.0.closed()).await;
    }
}

/// A viewer's view of the end of its server. A drop reports that the viewer is gone.
#[derive(Debug)]
pub struct EndReader(watch::Receiver<bool>);

impl EndReader {
    /// Waits until the server ends.
    pub async fn ended(&mut self) {
        // A server that is gone has ended.
        _ = self.0.wait_for(|is_over| *is_over).await;
    }
}
