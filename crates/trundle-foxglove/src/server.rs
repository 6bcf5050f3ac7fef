//! The server, on its own thread.

use crate::access::{self, Guard};
use crate::viewer::ShownRun;
use crate::{FoxgloveError, FoxgloveOptions, PageOrigin};
use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use std::thread::JoinHandle;
use tokio::sync::oneshot;
use trundle_app::operator::{Operator, OperatorLink};
use trundle_app::{AppError, RunSetup};
use trundle_runtime::real_time::ThreadPlacement;

/// Niceness of the server's thread above that of the robot's threads. Source: ours.
const SERVER_NICENESS: i32 = 10;

/// A run in Foxglove. A drop ends the thread and all connections.
#[derive(Debug)]
pub struct FoxgloveServer {
    address: SocketAddr,
    is_shared: bool,
    end: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl FoxgloveServer {
    /// Serves the views of a run.
    ///
    /// # Errors
    /// When the address cannot be used, or the system refuses a thread.
    pub fn start(options: FoxgloveOptions, operator: Operator) -> Result<Self, FoxgloveError> {
        let bound = TcpListener::bind(options.address);
        let listener =
            bound.map_err(|problem| FoxgloveError::Address { address: options.address, problem })?;
        let address = listener.local_addr()?;
        listener.set_nonblocking(true)?;
        let is_shared = options.is_shared();
        let guard = Arc::new(Guard::new(is_shared, options.origins));
        let run = Arc::new(ShownRun::new(options.name, operator));
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let (end, ended) = oneshot::channel();
        let work = move || {
            // If the system refuses the niceness, the run is shown without it.
            _ = ThreadPlacement { nice: SERVER_NICENESS, ..ThreadPlacement::default() }.take();
            runtime.block_on(serve(listener, guard, run, ended));
        };
        let thread = std::thread::Builder::new().name("foxglove".to_owned()).spawn(work)?;
        Ok(Self { address, is_shared, end: Some(end), thread: Some(thread) })
    }

    /// Serves a run of a setup, if an address is given.
    ///
    /// # Errors
    /// As [`FoxgloveServer::start`].
    pub fn for_run(
        setup: &RunSetup,
        link: &OperatorLink,
        address: Option<SocketAddr>,
        origins: &[PageOrigin],
    ) -> Result<Option<Self>, AppError> {
        let Some(address) = address else { return Ok(None) };
        let mut options = FoxgloveOptions::new(address, format!("{}: {}", setup.command, setup.scene));
        options.origins = origins.to_vec();
        Ok(Some(Self::start(options, link.operator())?))
    }

    /// Address of the server.
    #[must_use]
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Notice for a person: the address, and a warning if other machines can reach it.
    #[must_use]
    pub fn announcement(&self) -> String {
        let warning = match self.is_shared {
            false => "",
            true => {
                "\nwarning: other machines can reach this address without a password, and its network is not encrypted: \
                 who connects sees all that the robot sees"
            }
        };
        format!("Foxglove, to view only: ws://{}{warning}", self.address)
    }
}

impl Drop for FoxgloveServer {
    fn drop(&mut self) {
        drop(self.end.take());
        if self.thread.take().is_some_and(|thread| thread.join().is_err()) {
            tracing::error!("the thread of the server for Foxglove panicked");
        }
    }
}

async fn serve(listener: TcpListener, guard: Arc<Guard>, run: Arc<ShownRun>, ended: oneshot::Receiver<()>) {
    match tokio::net::TcpListener::from_std(listener) {
        Ok(listener) => access::serve(listener, guard, run, ended).await,
        Err(error) => tracing::error!("the run cannot be shown in Foxglove: {error}"),
    }
}
