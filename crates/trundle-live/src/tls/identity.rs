//! A certificate and its key.

use super::certificate::{read_certificates, read_key, require_valid_now};
use crate::LiveError;
use std::fmt;
use std::path::Path;
use std::sync::Arc;
use tokio::net::TcpStream;
use tokio_rustls::TlsAcceptor;
use tokio_rustls::rustls::crypto::ring::default_provider;
use tokio_rustls::rustls::{Error, ServerConfig};
use tokio_rustls::server::TlsStream;

/// A certificate and its key, with which the page is encrypted.
#[derive(Clone)]
pub struct TlsIdentity {
    acceptor: TlsAcceptor,
}

impl TlsIdentity {
    /// Reads a certificate with its chain and its key, both PEM.
    ///
    /// # Errors
    /// Names the file: it cannot be read, holds something else, the certificate is not valid now, or the key is that of another one.
    pub fn read(certificate: &Path, key: &Path) -> Result<Self, LiveError> {
        let chain = read_certificates(certificate)?;
        let private_key = read_key(key)?;
        require_valid_now(certificate, &chain)?;
        let builder = ServerConfig::builder_with_provider(Arc::new(default_provider()));
        let builder =
            builder.with_safe_default_protocol_versions().map_err(|error| broken(certificate, error))?;
        let config = builder.with_no_client_auth().with_single_cert(chain, private_key);
        let mut config = config.map_err(|error| match error {
            Error::InconsistentKeys(_) => {
                let problem = format!("the key is not that of the certificate {}", certificate.display());
                LiveError::Certificate { file: key.to_owned(), problem }
            }
            error => broken(key, error),
        })?;
        config.alpn_protocols = vec![b"http/1.1".to_vec()];
        Ok(Self { acceptor: TlsAcceptor::from(Arc::new(config)) })
    }

    pub(crate) async fn accept(&self, stream: TcpStream) -> std::io::Result<TlsStream<TcpStream>> {
        self.acceptor.accept(stream).await
    }
}

fn broken(file: &Path, error: Error) -> LiveError {
    LiveError::Certificate { file: file.to_owned(), problem: error.to_string() }
}

/// A debug text must not show a key.
impl fmt::Debug for TlsIdentity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("TlsIdentity")
    }
}
