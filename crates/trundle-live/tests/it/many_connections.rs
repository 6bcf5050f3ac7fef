//! A peer that opens many connections and sends nothing, or very slowly: viewers come in and stay in.

use crate::browser::{Browser, fetch};
use crate::live_run::LiveRun;
use serde_json::json;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::{Duration, Instant};
use trundle_live::Access;

/// Longest time of a new viewer from its connection to its welcome, and of a request.
pub const MAX_ENTRY: Duration = Duration::from_millis(500);
/// Longest wait for the end of a connection: the server waits 5 s for a request; a loaded machine takes longer.
const PATIENCE: Duration = Duration::from_secs(30);

/// `count` connections that have sent `start` and send no more.
pub fn half_open(address: SocketAddr, count: usize, start: &[u8]) -> Vec<TcpStream> {
    let open = |_| {
        let mut stream = TcpStream::connect(address).ok()?;
        // The server may have closed the connection in favour of a newer one.
        _ = stream.write_all(start);
        Some(stream)
    };
    let opened: Vec<_> = (0..count).filter_map(open).collect();
    assert_eq!(opened.len(), count);
    opened
}

/// Asserts that `work` takes at most [`MAX_ENTRY`]; its result.
pub fn in_time<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    let elapsed = start.elapsed();
    assert!(elapsed < MAX_ENTRY, "{what}: {elapsed:?}");
    result
}

/// Asserts that a new viewer gets the page, enters and stops the robot, and that the viewer of before goes on.
fn assert_open(run: &LiveRun, before: &mut Browser) {
    let address = run.page.address();
    let (head, _) = in_time("GET /", || fetch(address, "GET /", &[("Host", &address.to_string())]));
    assert!(head.starts_with("HTTP/1.1 200"), "{head}");
    let mut viewer = in_time("link", || Browser::enter(run, Access::Drive, "new"));
    assert_eq!(viewer.ask(json!({"type": "stop"})), None);
    assert_eq!(before.ask(json!({"type": "stop"})), None, "who is in stays in");
    before.wait_for("state");
}

#[test]
fn half_open_connections_of_one_peer_do_not_hold_up_a_new_viewer() {
    for count in [60, 500] {
        let run = LiveRun::start();
        let mut before = Browser::enter(&run, Access::Drive, "before");
        let _silent = half_open(run.page.address(), count, b"");
        assert_open(&run, &mut before);
    }
}

#[test]
fn requests_that_come_one_byte_per_second_end_and_hold_up_nobody() {
    let run = LiveRun::start();
    let address = run.page.address();
    let mut before = Browser::enter(&run, Access::Drive, "before");
    let start = Instant::now();
    let mut slow =
        half_open(address, 60, format!("GET / HTTP/1.1\r\nHost: {address}\r\nX-Slow: ").as_bytes());
    assert_open(&run, &mut before);
    while !slow.is_empty() {
        assert!(start.elapsed() < PATIENCE, "{} slow requests are open after {PATIENCE:?}", slow.len());
        std::thread::sleep(Duration::from_secs(1));
        slow.retain_mut(|stream| {
            stream.set_nonblocking(true).unwrap();
            let is_over = matches!(stream.read(&mut [0; 1024]), Ok(0));
            !is_over && stream.write_all(b"a").is_ok()
        });
    }
    assert!(start.elapsed() > Duration::from_secs(4), "a slow network is given some seconds");
}

#[test]
fn answered_requests_and_links_without_hello_do_not_hold_up_a_new_viewer() {
    let run = LiveRun::start();
    let address = run.page.address();
    let mut before = Browser::enter(&run, Access::Drive, "before");
    let request = format!("GET / HTTP/1.1\r\nHost: {address}\r\n\r\n");
    let _answered = half_open(address, 60, request.as_bytes());
    assert_open(&run, &mut before);
    let upgrade = format!(
        "GET /live HTTP/1.1\r\nHost: {address}\r\nOrigin: http://{address}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n\
         Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
    );
    let _links = half_open(address, 60, upgrade.as_bytes());
    assert_open(&run, &mut before);
}

/// A connection from another address of this machine.
#[cfg(target_os = "linux")]
fn connect_from(from: [u8; 4], to: SocketAddr) -> TcpStream {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    let stream = runtime.block_on(async {
        let socket = tokio::net::TcpSocket::new_v4().unwrap();
        socket.bind((from, 0).into()).unwrap();
        socket.connect(to).await.unwrap().into_std().unwrap()
    });
    stream.set_nonblocking(false).unwrap();
    stream
}

#[cfg(target_os = "linux")]
#[test]
fn a_peer_with_many_connections_closes_none_of_another_peer() {
    let run = LiveRun::start();
    let address = run.page.address();
    let mut others: Vec<_> = (2..12).map(|i| connect_from([127, 0, 0, i], address)).collect();
    let _silent = half_open(address, 500, b"");
    for other in &mut others {
        write!(other, "GET / HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\n\r\n").unwrap();
        let mut answer = Vec::new();
        other.read_to_end(&mut answer).unwrap();
        assert!(answer.starts_with(b"HTTP/1.1 200"), "{}", String::from_utf8_lossy(&answer));
    }
}
