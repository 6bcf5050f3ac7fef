//! State that all viewers of a page share.

use crate::history::History;
use crate::run_facts::RunFacts;
use crate::steering::RunSteering;
use crate::viewer_list::ViewerList;
use crate::wire::MapTiles;
use crate::{LiveOptions, PageCertificate, Tokens};
use std::sync::{Mutex, MutexGuard, PoisonError};
use trundle_app::listening::is_shared;
use trundle_app::operator::Operator;
use trundle_server::EndNotice;

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
    /// Informs the viewers of the end of the program.
    pub end: EndNotice,
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
            is_shared: is_shared(options.address.socket),
            certificate: options.certificate,
            facts,
            end: EndNotice::default(),
            viewer_list: Mutex::default(),
            tiles: Mutex::default(),
            history: Mutex::default(),
        }
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
