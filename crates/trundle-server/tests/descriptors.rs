//! A server without free file descriptors: one line in the log, and it goes on afterwards. This test has a process of its own, because it
//! lowers the limit of the process.
#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
use std::fs::File;
use std::io::{self, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpSocket;
use tokio::runtime::Runtime;
use trundle_server::{EndNotice, Listener, ServerThread};

/// Longest wait for an answer.
const PATIENCE: Duration = Duration::from_secs(3);

/// The lines of the log.
#[derive(Clone, Default)]
struct Lines(Arc<Mutex<Vec<u8>>>);

impl Write for Lines {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        Write::write(&mut *self.0.lock().unwrap(), bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Answers the first byte of each connection by the same byte, and keeps the connection until its end.
async fn echo(listener: Listener) {
    let answer = async |mut stream: tokio::net::TcpStream, ticket: trundle_server::Ticket| {
        while let Ok(byte) = stream.read_u8().await {
            ticket.heard();
            if stream.write_u8(byte).await.is_err() {
                return;
            }
        }
    };
    listener.serve(&EndNotice::default(), answer).await;
}

fn is_answered(mut stream: &TcpStream) -> bool {
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    stream.write_all(b"x").is_ok() && matches!(stream.read(&mut [0; 1]), Ok(1))
}

/// Leaves no file descriptor free; the files that hold them.
fn take_all_descriptors() -> Vec<File> {
    let limit = getrlimit(Resource::Nofile);
    setrlimit(Resource::Nofile, Rlimit { current: Some(64), ..limit }).unwrap();
    std::iter::from_fn(|| File::open("/dev/null").ok()).collect()
}

/// Connections that wait to be accepted, by sockets that exist already.
fn connect(runtime: &Runtime, sockets: Vec<TcpSocket>, address: SocketAddr) -> Vec<TcpStream> {
    let connect = async |socket: TcpSocket| {
        let stream = socket.connect(address).await.unwrap().into_std().unwrap();
        stream.set_nonblocking(false).unwrap();
        stream
    };
    sockets.into_iter().map(|socket| runtime.block_on(connect(socket))).collect()
}

#[test]
fn a_lack_of_file_descriptors_is_one_line_and_the_server_goes_on() {
    let lines = Lines::default();
    let written = lines.clone();
    tracing_subscriber::fmt().with_ansi(false).with_writer(move || written.clone()).init();
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let server = ServerThread::start("echo", listener, echo).unwrap();
    let heard = TcpStream::connect(address).unwrap();
    assert!(is_answered(&heard));
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    let sockets = (0..3).map(|_| TcpSocket::new_v4().unwrap()).collect();
    let files = take_all_descriptors();
    let waiting = connect(&runtime, sockets, address);
    std::thread::sleep(Duration::from_secs(1));
    assert!(is_answered(&heard), "who is in stays in");
    let text = String::from_utf8(lines.0.lock().unwrap().clone()).unwrap();
    assert_eq!(text.lines().count(), 1, "{text}");
    assert!(text.contains("echo: a connection is not accepted") && text.contains("ulimit -n"), "{text}");
    drop(files);
    assert!(waiting.iter().all(is_answered), "the server goes on");
    drop(server);
}
