//! The server of the live page, on its own thread.

use crate::access::Access;
use crate::history::HISTORY_PERIOD;
use crate::http;
use crate::page_state::PageState;
use crate::run_facts::RunFacts;
use crate::{LiveError, LiveOptions, PageCertificate};
use std::net::{IpAddr, Ipv4Addr, SocketAddr, TcpListener, UdpSocket};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use tokio::runtime::Runtime;
use tokio::sync::oneshot;
use trundle_app::operator::Operator;
use trundle_runtime::real_time::ThreadPlacement;

/// Niceness of the page's thread above that of the robot's threads. Source: ours.
const PAGE_NICENESS: i32 = 10;

/// Longest wait for the page's thread at the end of a run. Source: ours; it ends within milliseconds unless it hangs.
const END_TIMEOUT: Duration = Duration::from_secs(2);
/// Longest wait until the viewers have received the end of the program. Source: ours; a viewer on the same network receives it within
/// milliseconds.
const GOODBYE_TIMEOUT: Duration = Duration::from_millis(300);
/// Period of checks for the end of the thread. Source: ours.
const END_CHECK_PERIOD: Duration = Duration::from_millis(5);

/// A live page in service. A drop ends the page's thread and all its links.
#[derive(Debug)]
pub struct LivePage {
    address: SocketAddr,
    is_shared: bool,
    certificate: Option<PageCertificate>,
    drive_token: Option<String>,
    view_token: String,
    end: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl LivePage {
    /// Serves the page of a run.
    ///
    /// # Errors
    /// When the address cannot be used, or the system refuses a thread.
    pub fn start(options: LiveOptions, operator: Operator, facts: RunFacts) -> Result<Self, LiveError> {
        let listener = bind(&options)?;
        let address = listener.local_addr().map_err(system)?;
        listener.set_nonblocking(true).map_err(system)?;
        let is_shared = options.address.is_shared();
        let drive_token = options.is_steered.then(|| options.tokens.of(Access::Drive).to_owned());
        let view_token = options.tokens.of(Access::View).to_owned();
        let certificate = options.certificate.clone();
        let state = Arc::new(PageState::new(options, operator, facts));
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().map_err(system)?;
        let (end, ended) = oneshot::channel();
        let work = move || {
            // If the system refuses the niceness, the page is served without it.
            _ = ThreadPlacement { nice: PAGE_NICENESS, ..ThreadPlacement::default() }.take();
            run_to_end(runtime, serve(listener, state, ended));
        };
        let thread = std::thread::Builder::new().name("live-page".to_owned()).spawn(work).map_err(system)?;
        let (end, thread) = (Some(end), Some(thread));
        Ok(Self { address, is_shared, certificate, drive_token, view_token, end, thread })
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
        Some(format!("{}/#{token}", self.origin()))
    }

    /// Scheme, name and port of the links: the page's address, or a name of the certificate if that does not hold for the address.
    fn origin(&self) -> String {
        let mut address = self.address;
        if address.ip().is_unspecified() {
            address.set_ip(own_address().unwrap_or(IpAddr::V4(Ipv4Addr::LOCALHOST)));
        }
        let Some(certificate) = &self.certificate else { return format!("http://{address}") };
        let is_known = certificate.covers(&address.ip().to_string());
        match certificate.first_name().filter(|_| !is_known) {
            Some(name) => format!("https://{name}:{}", address.port()),
            None => format!("https://{address}"),
        }
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

impl Drop for LivePage {
    fn drop(&mut self) {
        drop(self.end.take());
        let Some(thread) = self.thread.take() else { return };
        let start = Instant::now();
        while !thread.is_finished() && start.elapsed() < END_TIMEOUT {
            std::thread::sleep(END_CHECK_PERIOD);
        }
        if !thread.is_finished() {
            // The results of the run count more than the page: the thread ends with the program.
            return tracing::warn!("the thread of the live page does not end and is abandoned");
        }
        if thread.join().is_err() {
            tracing::error!("the thread of the live page panicked");
        }
    }
}

/// Runs a future to its end. A file still being read is not waited for, because the disk may never respond.
fn run_to_end(runtime: Runtime, future: impl Future<Output = ()>) {
    runtime.block_on(future);
    runtime.shutdown_background();
}

/// Serves until the page is dropped.
async fn serve(listener: TcpListener, state: Arc<PageState>, ended: oneshot::Receiver<()>) {
    let listener = match tokio::net::TcpListener::from_std(listener) {
        Ok(listener) => listener,
        Err(error) => return tracing::error!("the live page cannot be served: {error}"),
    };
    let router = http::router(Arc::clone(&state));
    let certificate = state.certificate.clone();
    tokio::select! {
        () = http::serve(listener, router, certificate) => {}
        () = keep_history(&state) => {}
        _ = ended => say_goodbye(&state).await,
    }
}

/// Informs the viewers of the end of the program, and waits shortly until they have received the message.
async fn say_goodbye(state: &PageState) {
    state.end();
    let all_gone = async {
        while state.viewer_list().count() > 0 {
            tokio::time::sleep(END_CHECK_PERIOD).await;
        }
    };
    _ = tokio::time::timeout(GOODBYE_TIMEOUT, all_gone).await;
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

/// The address by which other machines reach this one. The socket sends no data: it only queries the system's route.
fn own_address() -> Option<IpAddr> {
    /// An address of documentation. Source: RFC 5737.
    const FAR_AWAY: (Ipv4Addr, u16) = (Ipv4Addr::new(192, 0, 2, 1), 9);
    let socket = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0)).ok()?;
    socket.connect(FAR_AWAY).ok()?;
    Some(socket.local_addr().ok()?.ip())
}

fn system(error: std::io::Error) -> LiveError {
    LiveError::System(error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn runtime() -> Runtime {
        tokio::runtime::Builder::new_current_thread().build().unwrap()
    }

    #[test]
    fn a_thread_that_hangs_does_not_hold_up_the_end() {
        let (hang, hung) = std::sync::mpsc::channel::<()>();
        let page = LivePage {
            address: (Ipv4Addr::LOCALHOST, 1).into(),
            is_shared: false,
            certificate: None,
            drive_token: None,
            view_token: String::new(),
            end: None,
            thread: Some(std::thread::spawn(move || _ = hung.recv())),
        };
        let (send, dropped) = std::sync::mpsc::channel();
        std::thread::spawn(move || {
            drop(page);
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
            run_to_end(runtime(), async move {
                drop(tokio::task::spawn_blocking(move || _ = hung.recv()));
            });
            send.send(()).unwrap();
        });
        let end = ended.recv_timeout(Duration::from_secs(10));
        drop(hang);
        end.expect("the end waits for the file");
    }
}
