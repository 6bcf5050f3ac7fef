//! Checks of every answer: a Host that is this machine, and headers that keep other pages away.

use crate::page_state::PageState;
use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use std::sync::Arc;
use trundle_app::listening::{is_own_name, name_of_host};

/// Checks the Host of a request and adds the headers of every answer.
pub async fn check(State(state): State<Arc<PageState>>, request: Request, next: Next) -> Response {
    let host = host_of(request.headers()).map(str::to_owned);
    let is_encrypted = state.certificate.is_some();
    let Some(host) = host.filter(|host| is_own_host(host, &state)) else {
        let text = "this name is none of the robot: use its address, as the program prints it";
        return with_headers((StatusCode::MISDIRECTED_REQUEST, text).into_response(), "", is_encrypted);
    };
    with_headers(next.run(request).await, &host, is_encrypted)
}

/// Whether a request comes from the page itself: browsers report a page of another origin in this header. A request without the header does
/// not come from a browser's page and is refused too.
pub fn is_own_origin(headers: &HeaderMap, is_encrypted: bool) -> bool {
    let origin = headers.get(header::ORIGIN).and_then(|origin| origin.to_str().ok());
    let scheme = if is_encrypted { "https" } else { "http" };
    let own = host_of(headers).map(|host| format!("{scheme}://{host}"));
    origin.is_some() && origin == own.as_deref()
}

fn host_of(headers: &HeaderMap) -> Option<&str> {
    headers.get(header::HOST)?.to_str().ok()
}

/// Whether a Host is a name of this machine, or one of its certificate. A page that rebinds its own name to this machine would send that
/// name. An address cannot be rebound, and a browser that meets the certificate under another name opens no page.
fn is_own_host(host: &str, state: &PageState) -> bool {
    let Some(name) = name_of_host(host) else { return false };
    is_own_name(name, state.is_shared) || state.certificate.as_ref().is_some_and(|own| own.covers(name))
}

fn with_headers(mut response: Response, host: &str, is_encrypted: bool) -> Response {
    let scheme = if is_encrypted { "wss" } else { "ws" };
    let policy = format!(
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; \
         connect-src 'self' {scheme}://{host}; manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    );
    let fixed = [
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::X_FRAME_OPTIONS, "DENY"),
        (header::REFERRER_POLICY, "no-referrer"),
        (header::CACHE_CONTROL, "no-store"),
    ];
    // A connection carries one answer: requests sent in one go without a token would else be answered before the stop of another
    // connection. The answer that opens a viewer's link keeps its own header.
    let opens_link = response.status() == StatusCode::SWITCHING_PROTOCOLS;
    let headers = response.headers_mut();
    if !opens_link {
        headers.insert(header::CONNECTION, HeaderValue::from_static("close"));
    }
    if let Ok(policy) = HeaderValue::from_str(&policy) {
        headers.insert(header::CONTENT_SECURITY_POLICY, policy);
    }
    for (name, value) in fixed {
        headers.insert(name, HeaderValue::from_static(value));
    }
    for name in ["cross-origin-opener-policy", "cross-origin-resource-policy"] {
        headers.insert(name, HeaderValue::from_static("same-origin"));
    }
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_origin_and_none_are_foreign() {
        let headers = |origin: Option<&'static str>| {
            let mut headers = HeaderMap::new();
            headers.insert(header::HOST, HeaderValue::from_static("127.0.0.1:8642"));
            origin.map(|origin| headers.insert(header::ORIGIN, HeaderValue::from_static(origin)));
            headers
        };
        assert!(is_own_origin(&headers(Some("http://127.0.0.1:8642")), false));
        assert!(is_own_origin(&headers(Some("https://127.0.0.1:8642")), true));
        assert!(
            !is_own_origin(&headers(Some("http://127.0.0.1:8642")), true),
            "a page without encryption is another one"
        );
        for foreign in [None, Some("http://evil.example"), Some("null"), Some("http://127.0.0.1:8643")] {
            assert!(!is_own_origin(&headers(foreign), false), "{foreign:?}");
        }
    }
}
