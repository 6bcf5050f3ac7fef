//! A program without TLS.

use crate::LiveError;
use std::convert::Infallible;
use std::path::Path;
use tokio::net::TcpStream;

/// A certificate and its key: this program was built without TLS, so there is none.
#[derive(Debug, Clone)]
pub struct TlsIdentity(Infallible);

impl TlsIdentity {
    /// Refuses every certificate.
    ///
    /// # Errors
    /// Always: says how to build a program with TLS.
    pub fn read(certificate: &Path, _key: &Path) -> Result<Self, LiveError> {
        let problem = "this program was built without TLS; build it with --features tls (needs a C compiler), or use a tunnel: \
                       ssh -L 8642:127.0.0.1:8642 ROBOT";
        Err(LiveError::Certificate { file: certificate.to_owned(), problem: problem.to_owned() })
    }

    pub(crate) async fn accept(&self, _stream: TcpStream) -> std::io::Result<TcpStream> {
        match self.0 {}
    }
}
