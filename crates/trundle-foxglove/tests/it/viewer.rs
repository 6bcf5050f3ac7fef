//! A viewer as Foxglove is one: a WebSocket client with subscriptions.

use futures_util::{SinkExt, StreamExt};
use serde_json::{Value, json};
use std::net::SocketAddr;
use std::time::Duration;
use tokio::runtime::Runtime;
use tokio_tungstenite::tungstenite::client::IntoClientRequest;
use tokio_tungstenite::tungstenite::{Error, Message};
use tokio_tungstenite::{MaybeTlsStream, WebSocketStream, connect_async};

/// A message with data: number of the subscription, stamp \[ns\], content.
#[derive(Debug, PartialEq, Eq)]
pub struct Data {
    pub subscription: u32,
    pub nanos: u64,
    pub content: Vec<u8>,
}

/// A viewer.
pub struct Viewer {
    runtime: Runtime,
    socket: WebSocketStream<MaybeTlsStream<tokio::net::TcpStream>>,
    /// The chosen subprotocol.
    pub subprotocol: String,
    kept: Vec<Data>,
}

impl Viewer {
    /// Connects with these headers besides the usual ones.
    pub fn connect(
        address: SocketAddr,
        subprotocol: &str,
        headers: &[(&'static str, &str)],
    ) -> Result<Self, Error> {
        let mut request = format!("ws://{address}/").into_client_request()?;
        request.headers_mut().insert("Sec-WebSocket-Protocol", subprotocol.parse().unwrap());
        for (name, value) in headers {
            request.headers_mut().insert(*name, value.parse().unwrap());
        }
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        let (socket, response) = runtime.block_on(connect_async(request))?;
        let chosen = response.headers()["Sec-WebSocket-Protocol"].to_str().unwrap().to_owned();
        Ok(Self { runtime, socket, subprotocol: chosen, kept: Vec::new() })
    }

    /// Connects as Foxglove's desktop program.
    pub fn enter(address: SocketAddr) -> Self {
        Self::connect(address, "foxglove.sdk.v1", &[]).unwrap()
    }

    /// Subscribes to a channel.
    pub fn subscribe(&mut self, id: u32, channel: u64) {
        self.send_json(&json!({"op": "subscribe", "subscriptions": [{"id": id, "channelId": channel}]}));
    }

    /// Sends a message of JSON.
    pub fn send_json(&mut self, message: &Value) {
        self.send(Message::Text(message.to_string().into())).unwrap();
    }

    /// Sends a message.
    pub fn send(&mut self, message: Message) -> Result<(), Error> {
        self.runtime.block_on(self.socket.send(message))
    }

    /// The next message; the code and the reason if the server closes the connection.
    fn next(&mut self) -> Result<Message, (u16, String)> {
        let next = async { tokio::time::timeout(Duration::from_secs(10), self.socket.next()).await };
        match self.runtime.block_on(next).expect("the server is silent") {
            Some(Ok(Message::Close(Some(frame)))) => Err((frame.code.into(), frame.reason.to_string())),
            Some(Ok(message)) => Ok(message),
            Some(Err(_)) | None => Err((0, String::new())),
        }
    }

    /// Waits for a message of JSON with this `op`.
    pub fn wait_for(&mut self, op: &str) -> Value {
        loop {
            let message = self.next().unwrap_or_else(|closed| panic!("{op}: closed: {closed:?}"));
            let Message::Text(text) = message else { continue };
            let value: Value = serde_json::from_str(&text).unwrap();
            if value["op"] == op {
                return value;
            }
        }
    }

    /// Waits for data of a subscription. Data of others is kept.
    pub fn wait_for_data(&mut self, subscription: u32) -> Data {
        loop {
            if let Some(at) = self.kept.iter().position(|data| data.subscription == subscription) {
                return self.kept.remove(at);
            }
            let data = self.next_data();
            self.kept.push(data);
        }
    }

    /// The next data that arrives.
    pub fn next_data(&mut self) -> Data {
        loop {
            let message = self.next().unwrap_or_else(|closed| panic!("data: closed: {closed:?}"));
            let Message::Binary(bytes) = message else { continue };
            assert_eq!(bytes[0], 1, "the code of data");
            let subscription = u32::from_le_bytes(bytes[1..5].try_into().unwrap());
            let nanos = u64::from_le_bytes(bytes[5..13].try_into().unwrap());
            return Data { subscription, nanos, content: bytes[13..].to_vec() };
        }
    }

    /// Reads until the server closes the connection: the code and the reason.
    pub fn wait_for_close(&mut self) -> (u16, String) {
        loop {
            if let Err(closed) = self.next() {
                return closed;
            }
        }
    }
}
