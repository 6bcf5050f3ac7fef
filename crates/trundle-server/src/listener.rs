//! Accepts the connections of a server.

use crate::accept_failures::AcceptFailures;
use crate::end_notice::EndNotice;
use crate::pools::Pools;
use crate::ticket::{SILENT_TIMEOUT, Ticket};
use std::io::Error;
use std::time::{Duration, Instant};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::oneshot;
use tokio::task::JoinSet;

/// Pause after a refused accept, for example without free file descriptors. Source: ours.
const ACCEPT_PAUSE: Duration = Duration::from_millis(100);

/// Accepts the connections of a server until its thread is to end.
#[derive(Debug)]
pub struct Listener {
    /// Name of the server, for the log.
    pub(crate) name: &'static str,
    pub(crate) listener: TcpListener,
    pub(crate) ended: oneshot::Receiver<()>,
}

impl Listener {
    /// Serves each connection by `open` in a task of its own. At the end of the server informs the viewers, and closes the connections.
    pub async fn serve<F>(mut self, notice: &EndNotice, open: impl Fn(TcpStream, Ticket) -> F)
    where
        F: Future<Output = ()> + Send + 'static,
    {
        let (pools, mut tasks, mut failures) = (Pools::default(), JoinSet::new(), AcceptFailures::default());
        loop {
            tokio::select! {
                _ = &mut self.ended => break,
                Some(_) = tasks.join_next() => {}
                accepted = self.listener.accept() => match accepted {
                    Ok((stream, peer)) => {
                        self.prepare(&stream);
                        let ticket = Ticket::new(&pools, peer.ip());
                        let work = open(stream, ticket.clone());
                        tasks.spawn(run(self.name, work, ticket));
                    }
                    Err(error) => {
                        self.log(&mut failures, &error);
                        // Its file descriptor may be the missing one.
                        pools.close_silent();
                        tokio::time::sleep(ACCEPT_PAUSE).await;
                    }
                },
            }
        }
        notice.announce().await;
    }

    /// Small messages are sent at once.
    fn prepare(&self, stream: &TcpStream) {
        if let Err(error) = stream.set_nodelay(true) {
            tracing::debug!("{}: {error}", self.name);
        }
    }

    fn log(&self, failures: &mut AcceptFailures, error: &Error) {
        if let Some(line) = failures.line(self.name, error, Instant::now()) {
            tracing::warn!("{line}");
        }
    }
}

/// Serves a connection until it ends, is silent for too long or has to close in favour of another one.
async fn run(name: &str, work: impl Future<Output = ()>, ticket: Ticket) {
    tokio::select! {
        () = work => {}
        () = ticket.closed() => tracing::debug!("{name}: a connection was closed in favour of a newer one"),
        () = ticket.silent_too_long() => tracing::debug!("{name}: a connection sent no request within {SILENT_TIMEOUT:?}"),
    }
}
