//! A browser: its hello, then the data sent to it and its requests.

mod hello;
mod outbox;
mod progress;
mod rate_limit;
mod requests;
mod updates;

use crate::page_state::PageState;
use crate::viewer_list::ViewerId;
use axum::extract::ws::WebSocket;
use futures_util::StreamExt;
use outbox::{Close, Outbox};
use progress::ViewProgress;
use std::sync::Arc;
use tokio::sync::mpsc;

/// Maximum number of answers waiting for a viewer. A viewer with more is too slow for its own requests, and its link ends. Source: ours.
const MAX_WAITING_ANSWERS: usize = 64;

/// Serves a viewer until it disconnects, is silent or breaks a rule.
pub async fn serve(mut socket: WebSocket, state: Arc<PageState>, id: ViewerId) {
    if let Some(access) = hello::receive(&mut socket, &state, id).await {
        let (sink, stream) = socket.split();
        let (answers, waiting) = mpsc::channel(MAX_WAITING_ANSWERS);
        let progress = ViewProgress::default();
        let mut outbox = Outbox::new(sink);
        let close = tokio::select! {
            reason = requests::receive(stream, requests::Viewer { state: &state, id, access, progress: &progress, answers }) => Close::Rule(reason),
            reason = updates::send(&mut outbox, &state, id, &progress, waiting) => Close::Rule(reason),
            () = state.ended() => Close::ProgramEnded,
        };
        tracing::debug!("live page: viewer {id}: {}", close.reason());
        outbox.close(close).await;
    }
    if state.viewer_list().leave(id) {
        state.steering.end_of_hand();
    }
}
