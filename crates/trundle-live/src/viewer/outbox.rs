//! Sends messages to a viewer, each within a bounded time.

use axum::extract::ws::{CloseFrame, Message, WebSocket};
use futures_util::SinkExt;
use futures_util::stream::SplitSink;
use serde::Serialize;
use std::time::Duration;

/// Longest time for the delivery of one message: a viewer that takes longer counts as lost. Source: ours.
const SEND_TIMEOUT: Duration = Duration::from_secs(20);
/// Close code of a viewer that broke a rule. Source: RFC 6455, 7.4.1.
const POLICY_CLOSE_CODE: u16 = 1008;

/// Close code of a program that ends. Source: RFC 6455, 7.4.1.
const GOING_AWAY_CLOSE_CODE: u16 = 1001;

/// The reason for closing a link.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Close {
    /// The viewer broke a rule or closed the connection.
    Rule(&'static str),
    /// The program ends.
    ProgramEnded,
}

impl Close {
    /// The reason in words.
    pub fn reason(self) -> &'static str {
        match self {
            Self::Rule(reason) => reason,
            Self::ProgramEnded => "the program has ended",
        }
    }

    fn code(self) -> u16 {
        match self {
            Self::Rule(_) => POLICY_CLOSE_CODE,
            Self::ProgramEnded => GOING_AWAY_CLOSE_CODE,
        }
    }
}

/// Sends messages to a viewer.
pub struct Outbox {
    sink: SplitSink<WebSocket, Message>,
}

impl Outbox {
    /// The sending half of a link.
    pub fn new(sink: SplitSink<WebSocket, Message>) -> Self {
        Self { sink }
    }

    /// Sends bytes. Returns whether the viewer received them.
    pub async fn send_bytes(&mut self, bytes: Vec<u8>) -> bool {
        self.send(Message::Binary(bytes.into())).await
    }

    /// Sends a value as JSON. Returns whether the viewer received it.
    pub async fn send_json(&mut self, value: &impl Serialize) -> bool {
        match serde_json::to_string(value) {
            Ok(text) => self.send(Message::Text(text.into())).await,
            Err(error) => {
                tracing::error!("live page: a message has no JSON: {error}");
                false
            }
        }
    }

    /// Closes the link.
    pub async fn close(&mut self, close: Close) {
        let frame = CloseFrame { code: close.code(), reason: close.reason().into() };
        let close = Message::Close(Some(frame));
        let closing = tokio::time::timeout(Duration::from_secs(1), self.sink.send(close));
        if !matches!(closing.await, Ok(Ok(()))) {
            tracing::debug!("live page: a viewer went without a close");
        }
    }

    async fn send(&mut self, message: Message) -> bool {
        matches!(tokio::time::timeout(SEND_TIMEOUT, self.sink.send(message)).await, Ok(Ok(())))
    }
}
