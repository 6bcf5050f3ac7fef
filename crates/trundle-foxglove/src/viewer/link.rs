//! The connection of a viewer: messages both ways, each within a bounded time.

use super::feed::Feed;
use crate::protocol::{advertise, server_info};
use crate::topic::RunTopic;
use futures_util::{SinkExt, StreamExt};
use std::convert::Infallible;
use std::time::{Duration, SystemTime, UNIX_EPOCH};
use tokio::net::TcpStream;
use tokio::time::{Instant, MissedTickBehavior, interval, timeout};
use tokio_tungstenite::WebSocketStream;
use tokio_tungstenite::tungstenite::protocol::CloseFrame;
use tokio_tungstenite::tungstenite::protocol::frame::coding::CloseCode;
use tokio_tungstenite::tungstenite::{Bytes, Message};
use trundle_app::operator::Operator;
use trundle_server::EndReader;

/// Period of views. Source: ours.
const VIEW_PERIOD: Duration = Duration::from_millis(50);
/// Longest time for the delivery of one message: a viewer that takes longer counts as lost. Source: ours.
const SEND_TIMEOUT: Duration = Duration::from_secs(20);
/// Longest time for the delivery of a close. Source: ours.
const CLOSE_TIMEOUT: Duration = Duration::from_secs(1);
/// Period of pings. Source: ours.
const PING_PERIOD: Duration = Duration::from_secs(5);
/// Longest silence of a viewer, which answers each ping. Source: ours.
const SILENCE_TIMEOUT: Duration = Duration::from_secs(60);
/// Maximum number of refused messages of a viewer; a further one ends the connection. Source: ours.
const MAX_REFUSALS: u32 = 100;

/// A run that viewers display.
pub struct ShownRun {
    name: String,
    /// Distinguishes this run from an earlier one at the same address.
    session: String,
    operator: Operator,
}

impl ShownRun {
    /// The run with this name.
    pub fn new(name: String, operator: Operator) -> Self {
        let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        Self { name, session: since.as_millis().to_string(), operator }
    }
}

/// Why a connection ends.
#[derive(Debug, Clone, Copy)]
enum End {
    /// The viewer has gone or takes nothing.
    Gone,
    /// The viewer broke a rule.
    Rule(&'static str),
    /// The run has ended.
    RunEnded,
}

/// Serves a viewer until it disconnects or breaks a rule, or the run ends.
pub async fn serve(mut socket: WebSocketStream<TcpStream>, run: &ShownRun, mut server: EndReader) {
    let mut link = Link::new(&mut socket);
    let end = tokio::select! {
        end = link.talk(run) => end,
        () = server.ended() => End::RunEnded,
    };
    tracing::debug!("foxglove: a connection ended: {end:?}");
    let (code, reason) = match end {
        End::Gone => return,
        End::Rule(reason) => (CloseCode::Policy, reason),
        End::RunEnded => (CloseCode::Away, "the run has ended"),
    };
    let close = Message::Close(Some(CloseFrame { code, reason: reason.into() }));
    // The connection ends all the same.
    _ = timeout(CLOSE_TIMEOUT, socket.send(close)).await;
}

/// A viewer with its connection.
struct Link<'s> {
    socket: &'s mut WebSocketStream<TcpStream>,
    feed: Feed,
    /// Time of the viewer's last message.
    heard: Instant,
    refusals: u32,
}

impl<'s> Link<'s> {
    fn new(socket: &'s mut WebSocketStream<TcpStream>) -> Self {
        Self { socket, feed: Feed::default(), heard: Instant::now(), refusals: 0 }
    }

    /// Sends and receives until the connection has to end.
    async fn talk(&mut self, run: &ShownRun) -> End {
        let Err(end) = self.send_and_receive(run).await;
        end
    }

    async fn send_and_receive(&mut self, run: &ShownRun) -> Result<Infallible, End> {
        let (mut ticks, mut pings) = (interval(VIEW_PERIOD), interval(PING_PERIOD));
        ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
        self.send_text(server_info(&run.name, &run.session)).await?;
        self.send_text(advertise()).await?;
        loop {
            tokio::select! {
                received = self.socket.next() => self.on_message(received.and_then(Result::ok)).await?,
                _ = ticks.tick() => self.send_views(&run.operator).await?,
                _ = pings.tick() => self.ping().await?,
            }
        }
    }

    async fn on_message(&mut self, message: Option<Message>) -> Result<(), End> {
        self.heard = Instant::now();
        let refusal = match message {
            None | Some(Message::Close(_)) => return Err(End::Gone),
            Some(Message::Text(text)) => self.feed.take(&text).err(),
            Some(Message::Binary(_)) => Some(Feed::refusal()),
            Some(_) => None,
        };
        let Some(refusal) = refusal else { return Ok(()) };
        self.refusals += 1;
        if self.refusals > MAX_REFUSALS {
            return Err(End::Rule("too many refused messages"));
        }
        self.send_text(refusal).await
    }

    /// Sends what the viewer lacks of the newest view.
    async fn send_views(&mut self, operator: &Operator) -> Result<(), End> {
        let Some(view) = self.feed.view(operator) else { return Ok(()) };
        for topic in RunTopic::ALL {
            if let Some(bytes) = self.feed.message(topic, &view) {
                self.send(Message::Binary(bytes.into())).await?;
            }
        }
        Ok(())
    }

    async fn ping(&mut self) -> Result<(), End> {
        if self.heard.elapsed() > SILENCE_TIMEOUT {
            return Err(End::Rule("the viewer is silent"));
        }
        self.send(Message::Ping(Bytes::new())).await
    }

    async fn send_text(&mut self, text: String) -> Result<(), End> {
        self.send(Message::Text(text.into())).await
    }

    async fn send(&mut self, message: Message) -> Result<(), End> {
        match timeout(SEND_TIMEOUT, self.socket.send(message)).await {
            Ok(Ok(())) => Ok(()),
            _ => Err(End::Gone),
        }
    }
}
