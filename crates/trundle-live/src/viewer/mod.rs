//! A browser: its hello, then the data sent to it and its requests.

mod hello;
mod outbox;
mod progress;
mod rate_limit;
mod requests;
mod updates;

use crate::access::Access;
use crate::page_state::PageState;
use crate::viewer_list::ViewerId;
use axum::extract::ws::WebSocket;
use futures_util::StreamExt;
use outbox::{Close, Outbox};
use progress::ViewProgress;
use std::sync::Arc;
use tokio::sync::mpsc;
use trundle_server::Ticket;

/// Maximum number of answers waiting for a viewer. A viewer with more is too slow for its own requests, and its link ends. Source: ours.
const MAX_WAITING_ANSWERS: usize = 64;

/// Serves a viewer until it disconnects, is silent or breaks a rule. Until the hello, the link may have to close in favour of another one.
pub async fn serve(mut socket: WebSocket, state: Arc<PageState>, ticket: Ticket) {
    let hello = tokio::select! {
        hello = hello::receive(&mut socket, &state) => hello,
        () = ticket.closed() => None,
    };
    let Some((access, name)) = hello else { return };
    // The list of viewers counts the link from now on.
    ticket.leave();
    let Some(id) = hello::enter(&mut socket, &state, access, &name).await else { return };
    serve_viewer(socket, &state, id, access).await;
    if state.viewer_list().leave(id) {
        state.steering.end_of_hand();
    }
}

async fn serve_viewer(socket: WebSocket, state: &Arc<PageState>, id: ViewerId, access: Access) {
    let mut end = state.end.reader();
    let (sink, stream) = socket.split();
    let (answers, waiting) = mpsc::channel(MAX_WAITING_ANSWERS);
    let progress = ViewProgress::default();
    let mut outbox = Outbox::new(sink);
    let close = tokio::select! {
        reason = requests::receive(stream, requests::Viewer { state, id, access, progress: &progress, answers }) => Close::Rule(reason),
        reason = updates::send(&mut outbox, state, id, &progress, waiting) => Close::Rule(reason),
        () = end.ended() => Close::ProgramEnded,
    };
    tracing::debug!("live page: viewer {id}: {}", close.reason());
    outbox.close(close).await;
}
