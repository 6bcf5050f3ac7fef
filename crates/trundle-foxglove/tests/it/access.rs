//! Access: hosts, origins, numbers of connections, the end.

use crate::shown_run::{ShownRun, served};
use crate::viewer::Viewer;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};
use tokio_tungstenite::tungstenite::Error;

/// Longest time of a new viewer from its connection to the list of topics.
const MAX_ENTRY: Duration = Duration::from_millis(500);

/// The status of the answer to a request with these headers; `None` if it opens a connection.
fn refused(run: &ShownRun, subprotocol: &str, headers: &[(&'static str, &str)]) -> Option<u16> {
    match Viewer::connect(run.server.address(), subprotocol, headers) {
        Ok(_) => None,
        Err(Error::Http(response)) => Some(response.status().as_u16()),
        Err(error) => panic!("{headers:?}: {error}"),
    }
}

#[test]
fn a_page_of_another_origin_may_not_see_the_run() {
    let run =
        ShownRun::with_options(|options| options.origins = vec!["http://localhost:8080".parse().unwrap()]);
    let refused = |origin: &str| refused(&run, "foxglove.sdk.v1", &[("Origin", origin)]);
    for origin in ["http://evil.example", "null", "http://127.0.0.1:1", "https://evilfoxglove.dev"] {
        assert_eq!(refused(origin), Some(403), "{origin}");
    }
    for origin in ["https://app.foxglove.dev", "file://", "http://localhost:8080"] {
        assert_eq!(refused(origin), None, "{origin}");
    }
}

#[test]
fn a_name_that_was_rebound_to_this_machine_may_not_see_the_run() {
    let run = ShownRun::start();
    let port = run.server.address().port();
    let refused = |host: String| refused(&run, "foxglove.sdk.v1", &[("Host", host.as_str())]);
    for foreign in [format!("evil.example:{port}"), "192.168.1.4".to_owned(), String::new()] {
        assert_eq!(refused(foreign.clone()), Some(421), "{foreign}");
    }
    assert_eq!(refused(format!("localhost:{port}")), None);
}

#[test]
fn foxglove_and_lichtblick_agree_on_a_subprotocol_and_others_are_refused() {
    let run = ShownRun::start();
    let address = run.server.address();
    let chosen = |offer: &str| Viewer::connect(address, offer, &[]).unwrap().subprotocol;
    assert_eq!(chosen("foxglove.websocket.v1"), "foxglove.websocket.v1");
    assert_eq!(chosen("foxglove.sdk.v1.1, foxglove.sdk.v1"), "foxglove.sdk.v1");
    assert_eq!(refused(&run, "chat", &[]), Some(400));
}

#[test]
fn silent_connections_of_one_peer_do_not_lock_a_viewer_out() {
    for count in [60, 500] {
        let run = ShownRun::start();
        let address = run.server.address();
        let mut first = Viewer::enter(address);
        first.wait_for("advertise");
        let idle: Vec<TcpStream> = (0..count).filter_map(|_| TcpStream::connect(address).ok()).collect();
        assert_eq!(idle.len(), count);
        let start = Instant::now();
        let mut second = Viewer::enter(address);
        second.wait_for("advertise");
        assert!(start.elapsed() < MAX_ENTRY, "{count}: {:?}", start.elapsed());
        second.subscribe(1, 1);
        first.subscribe(1, 1);
        assert!(second.wait_for_data(1).nanos > 0 && first.wait_for_data(1).nanos > 0);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_peer_with_many_connections_closes_none_of_another_peer_of_foxglove() {
    let run = ShownRun::start();
    let address = run.server.address();
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    let mut other = runtime.block_on(async {
        let socket = tokio::net::TcpSocket::new_v4().unwrap();
        socket.bind(([127, 0, 0, 2], 0).into()).unwrap();
        socket.connect(address).await.unwrap().into_std().unwrap()
    });
    other.set_nonblocking(false).unwrap();
    let _idle: Vec<TcpStream> = (0..500).filter_map(|_| TcpStream::connect(address).ok()).collect();
    write!(
        other,
        "GET / HTTP/1.1\r\nHost: evil.example\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n\
         Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
    )
    .unwrap();
    let mut answer = [0; 12];
    other.read_exact(&mut answer).unwrap();
    assert_eq!(&answer, b"HTTP/1.1 421", "the connection was not closed, and its Host is checked");
}

#[test]
fn a_broken_or_endless_request_ends_and_not_the_server() {
    let run = ShownRun::start();
    let address = run.server.address();
    for request in [b"\x16\x03\x01\x00".repeat(10), b"GET / HTTP/1.1\r\n\r\n".to_vec(), vec![b'A'; 1_000_000]]
    {
        let mut stream = TcpStream::connect(address).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
        // The server may close the connection during the request.
        _ = stream.write_all(&request);
        // The end of the connection, possibly by a reset.
        _ = stream.read_to_end(&mut Vec::new());
    }
    Viewer::enter(address).wait_for("advertise");
}

#[test]
fn viewers_learn_the_end_of_the_run_and_a_silent_one_does_not_hold_it_up() {
    let (server, _link) = served();
    let mut viewer = Viewer::enter(server.address());
    let _silent = TcpStream::connect(server.address()).unwrap();
    viewer.wait_for("advertise");
    let start = Instant::now();
    drop(server);
    assert!(start.elapsed() < Duration::from_secs(10));
    assert_eq!(viewer.wait_for_close(), (1001, "the run has ended".to_owned()));
}

#[test]
fn other_machines_are_warned_of_and_an_address_in_use_is_an_error() {
    let run = ShownRun::with_options(|options| options.address = "0.0.0.0:0".parse().unwrap());
    let shared = run.server.announcement();
    assert!(shared.contains("who connects sees all that the robot sees"), "{shared}");
    let own = ShownRun::start().server.announcement();
    assert!(own.starts_with("Foxglove, to view only: ws://127.0.0.1:") && !own.contains("warning"), "{own}");
    let (operator, _link) = trundle_app::operator::operator_link();
    let options = trundle_foxglove::FoxgloveOptions::new(run.server.address(), String::new());
    let error = trundle_foxglove::FoxgloveServer::start(options, operator).unwrap_err().to_string();
    assert!(error.contains("--foxglove 0.0.0.0:") && error.contains("another address"), "{error}");
}
