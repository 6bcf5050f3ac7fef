//! A small browser: plain HTTP, and a link in place of a page.

use crate::live_run::LiveRun;
use futures_util::{SinkExt, StreamExt};
use serde_json::{Value, json};
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::Duration;
use tokio::runtime::Runtime;
use tokio_tungstenite::tungstenite::client::IntoClientRequest;
use tokio_tungstenite::tungstenite::{Error, Message};
use tokio_tungstenite::{MaybeTlsStream, WebSocketStream, connect_async};
use trundle_live::{Access, WIRE_VERSION};

/// The answer to a request of plain HTTP: its head and its body.
pub fn fetch(address: SocketAddr, request: &str, headers: &[(&str, &str)]) -> (String, String) {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(5))).unwrap();
    let headers: String = headers.iter().map(|(name, value)| format!("{name}: {value}\r\n")).collect();
    write!(stream, "{request} HTTP/1.1\r\nConnection: close\r\n{headers}\r\n").unwrap();
    let mut text = Vec::new();
    stream.read_to_end(&mut text).unwrap();
    let text = String::from_utf8_lossy(&text).into_owned();
    let (head, body) = text.split_once("\r\n\r\n").unwrap();
    (head.to_owned(), body.to_owned())
}

/// A page with its link. Messages that a test does not request are dropped.
pub struct Browser {
    runtime: Runtime,
    socket: WebSocketStream<MaybeTlsStream<tokio::net::TcpStream>>,
    /// Whether the browser confirms drawn views.
    pub draws: bool,
    last_id: u64,
}

impl Browser {
    /// Opens a link as a page of `origin`.
    pub fn connect(run: &LiveRun, origin: Option<&str>) -> Result<Self, Error> {
        let address = run.page.address();
        let mut request = format!("ws://{address}/live").into_client_request()?;
        let own = format!("http://{address}");
        let origin = origin.map_or(Some(own.as_str()), |origin| (!origin.is_empty()).then_some(origin));
        origin.map(|origin| request.headers_mut().insert("Origin", origin.parse().unwrap()));
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        let (socket, _) = runtime.block_on(connect_async(request))?;
        Ok(Self { runtime, socket, draws: true, last_id: 0 })
    }

    /// Opens a link and sends the hello.
    pub fn enter(run: &LiveRun, access: Access, name: &str) -> Self {
        let mut browser = Self::connect(run, None).unwrap();
        browser.hello(run.token(access), name);
        assert_eq!(browser.wait_for("welcome")["version"], WIRE_VERSION);
        browser
    }

    /// Says hello.
    pub fn hello(&mut self, token: &str, name: &str) {
        self.send(&json!({"type": "hello", "version": WIRE_VERSION, "token": token, "name": name}));
    }

    /// Sends a message.
    pub fn send(&mut self, message: &Value) {
        self.send_text(message.to_string()).unwrap();
    }

    /// Sends a text.
    pub fn send_text(&mut self, text: String) -> Result<(), Error> {
        self.runtime.block_on(self.socket.send(Message::Text(text.into())))
    }

    /// Sends a request and waits for its answer; returns the refusal, if any.
    pub fn ask(&mut self, mut request: Value) -> Option<String> {
        self.last_id += 1;
        request["id"] = self.last_id.into();
        self.send(&request);
        loop {
            let answer = self.wait_for("answer");
            if answer["id"] == self.last_id {
                return answer["refusal"].as_str().map(str::to_owned);
            }
        }
    }

    /// The next message; the code and the reason if the server closes the link.
    pub fn next(&mut self) -> Result<Message, (u16, String)> {
        let next = async { tokio::time::timeout(Duration::from_secs(10), self.socket.next()).await };
        match self.runtime.block_on(next).expect("the server is silent") {
            Some(Ok(Message::Close(Some(frame)))) => Err((frame.code.into(), frame.reason.to_string())),
            Some(Ok(message)) => Ok(message),
            Some(Err(_)) | None => Err((0, String::new())),
        }
    }

    /// Waits for a message of a type.
    pub fn wait_for(&mut self, kind: &str) -> Value {
        loop {
            let message = self.next().unwrap_or_else(|closed| panic!("{kind}: closed: {closed:?}"));
            let Message::Text(text) = message else { continue };
            let value: Value = serde_json::from_str(&text).unwrap();
            if value["type"] == "state" && self.draws {
                self.send(&json!({"type": "seen", "batch": value["batch"]}));
            }
            if value["type"] == kind {
                return value;
            }
        }
    }

    /// Reads until the server closes the link: the code and the reason.
    pub fn wait_for_close(&mut self) -> (u16, String) {
        loop {
            if let Err(closed) = self.next() {
                return closed;
            }
        }
    }
}
