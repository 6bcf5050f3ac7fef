//! Connections of browsers: encryption, then requests, each within a bounded time.

use super::unencrypted;
use crate::page_state::PageState;
use axum::Router;
use hyper::body::Incoming;
use hyper::server::conn::http1;
use hyper::service::{Service, service_fn};
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use std::sync::Arc;
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::net::TcpStream;
use trundle_server::{Listener, SILENT_TIMEOUT, Ticket};

/// Longest head of a request \[bytes\]. Source: ours.
const MAX_HEAD_BYTES: usize = 16 * 1024;

/// Serves the routes until the end of the page, encrypted with a certificate.
pub async fn serve(listener: Listener, state: &Arc<PageState>) {
    let router = super::router(Arc::clone(state));
    let open = |stream, ticket| open_connection(stream, ticket, router.clone(), Arc::clone(state));
    listener.serve(&state.end, open).await;
}

async fn open_connection(stream: TcpStream, ticket: Ticket, router: Router, state: Arc<PageState>) {
    let Some(certificate) = &state.certificate else { return serve_connection(stream, ticket, router).await };
    if unencrypted::is_plain(&stream).await {
        return unencrypted::refuse(stream, certificate).await;
    }
    match certificate.accept(stream).await {
        Ok(encrypted) => serve_connection(encrypted, ticket, router).await,
        Err(error) => tracing::debug!("live page: a connection was not encrypted: {error}"),
    }
}

/// Serves the requests of a connection. Each takes the ticket along, for a link that has to end.
async fn serve_connection(
    stream: impl AsyncRead + AsyncWrite + Send + Unpin + 'static,
    ticket: Ticket,
    router: Router,
) {
    let router = TowerToHyperService::new(router);
    let answer = move |mut request: hyper::Request<Incoming>| {
        ticket.heard();
        request.extensions_mut().insert(ticket.clone());
        router.call(request)
    };
    let served = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(SILENT_TIMEOUT)
        .max_buf_size(MAX_HEAD_BYTES)
        .serve_connection(TokioIo::new(stream), service_fn(answer))
        .with_upgrades();
    if let Err(error) = served.await {
        tracing::debug!("live page: a connection ended: {error}");
    }
}
