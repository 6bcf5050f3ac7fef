//! The first message of a viewer: version and token.

use crate::access::Access;
use crate::page_state::PageState;
use crate::viewer_list::ViewerId;
use crate::wire::{Reply, Request, WIRE_VERSION, Welcome};
use axum::extract::ws::{CloseFrame, Message, WebSocket};
use std::time::Duration;

/// Longest wait for the hello. Source: ours.
const HELLO_TIMEOUT: Duration = Duration::from_secs(5);
/// Close code of a wrong token. Source: ours, of the range for applications.
const WRONG_TOKEN: u16 = 4401;
/// Close code of another version of the messages. Source: ours, of the range for applications.
const OTHER_VERSION: u16 = 4406;
/// Close code of a link without hello. Source: ours, of the range for applications.
const NO_HELLO: u16 = 4408;
/// Close code of a viewer beyond the maximum number. Source: the registry of RFC 6455, 1013: try again later.
const TOO_MANY_VIEWERS: u16 = 1013;

/// Receives the hello: the access of its token, and the viewer's name. `None` without the permission to view.
pub async fn receive(socket: &mut WebSocket, state: &PageState) -> Option<(Access, String)> {
    let first = tokio::time::timeout(HELLO_TIMEOUT, socket.recv()).await;
    let Ok(Some(Ok(Message::Text(text)))) = first else {
        return refuse(socket, NO_HELLO, "a hello with the token comes first").await;
    };
    let Ok(Request::Hello { version, token, name }) = serde_json::from_str(&text) else {
        return refuse(socket, NO_HELLO, "a hello with the token comes first").await;
    };
    let Some(access) = state.tokens.access(&token) else {
        return refuse(socket, WRONG_TOKEN, "the token is wrong: open the link that the program prints")
            .await;
    };
    if version != WIRE_VERSION {
        return refuse(socket, OTHER_VERSION, "the page is of another version: load it anew").await;
    }
    Some((access, name))
}

/// Adds and welcomes a viewer; `None` if there are too many, or this one has gone.
pub async fn enter(
    socket: &mut WebSocket,
    state: &PageState,
    access: Access,
    name: &str,
) -> Option<ViewerId> {
    let entered = state.viewer_list().enter(name);
    let Some(id) = entered else {
        return refuse(socket, TOO_MANY_VIEWERS, "too many viewers: close another page").await;
    };
    if welcome(socket, state, access).await {
        return Some(id);
    }
    state.viewer_list().leave(id);
    None
}

/// Sends the facts of the run. Returns whether the viewer received them.
async fn welcome(socket: &mut WebSocket, state: &PageState, access: Access) -> bool {
    let facts = &state.facts;
    let welcome = Welcome {
        drives: access == Access::Drive && state.is_steered,
        is_steered: state.is_steered,
        kind: facts.kind,
        ..Welcome::new(facts.title.clone(), &facts.footprint, facts.limits, facts.recording)
    };
    let Ok(text) = serde_json::to_string(&Reply::Welcome(Box::new(welcome))) else { return false };
    let sent = tokio::time::timeout(HELLO_TIMEOUT, socket.send(Message::Text(text.into()))).await;
    matches!(sent, Ok(Ok(())))
}

async fn refuse<T>(socket: &mut WebSocket, code: u16, reason: &'static str) -> Option<T> {
    let close = Message::Close(Some(CloseFrame { code, reason: reason.into() }));
    if !matches!(tokio::time::timeout(HELLO_TIMEOUT, socket.send(close)).await, Ok(Ok(()))) {
        tracing::debug!("live page: a viewer went before its refusal");
    }
    None
}
