//! Accepts connections. Of those whose request is not yet read, only the newest are kept.

use super::guard::{Admitted, Guard};
use crate::viewer::{self, ShownRun};
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{oneshot, watch};
use tokio::task::{AbortHandle, JoinSet};

/// Maximum number of connections whose request is not yet read; a further one closes the oldest. Source: ours.
const MAX_WAITING: usize = 48;
/// Pause after a refused accept, for example without free file descriptors. Source: ours.
const ACCEPT_PAUSE: Duration = Duration::from_millis(100);
/// Longest wait until the viewers have received the end of the run. Source: ours; a viewer on the same network receives it within
/// milliseconds.
const GOODBYE_TIMEOUT: Duration = Duration::from_millis(300);

/// Serves until `ended`, then closes the connections.
pub async fn serve(
    listener: TcpListener,
    guard: Arc<Guard>,
    run: Arc<ShownRun>,
    mut ended: oneshot::Receiver<()>,
) {
    let (mut waiting, mut viewers) = (Waiting::default(), JoinSet::new());
    let end = watch::Sender::new(false);
    loop {
        tokio::select! {
            _ = &mut ended => break,
            accepted = listener.accept() => match accepted {
                Ok((stream, _)) => waiting.add(stream, &guard),
                Err(_) => tokio::time::sleep(ACCEPT_PAUSE).await,
            },
            Some(admitted) = waiting.tasks.join_next() => {
                if let Ok(Some(Admitted { socket, slot })) = admitted {
                    let (run, end) = (Arc::clone(&run), end.subscribe());
                    viewers.spawn(async move {
                        viewer::serve(socket, &run, end).await;
                        drop(slot);
                    });
                }
            }
            Some(_) = viewers.join_next() => {}
        }
    }
    end.send_replace(true);
    let all_gone = async { while viewers.join_next().await.is_some() {} };
    _ = tokio::time::timeout(GOODBYE_TIMEOUT, all_gone).await;
}

/// Connections whose request is not yet read.
#[derive(Default)]
struct Waiting {
    tasks: JoinSet<Option<Admitted>>,
    /// The tasks, oldest first.
    order: VecDeque<AbortHandle>,
}

impl Waiting {
    fn add(&mut self, stream: TcpStream, guard: &Arc<Guard>) {
        self.order.retain(|task| !task.is_finished());
        if self.order.len() >= MAX_WAITING
            && let Some(oldest) = self.order.pop_front()
        {
            oldest.abort();
        }
        let guard = Arc::clone(guard);
        self.order.push_back(self.tasks.spawn(async move { guard.admit(stream).await }));
    }
}
