//! The server of the live page, on its own thread.

use crate::access::Access;
use crate::history::HISTORY_PERIOD;
use crate::http;
use crate::origin::page_origin;
use crate::page_state::PageState;
use crate::run_facts::RunFacts;
use crate::{LiveError, LiveOptions, PageCertificate};
use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use trundle_app::listening::is_shared;
use trundle_app::operator::Operator;
use trundle_server::{Listener, ServerThread};

/// A live page in service. A drop ends the page's thread and all its links.
#[derive(Debug)]
pub struct LivePage {
    address: SocketAddr,
    is_shared: bool,
    certificate: Option<PageCertificate>,
    drive_token: Option<String>,
    view_token: String,
    _thread: ServerThread,
}

impl LivePage {
    /// Serves the page of a run.
    ///
    /// # Errors
    /// When the address cannot be used, or the system refuses a thread.
    pub fn start(options: LiveOptions, operator: Operator, facts: RunFacts) -> Result<Self, LiveError> {
        let listener = bind(&options)?;
        let address = listener.local_addr().map_err(system)?;
        let is_shared = is_shared(address);
        let drive_token = options.is_steered.then(|| options.tokens.of(Access::Drive).to_owned());
        let view_token = options.tokens.of(Access::View).to_owned();
        let certificate = options.certificate.clone();
        let state = Arc::new(PageState::new(options, operator, facts));
        let thread = ServerThread::start("live page", listener, async move |listener| {
            serve(listener, &state).await;
        });
        let _thread = thread.map_err(system)?;
        Ok(Self { address, is_shared, certificate, drive_token, view_token, _thread })
    }

    /// Address of the page.
    #[must_use]
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// The link of an access; `None` for a driving link of a run without commands. Browsers do not send the part after `#`.
    #[must_use]
    pub fn link(&self, access: Access) -> Option<String> {
        let token = match access {
            Access::Drive => self.drive_token.as_ref()?,
            Access::View => &self.view_token,
        };
        Some(format!("{}/#{token}", page_origin(self.address, self.certificate.as_ref())))
    }

    /// Notice for a person: the links, and a warning if other machines can reach the page.
    #[must_use]
    pub fn announcement(&self) -> String {
        let mut lines = Vec::new();
        if let Some(link) = self.link(Access::Drive) {
            lines.push(format!("Live page: {link}"));
        }
        let before = if lines.is_empty() { "Live page," } else { " " };
        if let Some(link) = self.link(Access::View) {
            lines.push(format!("{before} to view only: {link}"));
        }
        if self.is_shared {
            let can =
                if self.drive_token.is_some() { "drive the robot" } else { "see all that the page shows" };
            let who = match self.certificate {
                None => ", and its network is not encrypted: who reads the link",
                Some(_) => ": who has the link",
            };
            lines.push(format!("warning: other machines can reach the live page{who} can {can}"));
        }
        lines.join("\n")
    }
}

/// Serves until the page is dropped.
async fn serve(listener: Listener, state: &Arc<PageState>) {
    tokio::select! {
        () = http::serve(listener, state) => {}
        () = keep_history(state) => {}
    }
}

/// Records the states of the run periodically, also without viewers.
async fn keep_history(state: &PageState) {
    let mut ticks = tokio::time::interval(HISTORY_PERIOD);
    ticks.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Delay);
    loop {
        ticks.tick().await;
        if let Some(view) = state.operator.peek() {
            let run = state.operator.series().map_or(0, |series| series.number);
            state.history().add(&view, run);
        }
    }
}

fn bind(options: &LiveOptions) -> Result<TcpListener, LiveError> {
    let address = options.address.socket;
    let free = SocketAddr::new(address.ip(), 0);
    let bound = TcpListener::bind(address);
    let bound =
        if options.address.takes_another_port { bound.or_else(|_| TcpListener::bind(free)) } else { bound };
    bound.map_err(|problem| LiveError::Address { address, problem })
}

fn system(error: std::io::Error) -> LiveError {
    LiveError::System(error.to_string())
}
