//! Requests of a viewer: who may, at what rate, with which answer.

use super::progress::ViewProgress;
use super::rate_limit::RateLimit;
use crate::access::Access;
use crate::page_state::PageState;
use crate::steering::CommandRefusal;
use crate::viewer_list::ViewerId;
use crate::wire::{Reply, Request};
use axum::extract::ws::{Message, WebSocket};
use futures_util::StreamExt;
use futures_util::stream::SplitStream;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};
use tokio::sync::OwnedSemaphorePermit;
use tokio::sync::mpsc::Sender;
use tokio::task::spawn_blocking;
use trundle_app::operator::HandId;

/// Longest silence of a viewer: it answers ten views per second. Source: ours; a tab in the background answers once per second at least.
const SILENCE_TIMEOUT: Duration = Duration::from_secs(60);

/// A viewer with its requests.
pub struct Viewer<'a> {
    /// Shared state.
    pub state: &'a Arc<PageState>,
    /// Number of the viewer.
    pub id: ViewerId,
    /// Permissions of the viewer.
    pub access: Access,
    /// Views drawn by the viewer so far.
    pub progress: &'a ViewProgress,
    /// Queue of answers.
    pub answers: Sender<Reply>,
}

/// Receives requests until the link ends; why it ends.
pub async fn receive(mut stream: SplitStream<WebSocket>, viewer: Viewer<'_>) -> &'static str {
    let mut rate = RateLimit::new(Instant::now());
    loop {
        let text = match tokio::time::timeout(SILENCE_TIMEOUT, stream.next()).await {
            Err(_) => return "the viewer is silent",
            Ok(None | Some(Err(_) | Ok(Message::Close(_)))) => return "the viewer is gone",
            Ok(Some(Ok(Message::Text(text)))) => text,
            Ok(Some(Ok(Message::Binary(_)))) => return "messages of bytes are not taken",
            Ok(Some(Ok(Message::Ping(_) | Message::Pong(_)))) => String::new().into(),
        };
        if !rate.take(Instant::now()) {
            return "too many requests per second";
        }
        if text.is_empty() {
            continue;
        }
        let Ok(request) = serde_json::from_str::<Request>(&text) else {
            return "a message is not a request of this version";
        };
        if let Some(reply) = viewer.reply(&request)
            && viewer.answers.try_send(reply).is_err()
        {
            return "answers are not read";
        }
    }
}

impl Viewer<'_> {
    /// Carries out a request; returns its answer, if any.
    fn reply(&self, request: &Request) -> Option<Reply> {
        match request {
            Request::Seen { batch } => {
                self.progress.seen.fetch_max(*batch, Ordering::Relaxed);
                return None;
            }
            Request::Camera { on, depth } => {
                self.progress.wants_images.store(*on, Ordering::Relaxed);
                self.progress.wants_depth.store(*depth, Ordering::Relaxed);
                return None;
            }
            Request::VisualMap { on } => {
                self.progress.wants_visual_map.store(*on, Ordering::Relaxed);
                return None;
            }
            Request::LoadMap { id, name } => {
                return match self.may_load() {
                    Ok(claim) => {
                        self.begin_loading(*id, name.clone(), claim);
                        None
                    }
                    Err(refusal) => answer(Some(*id), Err(refusal)),
                };
            }
            _ => {}
        }
        answer(request.id(), self.execute(request))
    }

    fn may_load(&self) -> Result<OwnedSemaphorePermit, CommandRefusal> {
        self.require_drive()?;
        self.state.steering.require_robot()?;
        require_wheel(self.state, self.id)?;
        self.state.steering.claim_reading()
    }

    /// Loads a map outside the page's thread, which continues to serve viewers and the stop. The answer follows after the map is read.
    fn begin_loading(&self, id: u64, name: String, claim: OwnedSemaphorePermit) {
        let (state, viewer, answers) = (Arc::clone(self.state), self.id, self.answers.clone());
        tokio::spawn(async move {
            let reader = Arc::clone(&state);
            let read = spawn_blocking(move || {
                let _claim = claim;
                reader.steering.read_map(&name)
            });
            let read = read.await;
            // The requesting viewer may have left or lost control; the map is then discarded.
            if answers.is_closed() {
                return;
            }
            let read = read.unwrap_or_else(|_| Err(CommandRefusal::of("The map cannot be read.")));
            let loaded = read.and_then(|map| {
                require_wheel(&state, viewer)?;
                state.steering.load_map(map)
            });
            if let Some(reply) = answer(Some(id), loaded)
                && answers.send(reply).await.is_err()
            {
                tracing::debug!("live page: viewer {viewer} went before its map was loaded");
            }
        });
    }

    fn require_drive(&self) -> Result<(), CommandRefusal> {
        if !self.state.is_steered {
            return Err(CommandRefusal::of("This run takes no commands."));
        }
        if self.access != Access::Drive {
            return Err(CommandRefusal::of(
                "This link is for viewing only. The program prints another link for driving.",
            ));
        }
        Ok(())
    }

    fn execute(&self, request: &Request) -> Result<(), CommandRefusal> {
        let (state, hand) = (self.state, HandId::Viewer(self.id));
        self.require_drive()?;
        match request {
            // Every viewer with driving permission may stop.
            Request::Stop { .. } => {}
            Request::TakeWheel { .. } => {
                state.viewer_list().take(self.id);
                return Ok(());
            }
            Request::LeaveWheel { .. } => {
                if state.viewer_list().release(self.id) {
                    state.steering.end_of_hand();
                }
                return Ok(());
            }
            _ => {
                let free = require_wheel(state, self.id);
                free.inspect_err(|_| state.steering.note_refused(request, hand))?;
            }
        }
        state.steering.execute(request, hand)
    }
}

/// Gives free control to a viewer, or refuses if another viewer is in control.
fn require_wheel(state: &PageState, id: ViewerId) -> Result<(), CommandRefusal> {
    let free = state.viewer_list().require(id);
    free.map_err(|holder| CommandRefusal::of(format!("{holder} holds the wheel. Take it over first.")))
}

/// The answer to a request, if any: a request without a number is only answered by a refusal.
fn answer(id: Option<u64>, result: Result<(), CommandRefusal>) -> Option<Reply> {
    let (refusal, goal) = match result {
        Ok(()) => (None, None),
        Err(refusal) => (Some(refusal.text), refusal.goal),
    };
    match (id, refusal) {
        (Some(id), refusal) => Some(Reply::Answer { id, refusal, goal }),
        (None, Some(refusal)) => Some(Reply::Refused { refusal }),
        (None, None) => None,
    }
}
