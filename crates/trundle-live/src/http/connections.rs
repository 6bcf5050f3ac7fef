//! Accepts connections: a bounded number, each with a bounded time for its request.

use crate::PageCertificate;
use axum::Router;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use std::sync::Arc;
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;
use tokio::time::timeout;

/// Maximum number of simultaneous connections that are not yet a viewer's link. Further ones are closed immediately. Source: ours.
const MAX_CONNECTIONS: usize = 48;
/// Longest wait for the head of a request, also between two requests, and for the start of encryption. Source: ours.
const REQUEST_TIMEOUT: Duration = Duration::from_secs(5);
/// Longest head of a request \[bytes\]. Source: ours.
const MAX_HEAD_BYTES: usize = 16 * 1024;
/// Pause after a refused accept, for example without free file descriptors. Source: ours.
const ACCEPT_PAUSE: Duration = Duration::from_millis(100);

/// Serves the routes until the task is dropped, encrypted with a certificate.
pub async fn serve(listener: TcpListener, router: Router, certificate: Option<PageCertificate>) {
    let slots = Arc::new(Semaphore::new(MAX_CONNECTIONS));
    loop {
        let Ok((stream, _)) = listener.accept().await else {
            tokio::time::sleep(ACCEPT_PAUSE).await;
            continue;
        };
        let Ok(slot) = Arc::clone(&slots).try_acquire_owned() else {
            drop(stream);
            continue;
        };
        let (router, certificate) = (router.clone(), certificate.clone());
        tokio::spawn(async move {
            open_connection(stream, router, certificate).await;
            drop(slot);
        });
    }
}

async fn open_connection(stream: TcpStream, router: Router, certificate: Option<PageCertificate>) {
    if let Err(error) = stream.set_nodelay(true) {
        tracing::debug!("live page: {error}");
    }
    let Some(certificate) = certificate else { return serve_connection(stream, router).await };
    match timeout(REQUEST_TIMEOUT, certificate.accept(stream)).await {
        Ok(Ok(encrypted)) => serve_connection(encrypted, router).await,
        Ok(Err(error)) => tracing::debug!("live page: a connection was not encrypted: {error}"),
        Err(_) => {
            tracing::debug!("live page: a connection did not begin its encryption within {REQUEST_TIMEOUT:?}")
        }
    }
}

async fn serve_connection(stream: impl AsyncRead + AsyncWrite + Send + Unpin + 'static, router: Router) {
    let served = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(REQUEST_TIMEOUT)
        .max_buf_size(MAX_HEAD_BYTES)
        .serve_connection(TokioIo::new(stream), TowerToHyperService::new(router))
        .with_upgrades();
    if let Err(error) = served.await {
        tracing::debug!("live page: a connection ended: {error}");
    }
}
