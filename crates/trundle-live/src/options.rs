//! Options of the live page.

use crate::{LiveAddress, PageCertificate, Tokens};
use trundle_app::operator::MapFolder;

/// Options of the live page.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct LiveOptions {
    /// Address of the page.
    pub address: LiveAddress,
    /// Permissions to drive and to view.
    pub tokens: Tokens,
    /// Whether the run takes commands; a replay and an experiment take none.
    pub is_steered: bool,
    /// Maps that may be loaded.
    pub maps: Option<MapFolder>,
    /// Certificate of an encrypted page.
    pub certificate: Option<PageCertificate>,
}

impl LiveOptions {
    /// A page at `address`, not encrypted.
    pub const fn new(
        address: LiveAddress,
        tokens: Tokens,
        is_steered: bool,
        maps: Option<MapFolder>,
    ) -> Self {
        Self { address, tokens, is_steered, maps, certificate: None }
    }

    /// The page encrypted by a certificate and its key, if their files are given.
    ///
    /// # Errors
    /// As [`PageCertificate::of_files`].
    #[cfg(feature = "tls")]
    pub fn encrypted(
        mut self,
        files: Option<(&std::path::Path, &std::path::Path)>,
    ) -> Result<Self, crate::LiveError> {
        self.certificate = files.map(|(chain, key)| PageCertificate::of_files(chain, key)).transpose()?;
        Ok(self)
    }
}
