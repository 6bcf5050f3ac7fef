//! Peers that send many requests in one go: one answer per connection, and the stop is not delayed.

use crate::browser::{Browser, fetch};
use crate::live_run::LiveRun;
use crate::many_connections::in_time;
use serde_json::json;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use trundle_live::Access;

/// Requests that a peer sends at once.
const REQUESTS: usize = 64;
/// Peers at the same time.
const PEERS: usize = 30;

/// The bytes that a peer gets for requests for the page's largest file, up to the end of the connection.
fn send_many(address: SocketAddr) -> std::io::Result<Vec<u8>> {
    let request = format!("GET /page.js HTTP/1.1\r\nHost: {address}\r\n\r\n").repeat(REQUESTS);
    let mut stream = TcpStream::connect(address)?;
    stream.write_all(request.as_bytes())?;
    let mut bytes = Vec::new();
    match stream.read_to_end(&mut bytes) {
        // The server closes the connection with requests that it has not read.
        Err(error) if error.kind() != std::io::ErrorKind::ConnectionReset => Err(error),
        _ => Ok(bytes),
    }
}

#[test]
fn requests_sent_in_one_go_get_one_answer() {
    let run = LiveRun::start();
    let bytes = send_many(run.page.address()).unwrap();
    let answers = bytes.windows(8).filter(|window| window == b"HTTP/1.1").count();
    assert_eq!(answers, 1);
    let (head, _) = fetch(run.page.address(), "GET /", &[("Host", &run.page.address().to_string())]);
    assert!(head.to_ascii_lowercase().contains("connection: close"), "{head}");
}

#[test]
fn a_flood_of_requests_does_not_delay_the_stop() {
    let run = LiveRun::start();
    let address = run.page.address();
    let mut viewer = Browser::enter(&run, Access::Drive, "driver");
    let is_over = AtomicBool::new(false);
    thread::scope(|scope| {
        for _ in 0..PEERS {
            scope.spawn(|| {
                while !is_over.load(Ordering::Relaxed) {
                    // A peer without a free place of the server tries again.
                    _ = send_many(address);
                }
            });
        }
        for _ in 0..10 {
            let refusal = in_time("stop", || viewer.ask(json!({"type": "stop"})));
            assert_eq!(refusal, None);
        }
        is_over.store(true, Ordering::Relaxed);
    });
}
