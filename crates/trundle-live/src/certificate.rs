//! Encryption of the page by a given certificate.

/// Certificate and key of the page. Copies share them. Without the feature `tls` no value exists.
#[derive(Clone)]
pub struct PageCertificate {
    #[cfg(feature = "tls")]
    acceptor: tokio_rustls::TlsAcceptor,
    #[cfg(feature = "tls")]
    own: tokio_rustls::rustls::pki_types::CertificateDer<'static>,
    #[cfg(not(feature = "tls"))]
    never: std::convert::Infallible,
}

/// A debug text must not show the key.
impl std::fmt::Debug for PageCertificate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("PageCertificate")
    }
}

#[cfg(not(feature = "tls"))]
mod without_tls {
    //! A build without TLS: there is no certificate.

    use super::PageCertificate;
    use std::io;
    use tokio::net::TcpStream;

    impl PageCertificate {
        pub(crate) fn covers(&self, _name: &str) -> bool {
            match self.never {}
        }

        pub(crate) fn first_name(&self) -> Option<String> {
            match self.never {}
        }

        pub(crate) async fn accept(&self, _stream: TcpStream) -> io::Result<TcpStream> {
            match self.never {}
        }
    }
}

#[cfg(feature = "tls")]
mod with_tls {
    //! TLS 1.2 and 1.3 by rustls, with the cryptography of graviola, which is Rust alone.

    use super::PageCertificate;
    use crate::LiveError;
    use std::io;
    use std::path::Path;
    use std::sync::Arc;
    use tokio::net::TcpStream;
    use tokio_rustls::TlsAcceptor;
    use tokio_rustls::rustls::client::verify_server_name;
    use tokio_rustls::rustls::pki_types::pem::PemObject;
    use tokio_rustls::rustls::pki_types::{CertificateDer, PrivateKeyDer, ServerName};
    use tokio_rustls::rustls::server::ParsedCertificate;
    use tokio_rustls::rustls::{Error, ServerConfig};
    use tokio_rustls::server::TlsStream;
    use trundle_app::BoundedFile;
    use webpki::EndEntityCert;

    /// Largest file of a certificate or a key that is read \[bytes\]: a chain of ten certificates has about 20 kB. Source: ours.
    const MAX_FILE_BYTES: u64 = 256 * 1024;
    /// Protocol that the page speaks within TLS. Source: RFC 7301.
    const HTTP_1: &[u8] = b"http/1.1";

    impl PageCertificate {
        /// The certificate of a file, with the others of its chain, and the key of another file; both are PEM.
        ///
        /// # Errors
        /// When a file cannot be read, has another content, the key is not that of the certificate, or the processor cannot encrypt.
        pub fn of_files(chain: &Path, key: &Path) -> Result<Self, LiveError> {
            require_processor()?;
            let certificates = certificates(&read(chain)?).map_err(|problem| broken(chain, problem))?;
            let own = certificates.first().cloned();
            let own = own.ok_or_else(|| {
                broken(chain, "it has no certificate, expected a PEM file with BEGIN CERTIFICATE")
            })?;
            EndEntityCert::try_from(&own)
                .map_err(|problem| broken(chain, format!("not a certificate of a server: {problem}; expected X.509 version 3 with subjectAltName")))?;
            let secret = PrivateKeyDer::from_pem_slice(&read(key)?);
            let secret = secret.map_err(|_| {
                broken(key, "it has no key, expected a PEM file with BEGIN PRIVATE KEY, not encrypted")
            })?;
            let config = ServerConfig::builder_with_provider(Arc::new(rustls_graviola::default_provider()))
                .with_safe_default_protocol_versions()
                .map_err(|problem| LiveError::System(problem.to_string()))?
                .with_no_client_auth()
                .with_single_cert(certificates, secret);
            let mut config = config.map_err(|problem| refused_key(chain, key, &problem))?;
            config.alpn_protocols = vec![HTTP_1.to_vec()];
            Ok(Self { acceptor: TlsAcceptor::from(Arc::new(config)), own })
        }

        /// Whether the certificate is valid for a name or an address.
        pub(crate) fn covers(&self, name: &str) -> bool {
            let Ok(name) = ServerName::try_from(name) else { return false };
            ParsedCertificate::try_from(&self.own).is_ok_and(|own| verify_server_name(&own, &name).is_ok())
        }

        /// The first name of the certificate that is no pattern.
        pub(crate) fn first_name(&self) -> Option<String> {
            let own = EndEntityCert::try_from(&self.own).ok()?;
            own.valid_dns_names().find(|name| !name.contains('*')).map(str::to_owned)
        }

        /// The encrypted connection of a browser.
        pub(crate) async fn accept(&self, stream: TcpStream) -> io::Result<TlsStream<TcpStream>> {
            self.acceptor.accept(stream).await
        }
    }

    /// Refuses a processor without the instructions that graviola needs (its README, "Limitations").
    fn require_processor() -> Result<(), LiveError> {
        #[cfg(target_arch = "x86_64")]
        let features = [
            ("aes", std::arch::is_x86_feature_detected!("aes")),
            ("ssse3", std::arch::is_x86_feature_detected!("ssse3")),
            ("avx", std::arch::is_x86_feature_detected!("avx")),
            ("avx2", std::arch::is_x86_feature_detected!("avx2")),
            ("adx", std::arch::is_x86_feature_detected!("adx")),
            ("bmi2", std::arch::is_x86_feature_detected!("bmi2")),
            ("pclmulqdq", std::arch::is_x86_feature_detected!("pclmulqdq")),
        ];
        #[cfg(target_arch = "aarch64")]
        let features = [
            ("aes", std::arch::is_aarch64_feature_detected!("aes")),
            ("sha2", std::arch::is_aarch64_feature_detected!("sha2")),
            ("pmull", std::arch::is_aarch64_feature_detected!("pmull")),
            ("neon", std::arch::is_aarch64_feature_detected!("neon")),
        ];
        #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
        let features = [("x86-64 or aarch64", false)];
        let names: Vec<&str> =
            features.into_iter().filter_map(|(name, has)| (!has).then_some(name)).collect();
        if names.is_empty() {
            return Ok(());
        }
        let names = names.join(", ");
        Err(LiveError::System(format!(
            "the processor lacks {names}, which encryption needs; leave --live-certificate out, and use a tunnel (ssh -L)"
        )))
    }

    fn read(path: &Path) -> Result<Vec<u8>, LiveError> {
        let read = BoundedFile { path, folder: None, max_bytes: MAX_FILE_BYTES }.read();
        read.map_err(|problem| broken(path, format!("it {problem}; expected a PEM file")))
    }

    fn certificates(text: &[u8]) -> Result<Vec<CertificateDer<'static>>, String> {
        let found: Result<Vec<_>, _> = CertificateDer::pem_slice_iter(text).collect();
        found.map_err(|problem| format!("not a PEM file: {problem}"))
    }

    fn refused_key(chain: &Path, key: &Path, problem: &Error) -> LiveError {
        match problem {
            Error::InconsistentKeys(_) => {
                broken(key, format!("it is not the key of the certificate {}", chain.display()))
            }
            _ => broken(
                key,
                format!(
                    "expected a key of RSA, ECDSA (P-256, P-384) or Ed25519; this one cannot be used: {problem}"
                ),
            ),
        }
    }

    fn broken(file: &Path, problem: impl Into<String>) -> LiveError {
        LiveError::Certificate { file: file.to_owned(), problem: problem.into() }
    }
}
