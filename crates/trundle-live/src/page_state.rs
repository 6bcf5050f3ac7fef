//! State that all viewers of a page share.

use crate::history::History;
use crate::run_facts::RunFacts;
use crate::steering::RunSteering;
use crate::viewer_list::ViewerList;
use crate::wire::MapTiles;
use crate::{LiveOptions, PageCertificate, Tokens};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tokio::sync::watch;
use trundle_app::operator::Operator;

/// State that all viewers of a page share. One thread serves them; no lock is held while the thread waits.
#[derive(Debug)]
pub struct PageState {
    /// The run.
    pub operator: Operator,
    /// Permissions to drive and to view.
    pub tokens: Tokens,
    /// Whether the run takes commands.
    pub is_steered: bool,
    /// Whether other machines can reach the page.
    pub is_shared: bool,
    /// Certificate of an encrypted page.
    pub certificate: Option<PageCertificate>,
    /// Facts of the run, sent once.
    pub facts: RunFacts,
    /// Sends commands.
    pub steering: RunSteering,
    /// Whether the program is about to end.
    end: watch::Sender<bool>,
    viewer_list: Mutex<ViewerList>,
    tiles: Mutex<MapTiles>,
    history: Mutex<History>,
}

impl PageState {
    /// The state of a page without viewers.
    pub fn new(options: LiveOptions, operator: Operator, facts: RunFacts) -> Self {
        Self {
            steering: RunSteering::new(operator.clone(), &facts, options.maps),
            operator,
            tokens: options.tokens,
            is_steered: options.is_steered,
            is_shared: options.address.is_shared(),
            certificate: options.certificate,
            facts,
            end: watch::Sender::new(false),
            viewer_list: Mutex::default(),
            tiles: Mutex::default(),
            history: Mutex::default(),
        }
    }

    /// Informs all viewers that the program is about to end.
    pub fn end(&self) {
        self.end.send_replace(true);
    }

    /// Waits until the program is about to end.
    pub async fn ended(&self) {
        // The sender lives as long as this state.
        _ = self.end.subscribe().wait_for(|is_over| *is_over).await;
    }

    /// The viewers.
    pub fn viewer_list(&self) -> MutexGuard<'_, ViewerList> {
        self.viewer_list.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The newest map.
    pub fn tiles(&self) -> MutexGuard<'_, MapTiles> {
        self.tiles.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The last minutes.
    pub fn history(&self) -> MutexGuard<'_, History> {
        self.history.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
