//! HTTP: the page's files, the link to a viewer, and the stop without a link.

mod assets;
mod connections;
mod files;
mod guard;
mod unencrypted;

pub use connections::serve;

use crate::access::Access;
use crate::page_state::PageState;
use crate::viewer;
use axum::extract::State;
use axum::extract::ws::{WebSocketUpgrade, rejection::WebSocketUpgradeRejection};
use axum::http::{HeaderMap, StatusCode, header};
use axum::middleware::from_fn_with_state;
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use axum::{Extension, Router};
use std::sync::Arc;
use trundle_server::Ticket;

/// Largest message of a viewer \[bytes\]: 50 goals are 4 kB. Source: ours.
const MAX_MESSAGE_BYTES: usize = 16 * 1024;

/// The routes of the page.
pub fn router(state: Arc<PageState>) -> Router {
    Router::new()
        .route("/live", get(open_link))
        .route("/stop", post(stop))
        .route("/files/{name}", get(files::file))
        .route("/maps", get(files::maps))
        .fallback(get(assets::file))
        .layer(from_fn_with_state(Arc::clone(&state), guard::check))
        .with_state(state)
}

/// A viewer's link.
async fn open_link(
    State(state): State<Arc<PageState>>,
    Extension(ticket): Extension<Ticket>,
    headers: HeaderMap,
    upgrade: Result<WebSocketUpgrade, WebSocketUpgradeRejection>,
) -> Response {
    if !guard::is_own_origin(&headers, state.certificate.is_some()) {
        return (StatusCode::FORBIDDEN, "this page may not open a link to the robot").into_response();
    }
    let upgrade = match upgrade {
        Ok(upgrade) => upgrade,
        Err(rejection) => return rejection.into_response(),
    };
    upgrade
        .max_message_size(MAX_MESSAGE_BYTES)
        .max_frame_size(MAX_MESSAGE_BYTES)
        .on_upgrade(move |socket| viewer::serve(socket, state, ticket))
}

/// The stop by a plain request, for a page whose connection does not respond.
async fn stop(State(state): State<Arc<PageState>>, headers: HeaderMap) -> Response {
    let token = headers.get(header::AUTHORIZATION).and_then(|value| value.to_str().ok());
    let access = token.and_then(|token| state.tokens.access(token.strip_prefix("Bearer ")?));
    if !guard::is_own_origin(&headers, state.certificate.is_some())
        || access != Some(Access::Drive)
        || !state.is_steered
    {
        return (StatusCode::FORBIDDEN, "this link may not stop the robot").into_response();
    }
    match state.steering.stop() {
        Ok(()) => (StatusCode::OK, "stopped").into_response(),
        Err(refusal) => (StatusCode::CONFLICT, refusal.text).into_response(),
    }
}
