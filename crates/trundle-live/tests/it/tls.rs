//! A page that is encrypted by a given certificate.

use crate::browser::fetch;
use crate::live_run::LiveRun;
use crate::many_connections::{half_open, in_time};
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use tokio_rustls::TlsConnector;
use tokio_rustls::rustls::pki_types::pem::PemObject;
use tokio_rustls::rustls::pki_types::{CertificateDer, ServerName};
use tokio_rustls::rustls::{ClientConfig, ClientConnection, RootCertStore, StreamOwned};
use tokio_tungstenite::client_async;
use tokio_tungstenite::tungstenite::Error;
use tokio_tungstenite::tungstenite::client::IntoClientRequest;
use trundle_live::{Access, PageCertificate};

/// A test's certificate and key, made by `openssl req -x509` for `*.robots.example`, `robot.example` and 127.0.0.1.
fn files() -> (PathBuf, PathBuf) {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    (data.join("certificate.pem"), data.join("key.pem"))
}

fn encrypted_run() -> LiveRun {
    let (chain, key) = files();
    LiveRun::with_options(true, |options| {
        options.certificate = Some(PageCertificate::of_files(&chain, &key).unwrap());
    })
}

/// What a browser knows that trusts the certificate.
fn client() -> Arc<ClientConfig> {
    let mut roots = RootCertStore::empty();
    roots.add(CertificateDer::from_pem_file(files().0).unwrap()).unwrap();
    let config = ClientConfig::builder_with_provider(Arc::new(rustls_graviola::default_provider()));
    let config = config.with_safe_default_protocol_versions().unwrap().with_root_certificates(roots);
    Arc::new(config.with_no_client_auth())
}

/// The head of the answer to a request with the Host `host`, over TLS as `name`.
fn head(address: SocketAddr, name: &str, request: &str, headers: &[(&str, &str)]) -> String {
    let connection = ClientConnection::new(client(), ServerName::try_from(name.to_owned()).unwrap()).unwrap();
    let stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(5))).unwrap();
    let mut stream = StreamOwned::new(connection, stream);
    let headers: String = headers.iter().map(|(name, value)| format!("{name}: {value}\r\n")).collect();
    write!(stream, "{request} HTTP/1.1\r\nConnection: close\r\n{headers}\r\n").unwrap();
    let mut text = Vec::new();
    stream.read_to_end(&mut text).unwrap();
    String::from_utf8_lossy(&text).split("\r\n\r\n").next().unwrap().to_owned()
}

#[test]
fn an_encrypted_page_names_its_scheme_and_is_served() {
    let run = encrypted_run();
    let address = run.page.address();
    let link = run.page.link(Access::Drive).unwrap();
    assert!(link.starts_with(&format!("https://{address}/#")), "{link}");
    let host = address.to_string();
    let answer = head(address, "127.0.0.1", "GET /", &[("Host", &host)]);
    assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
    assert!(answer.contains(&format!("connect-src 'self' wss://{host};")), "{answer}");
}

#[test]
fn a_request_without_encryption_is_told_the_encrypted_link_and_nothing_else() {
    let run = encrypted_run();
    let address = run.page.address();
    for request in ["GET /", "GET /page.js", "POST /stop", "\u{1}\u{2}"] {
        let (head, body) = fetch(address, request, &[("Host", &address.to_string())]);
        assert!(head.starts_with("HTTP/1.1 400 ") && head.contains("text/plain"), "{request}: {head}");
        assert!(body.contains("encrypted") && body.contains(&format!("https://{address}/#")), "{body}");
        assert!(
            !body.contains(run.token(Access::View)) && !body.contains(run.token(Access::Drive)),
            "{body}"
        );
    }
}

#[test]
fn half_open_handshakes_of_one_peer_do_not_hold_up_a_new_viewer() {
    // The head of a record of 512 bytes, and the first bytes of a hello.
    let half_of_hello = [0x16, 3, 1, 2, 0, 1, 0, 1, 0xfc, 3, 3];
    for (count, start) in
        [(60, &[][..]), (60, &half_of_hello), (500, &[]), (500, &half_of_hello), (60, b"GET / HT")]
    {
        let run = encrypted_run();
        let address = run.page.address();
        let _silent = half_open(address, count, start);
        let host = address.to_string();
        let answer = in_time("GET / by TLS", || head(address, "127.0.0.1", "GET /", &[("Host", &host)]));
        assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
        let status = in_time("link by TLS", || open_link(address, &format!("https://{address}")).unwrap());
        assert_eq!(status, 101);
    }
}

#[test]
fn names_of_the_certificate_are_names_of_the_machine() {
    let run = encrypted_run();
    let address = run.page.address();
    for (host, status) in [("robot.example", 200), ("kitchen.robots.example", 200), ("evil.example", 421)] {
        let host = format!("{host}:{}", address.port());
        let answer = head(address, "robot.example", "GET /", &[("Host", &host)]);
        assert!(answer.starts_with(&format!("HTTP/1.1 {status}")), "{host}: {answer}");
    }
}

#[test]
fn the_link_of_an_encrypted_page_belongs_to_its_own_origin() {
    let run = encrypted_run();
    let address = run.page.address();
    assert_eq!(open_link(address, &format!("https://{address}")).unwrap(), 101);
    for foreign in [format!("http://{address}"), "https://evil.example".to_owned()] {
        assert!(open_link(address, &foreign).is_err(), "{foreign}");
    }
}

/// The status of the answer to a page of `origin` that opens a link by TLS.
fn open_link(address: SocketAddr, origin: &str) -> Result<u16, Error> {
    let mut request = format!("wss://{address}/live").into_client_request()?;
    request.headers_mut().insert("Origin", origin.parse().unwrap());
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    runtime.block_on(async {
        let stream = tokio::net::TcpStream::connect(address).await.unwrap();
        let name = ServerName::try_from("127.0.0.1").unwrap();
        let stream = TlsConnector::from(client()).connect(name, stream).await.unwrap();
        client_async(request, stream).await.map(|(_, response)| response.status().as_u16())
    })
}

#[test]
fn files_that_are_no_certificate_or_no_key_are_named() {
    let (chain, key) = files();
    let place = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let file = place.path().join(name);
        std::fs::write(&file, text).unwrap();
        file
    };
    let refused = |chain: &Path, key: &Path| PageCertificate::of_files(chain, key).unwrap_err().to_string();
    let absent = refused(&place.path().join("absent.pem"), &key);
    assert!(absent.contains("absent.pem") && absent.contains("No such file"), "{absent}");
    assert!(refused(&key, &key).contains("it has no certificate, expected a PEM file"));
    assert!(refused(Path::new("/dev/null"), &key).contains("is no regular file"));
    assert!(refused(&chain, &chain).contains("it has no key, expected a PEM file"));
    assert!(refused(&file("text", "hello"), &key).contains("it has no certificate"));
    assert!(
        refused(&file("large", &"-".repeat(300_000)), &key)
            .contains("has 300000 bytes, expected at most 262144")
    );
    let broken = "-----BEGIN CERTIFICATE-----\nAAAA\n-----END CERTIFICATE-----\n";
    assert!(refused(&file("broken", broken), &key).contains("not a certificate of a server"));
    // An Ed25519 key, made by `openssl genpkey`.
    let other = "-----BEGIN PRIVATE KEY-----\nMC4CAQAwBQYDK2VwBCIEIGgpExKNXU992ugVTxjsMfgPCoTjVKhAx182CmJsjT4/\n-----END PRIVATE KEY-----\n";
    let other = refused(&chain, &file("other", other));
    assert!(other.contains("it is not the key of the certificate"), "{other}");
}
