//! The map as files for viewers, and the names of maps to load.

use crate::page_state::PageState;
use axum::extract::{Path, State};
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{IntoResponse, Response};
use std::sync::Arc;
use tokio::task::spawn_blocking;
use trundle_app::operator::map_file;

/// A file of the newest map; for every valid token.
pub async fn file(
    State(state): State<Arc<PageState>>,
    Path(name): Path<String>,
    headers: HeaderMap,
) -> Response {
    if !may_look(&state, &headers) {
        return (StatusCode::FORBIDDEN, "this link may not view the run").into_response();
    }
    let Some(map) = state.operator.view().and_then(|view| view.map.clone()) else {
        return (StatusCode::CONFLICT, "there is no map yet").into_response();
    };
    match map_file(&name, &map.grid, &state.operator.annotations()) {
        Some(bytes) => ([(header::CONTENT_TYPE, "application/octet-stream")], bytes).into_response(),
        None => (StatusCode::NOT_FOUND, "there is no such file").into_response(),
    }
}

/// The names of the maps to load, as JSON; for every valid token.
pub async fn maps(State(state): State<Arc<PageState>>, headers: HeaderMap) -> Response {
    if !may_look(&state, &headers) {
        return (StatusCode::FORBIDDEN, "this link may not view the run").into_response();
    }
    // The folder may be slow, as one of another machine.
    let Ok(names) = spawn_blocking(move || state.steering.map_names()).await else {
        return (StatusCode::INTERNAL_SERVER_ERROR, "the folder of maps cannot be read").into_response();
    };
    let names = serde_json::Value::from(names);
    ([(header::CONTENT_TYPE, "application/json")], names.to_string()).into_response()
}

fn may_look(state: &PageState, headers: &HeaderMap) -> bool {
    let token = headers.get(header::AUTHORIZATION).and_then(|value| value.to_str().ok());
    token.and_then(|token| state.tokens.access(token.strip_prefix("Bearer ")?)).is_some()
}
