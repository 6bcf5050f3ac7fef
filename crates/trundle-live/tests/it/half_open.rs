//! Connections that stop in the middle of a message and stay open.

use crate::browser::Browser;
use crate::live_run::LiveRun;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::{Duration, Instant};
use trundle_live::Access;

/// Longest wait for the end of a connection: the server waits 5 s for a request or a hello; a loaded machine takes longer.
const PATIENCE: Duration = Duration::from_secs(60);

/// A connection that has sent `start` and sends no more.
fn half_open(address: SocketAddr, start: &[u8]) -> TcpStream {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    stream.write_all(start).unwrap();
    stream
}

/// The bytes that arrive until the server ends the connection.
fn read_to_end(stream: &mut TcpStream) -> Vec<u8> {
    let mut bytes = Vec::new();
    match stream.read_to_end(&mut bytes) {
        Ok(_) => {}
        Err(error) if error.kind() == std::io::ErrorKind::ConnectionReset => {}
        Err(error) => panic!("the connection stays open: {error}"),
    }
    bytes
}

fn wait_for_viewers(viewer: &mut Browser, count: usize) {
    let start = Instant::now();
    while viewer.wait_for("state")["viewers"] != count {
        assert!(start.elapsed() < PATIENCE, "not {count} viewers within {PATIENCE:?}");
    }
}

#[test]
fn half_a_hello_ends_its_link_and_no_other() {
    let run = LiveRun::start();
    let address = run.page.address();
    let mut viewer = Browser::enter(&run, Access::View, "first");
    let upgrade = format!(
        "GET /live HTTP/1.1\r\nHost: {address}\r\nOrigin: http://{address}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n\
         Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
    );
    let mut half = half_open(address, upgrade.as_bytes());
    // A masked text of 100 bytes, of which 20 come.
    half.write_all(&[0x81, 0x80 | 100, 0, 0, 0, 0]).unwrap();
    half.write_all(br#"{"type":"hello","ver"#).unwrap();
    let bytes = read_to_end(&mut half);
    assert!(bytes.starts_with(b"HTTP/1.1 101"), "{}", String::from_utf8_lossy(&bytes));
    let no_hello = 4408_u16.to_be_bytes();
    assert!(bytes.windows(2).any(|pair| pair == no_hello), "closed without the code: {bytes:?}");
    wait_for_viewers(&mut viewer, 1);
}
