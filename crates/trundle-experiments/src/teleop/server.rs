//! The server of the page: HTTP on the loopback address, one thread a connection.

use super::page::TeleopPage;
use std::io::{Read, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;
use trundle_app::AppError;

/// Connections at a time; further ones are closed. Source: ours.
const MAX_CONNECTIONS: usize = 16;

/// Time without data after which a connection is closed. Source: ours.
const CONNECTION_TIMEOUT: Duration = Duration::from_secs(2);

/// Size of a request \[bytes\]; the rest is not read. Source: ours.
const MAX_REQUEST_BYTES: usize = 8192;

/// Serves a [`TeleopPage`] to browsers on this machine only, until the program ends.
#[derive(Debug)]
pub struct TeleopServer {
    address: SocketAddr,
    page: Arc<TeleopPage>,
}

impl TeleopServer {
    /// Serves `page` at 127.0.0.1, at a port that is free.
    ///
    /// # Errors
    /// When the machine refuses a port.
    pub fn start(page: TeleopPage) -> Result<Self, AppError> {
        let refused = |error| AppError::Environment(format!("cannot serve a page at 127.0.0.1: {error}"));
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).map_err(refused)?;
        let address = listener.local_addr().map_err(refused)?;
        let page = Arc::new(page);
        let shared = Arc::clone(&page);
        std::thread::Builder::new()
            .name("page".to_owned())
            .spawn(move || receive(&listener, &shared))
            .map_err(refused)?;
        Ok(Self { address, page })
    }

    /// The page's address.
    #[must_use]
    pub fn url(&self) -> String {
        format!("http://{}/", self.address)
    }

    /// The page.
    #[must_use]
    pub fn page(&self) -> &TeleopPage {
        &self.page
    }
}

/// A thread a connection: browsers open connections ahead of need and send nothing on them.
fn receive(listener: &TcpListener, page: &Arc<TeleopPage>) {
    let connections = Arc::new(AtomicUsize::new(0));
    for stream in listener.incoming().flatten() {
        if connections.load(Ordering::Relaxed) >= MAX_CONNECTIONS {
            continue;
        }
        connections.fetch_add(1, Ordering::Relaxed);
        let (page, count) = (Arc::clone(page), Arc::clone(&connections));
        let handler = std::thread::Builder::new().spawn(move || {
            let _ = serve(stream, &page); // a closed connection is not a failure
            count.fetch_sub(1, Ordering::Relaxed);
        });
        if handler.is_err() {
            connections.fetch_sub(1, Ordering::Relaxed);
        }
    }
}

fn serve(mut stream: TcpStream, page: &TeleopPage) -> std::io::Result<()> {
    stream.set_read_timeout(Some(CONNECTION_TIMEOUT))?;
    stream.set_write_timeout(Some(CONNECTION_TIMEOUT))?;
    let request = read_head(&mut stream)?;
    let mut words = request.split_whitespace();
    let content = match (words.next(), words.next()) {
        (Some("GET"), Some(path)) => page.get(path),
        _ => None,
    };
    let (status, mime, bytes) = match content {
        Some(content) => ("200 OK", content.mime, content.bytes),
        None => ("404 Not Found", "text/plain", b"not here".to_vec()),
    };
    let length = bytes.len();
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {mime}\r\nContent-Length: {length}\r\n\
         Cache-Control: no-store\r\nConnection: close\r\n\r\n"
    );
    stream.write_all(head.as_bytes())?;
    stream.write_all(&bytes)
}

/// The request up to its empty line.
fn read_head(stream: &mut TcpStream) -> std::io::Result<String> {
    let mut request = Vec::new();
    let mut chunk = [0; 1024];
    while !request.windows(4).any(|end| end == b"\r\n\r\n") && request.len() < MAX_REQUEST_BYTES {
        match stream.read(&mut chunk)? {
            0 => break,
            count => request.extend_from_slice(&chunk[..count]),
        }
    }
    Ok(String::from_utf8_lossy(&request).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::OccupancyGrid;

    fn ask(server: &TeleopServer, request: &[u8]) -> String {
        let mut stream = TcpStream::connect(server.address).unwrap();
        stream.write_all(request).unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        String::from_utf8_lossy(&answer).into_owned()
    }

    #[test]
    fn it_answers_get_and_survives_everything_else() {
        let server =
            TeleopServer::start(TeleopPage::new(OccupancyGrid::from_ascii(0.5, "#.").unwrap())).unwrap();
        assert!(server.address.ip().is_loopback() && server.url().starts_with("http://127.0.0.1:"));
        let idle = TcpStream::connect(server.address).unwrap();
        drop(TcpStream::connect(server.address).unwrap());
        let page = ask(&server, b"GET / HTTP/1.1\r\nHost: x\r\n\r\n");
        assert!(page.starts_with("HTTP/1.1 200 OK\r\n") && page.contains("<title>trundle sim</title>"));
        assert!(ask(&server, b"GET /color.jpg HTTP/1.1\r\n\r\n").starts_with("HTTP/1.1 404"));
        assert!(ask(&server, b"POST / HTTP/1.1\r\n\r\n").starts_with("HTTP/1.1 404"));
        assert!(ask(&server, b"\xff\xfe\r\n\r\n").starts_with("HTTP/1.1 404"));
        assert!(ask(&server, &[b'a'; MAX_REQUEST_BYTES]).starts_with("HTTP/1.1 404"));
        drop(idle);
    }
}
