//! The thread of a server.

use crate::Listener;
use std::io;
use std::net::TcpListener;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use tokio::runtime::Runtime;
use tokio::sync::oneshot;
use trundle_runtime::real_time::ThreadPlacement;

/// Niceness of a server's thread above that of the robot's threads. Source: ours.
const SERVER_NICENESS: i32 = 10;
/// Longest wait for the thread at the end of a server. Source: ours; it ends within milliseconds unless it hangs.
const END_TIMEOUT: Duration = Duration::from_secs(2);
/// Period of checks for the end of the thread. Source: ours.
const END_CHECK_PERIOD: Duration = Duration::from_millis(5);

/// A server on its own thread. A drop ends the server and its connections.
#[derive(Debug)]
pub struct ServerThread {
    name: &'static str,
    end: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl ServerThread {
    /// Starts a server on a bound address; `name` it is, for the log.
    ///
    /// # Errors
    /// When the system refuses a thread or a socket.
    pub fn start<F: Future<Output = ()>>(
        name: &'static str,
        listener: TcpListener,
        serve: impl FnOnce(Listener) -> F + Send + 'static,
    ) -> io::Result<Self> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        listener.set_nonblocking(true)?;
        let listener = {
            let _entered = runtime.enter();
            tokio::net::TcpListener::from_std(listener)?
        };
        let (end, ended) = oneshot::channel();
        let work = move || {
            // If the system refuses the niceness, the server runs without it.
            _ = ThreadPlacement { nice: SERVER_NICENESS, ..ThreadPlacement::default() }.take();
            run_to_end(runtime, serve(Listener { name, listener, ended }));
        };
        let thread = std::thread::Builder::new().name(name.replace(' ', "-")).spawn(work)?;
        Ok(Self { name, end: Some(end), thread: Some(thread) })
    }
}

impl Drop for ServerThread {
    fn drop(&mut self) {
        drop(self.end.take());
        let Some(thread) = self.thread.take() else { return };
        let start = Instant::now();
        while !thread.is_finished() && start.elapsed() < END_TIMEOUT {
            std::thread::sleep(END_CHECK_PERIOD);
        }
        if !thread.is_finished() {
            // The results of the run count more than the server: the thread ends with the program.
            return tracing::warn!("{}: the thread does not end and is abandoned", self.name);
        }
        if thread.join().is_err() {
            tracing::error!("{}: the thread panicked", self.name);
        }
    }
}

/// Runs a future to its end. A file still being read is not waited for, because the disk may never respond.
fn run_to_end(runtime: Runtime, future: impl Future<Output = ()>) {
    runtime.block_on(future);
    runtime.shutdown_background();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thread_that_hangs_does_not_hold_up_the_end() {
        let (hang, hung) = std::sync::mpsc::channel::<()>();
        let thread = Some(std::thread::spawn(move || _ = hung.recv()));
        let server = ServerThread { name: "test", end: None, thread };
        let (send, dropped) = std::sync::mpsc::channel();
        std::thread::spawn(move || {
            drop(server);
            send.send(()).unwrap();
        });
        let end = dropped.recv_timeout(END_TIMEOUT + Duration::from_secs(10));
        drop(hang);
        end.expect("the drop waits for the thread");
    }

    #[test]
    fn a_file_that_is_never_read_does_not_hold_up_the_end() {
        let (hang, hung) = std::sync::mpsc::channel::<()>();
        let (send, ended) = std::sync::mpsc::channel();
        std::thread::spawn(move || {
            let runtime = tokio::runtime::Builder::new_current_thread().build().unwrap();
            run_to_end(runtime, async move {
                drop(tokio::task::spawn_blocking(move || _ = hung.recv()));
            });
            send.send(()).unwrap();
        });
        let end = ended.recv_timeout(Duration::from_secs(10));
        drop(hang);
        end.expect("the end waits for the file");
    }
}
