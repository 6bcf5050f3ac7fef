//! The server, on its own thread.

use crate::access::{self, Guard, Service};
use crate::viewer::ShownRun;
use crate::{FoxgloveError, FoxgloveOptions, PageOrigin};
use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use trundle_app::listening::is_shared;
use trundle_app::operator::{Operator, OperatorLink};
use trundle_app::{AppError, RunSetup};
use trundle_server::{EndNotice, ServerThread};

/// A run in Foxglove. A drop ends the thread and all connections.
#[derive(Debug)]
pub struct FoxgloveServer {
    address: SocketAddr,
    is_shared: bool,
    _thread: ServerThread,
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
        let is_shared = is_shared(address);
        let guard = Guard::new(is_shared, options.origins);
        let run = ShownRun::new(options.name, operator);
        let service = Arc::new(Service { guard, run, end: EndNotice::default() });
        let _thread = ServerThread::start("foxglove", listener, |listener| access::serve(listener, service))?;
        Ok(Self { address, is_shared, _thread })
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
