//! The encrypted page, as a client that knows its certificate sees it, and certificates that cannot be used.

use crate::live_run::LiveRun;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tokio_rustls::rustls::crypto::ring::default_provider;
use tokio_rustls::rustls::pki_types::pem::PemObject;
use tokio_rustls::rustls::pki_types::{CertificateDer, ServerName};
use tokio_rustls::rustls::{ClientConfig, ClientConnection, RootCertStore, Stream};
use trundle_live::{Access, TlsIdentity};

/// A file of `tests/tls`, made by its `make.sh`.
fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/tls").join(name)
}

/// An answer over TLS, by a client that trusts the certificate of the tests alone.
fn fetch(address: SocketAddr, request: &str, headers: &[(&str, &str)]) -> std::io::Result<String> {
    let mut roots = RootCertStore::empty();
    roots.add(CertificateDer::from_pem_file(file("page.crt")).unwrap()).unwrap();
    let builder = ClientConfig::builder_with_provider(Arc::new(default_provider()));
    let config = builder.with_safe_default_protocol_versions().unwrap().with_root_certificates(roots);
    let name = ServerName::try_from("127.0.0.1").unwrap();
    let mut client = ClientConnection::new(Arc::new(config.with_no_client_auth()), name).unwrap();
    let mut socket = TcpStream::connect(address)?;
    let mut stream = Stream::new(&mut client, &mut socket);
    let headers: String = headers.iter().map(|(name, value)| format!("{name}: {value}\r\n")).collect();
    write!(stream, "{request} HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\n{headers}\r\n")?;
    let mut text = Vec::new();
    match stream.read_to_end(&mut text) {
        Err(error) if text.is_empty() => Err(error),
        _ => Ok(String::from_utf8_lossy(&text).into_owned()),
    }
}

#[test]
fn an_encrypted_page_serves_its_own_origin_and_no_other() {
    let run = LiveRun::encrypted(TlsIdentity::read(&file("page.crt"), &file("page.key")).unwrap());
    let address = run.page.address();
    assert!(run.page.link(Access::Drive).unwrap().starts_with("https://127.0.0.1:"));
    let page = fetch(address, "GET /", &[]).unwrap();
    assert!(page.starts_with("HTTP/1.1 200") && page.contains(&format!("wss://{address}")), "{page}");
    let token = format!("Bearer {}", run.token(Access::Drive));
    let stop = |origin: &str| {
        fetch(address, "POST /stop", &[("Origin", origin), ("Authorization", &token)]).unwrap()
    };
    assert!(stop(&format!("https://{address}")).starts_with("HTTP/1.1 200"));
    assert!(stop(&format!("http://{address}")).starts_with("HTTP/1.1 403"));
}

#[test]
fn a_client_that_does_not_encrypt_gets_no_page() {
    let run = LiveRun::encrypted(TlsIdentity::read(&file("page.crt"), &file("page.key")).unwrap());
    let mut stream = TcpStream::connect(run.page.address()).unwrap();
    write!(stream, "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n").unwrap();
    let mut answer = Vec::new();
    _ = stream.read_to_end(&mut answer);
    assert!(!String::from_utf8_lossy(&answer).contains("HTTP/1.1"));
}

#[test]
fn files_that_cannot_be_used_are_named_with_the_reason() {
    let problem = |certificate: &str, key: &str| {
        TlsIdentity::read(&file(certificate), &file(key)).unwrap_err().to_string()
    };
    let cases = [
        ("none.crt", "page.key", "none.crt: No such file"),
        ("page.crt", "none.key", "none.key: No such file"),
        ("page.key", "page.key", "page.key: no PEM item; expected -----BEGIN CERTIFICATE-----"),
        ("page.crt", "page.crt", "page.crt: no PEM item; expected -----BEGIN PRIVATE KEY-----"),
        ("make.sh", "page.key", "expected -----BEGIN CERTIFICATE-----"),
        ("page.crt", "other.key", "other.key: the key is not that of the certificate"),
        ("expired.crt", "page.key", "expired.crt: the certificate expired"),
        ("future.crt", "page.key", "future.crt: the certificate is valid in"),
    ];
    for (certificate, key, expected) in cases {
        let problem = problem(certificate, key);
        assert!(problem.contains(expected), "{certificate}, {key}: {problem}");
    }
}
