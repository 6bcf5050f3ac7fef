//! Checks of the request that opens a connection.

use super::page_origin::{PageOrigin, is_allowed};
use crate::protocol::chosen_subprotocol;
use std::sync::Arc;
use tokio::net::TcpStream;
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio_tungstenite::tungstenite::handshake::server::{ErrorResponse, Request, Response};
use tokio_tungstenite::tungstenite::http::{HeaderMap, HeaderValue, StatusCode, header};
use tokio_tungstenite::tungstenite::protocol::WebSocketConfig;
use tokio_tungstenite::{WebSocketStream, accept_hdr_async_with_config};
use trundle_app::listening::{is_own_name, name_of_host};

/// Maximum number of simultaneous viewers. Source: ours, as many as the live page has.
const MAX_VIEWERS: usize = 24;
/// Largest message of a viewer \[bytes\]: subscriptions to all topics are 1 kB. Source: ours.
const MAX_MESSAGE_BYTES: usize = 64 * 1024;

/// An admitted connection. A drop frees its slot.
pub struct Admitted {
    /// The connection.
    pub socket: WebSocketStream<TcpStream>,
    /// The slot of a viewer.
    pub slot: OwnedSemaphorePermit,
}

/// Checks of the request that opens a connection.
pub struct Guard {
    is_shared: bool,
    origins: Vec<PageOrigin>,
    slots: Arc<Semaphore>,
}

impl Guard {
    /// The guard of a server; `is_shared`: other machines can reach it.
    pub fn new(is_shared: bool, origins: Vec<PageOrigin>) -> Self {
        Self { is_shared, origins, slots: Arc::new(Semaphore::new(MAX_VIEWERS)) }
    }

    /// Reads the request of a connection; `None` if it was refused. The refusal has been sent.
    pub async fn admit(&self, stream: TcpStream) -> Option<Admitted> {
        let mut slot = None;
        #[expect(clippy::result_large_err, reason = "the type of the callback is given")]
        let check = |request: &Request, mut response: Response| {
            let subprotocol = self.check(request.headers())?;
            slot = Some(self.slot()?);
            response
                .headers_mut()
                .insert(header::SEC_WEBSOCKET_PROTOCOL, HeaderValue::from_static(subprotocol));
            Ok(response)
        };
        let limits = WebSocketConfig::default()
            .max_message_size(Some(MAX_MESSAGE_BYTES))
            .max_frame_size(Some(MAX_MESSAGE_BYTES));
        match accept_hdr_async_with_config(stream, check, Some(limits)).await {
            Ok(socket) => slot.map(|slot| Admitted { socket, slot }),
            Err(error) => {
                tracing::debug!("foxglove: a connection was refused: {error}");
                None
            }
        }
    }

    /// The chosen subprotocol of an allowed request.
    #[expect(clippy::result_large_err, reason = "the error is an answer of HTTP")]
    fn check(&self, headers: &HeaderMap) -> Result<&'static str, ErrorResponse> {
        let own = headers.get(header::HOST).and_then(|host| name_of_host(host.to_str().ok()?));
        if !own.is_some_and(|name| is_own_name(name, self.is_shared)) {
            let text = "this name is none of the robot: use its address, as the program prints it";
            return Err(refusal(StatusCode::MISDIRECTED_REQUEST, text));
        }
        let mut origins = headers.get_all(header::ORIGIN).iter();
        if !origins.all(|origin| origin.to_str().is_ok_and(|origin| is_allowed(origin, &self.origins))) {
            let text = "this page may not see the robot; --foxglove-origin allows a further page";
            return Err(refusal(StatusCode::FORBIDDEN, text));
        }
        let offered = headers.get_all(header::SEC_WEBSOCKET_PROTOCOL).iter();
        let offered: Vec<&str> = offered.filter_map(|offer| offer.to_str().ok()).collect();
        chosen_subprotocol(&offered).ok_or_else(|| {
            refusal(
                StatusCode::BAD_REQUEST,
                "expected the subprotocol foxglove.sdk.v1 or foxglove.websocket.v1",
            )
        })
    }

    #[expect(clippy::result_large_err, reason = "the error is an answer of HTTP")]
    fn slot(&self) -> Result<OwnedSemaphorePermit, ErrorResponse> {
        let text = "too many viewers: close another one";
        let slot = Arc::clone(&self.slots).try_acquire_owned();
        slot.map_err(|_| refusal(StatusCode::SERVICE_UNAVAILABLE, text))
    }
}

fn refusal(status: StatusCode, text: &str) -> ErrorResponse {
    let mut response = ErrorResponse::new(Some(text.to_owned()));
    *response.status_mut() = status;
    response.headers_mut().insert(header::CONNECTION, HeaderValue::from_static("close"));
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn viewers_of_foxglove_are_limited_and_a_slot_is_free_again() {
        let guard = Guard::new(false, Vec::new());
        let slots: Vec<_> = (0..1000).map_while(|_| guard.slot().ok()).collect();
        assert_eq!(slots.len(), MAX_VIEWERS);
        drop(slots);
        assert!(guard.slot().is_ok());
    }
}
