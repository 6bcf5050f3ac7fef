//! Access: hosts, origins, tokens, and forbidden messages of viewers.

use crate::browser::{Browser, fetch};
use crate::live_run::LiveRun;
use serde_json::json;
use std::net::TcpStream;
use tokio_tungstenite::tungstenite::Error;
use trundle_live::Access;

#[test]
fn the_page_comes_with_headers_that_keep_others_away() {
    let run = LiveRun::start();
    let address = run.page.address();
    let host = address.to_string();
    let (head, body) = fetch(address, "GET /", &[("Host", &host)]);
    assert!(head.starts_with("HTTP/1.1 200"), "{head}");
    let head = head.to_lowercase();
    for needed in [
        "content-type: text/html",
        "x-content-type-options: nosniff",
        "frame-ancestors 'none'",
        "default-src 'none'",
        "referrer-policy: no-referrer",
        "cross-origin-resource-policy: same-origin",
    ] {
        assert!(head.contains(needed), "{needed}: {head}");
    }
    assert!(body.contains("<canvas"));
    assert!(!head.contains("access-control-allow"), "no other page reads an answer");
    assert!(fetch(address, "GET /../Cargo.toml", &[("Host", &host)]).0.starts_with("HTTP/1.1 404"));
}

#[test]
fn a_name_that_was_rebound_to_this_machine_is_misdirected() {
    let run = LiveRun::start();
    let address = run.page.address();
    let foreign = format!("evil.example:{}", address.port());
    for host in [foreign.as_str(), "192.168.1.4", ""] {
        for request in ["GET /", "GET /live", "POST /stop"] {
            let (head, _) = fetch(address, request, &[("Host", host)]);
            assert!(head.starts_with("HTTP/1.1 421"), "{request} {host}: {head}");
        }
    }
}

#[test]
fn a_page_of_another_origin_can_neither_look_nor_stop() {
    let run = LiveRun::start();
    for origin in ["http://evil.example", "null", "http://127.0.0.1:1", ""] {
        match Browser::connect(&run, Some(origin)) {
            Err(Error::Http(response)) => assert_eq!(response.status(), 403, "{origin}"),
            other => panic!("{origin}: {:?}", other.map(drop)),
        }
    }
    let address = run.page.address();
    let (host, bearer) = (address.to_string(), format!("Bearer {}", run.token(Access::Drive)));
    let stop = |origin: &str, bearer: &str| {
        let headers =
            [("Host", host.as_str()), ("Origin", origin), ("Authorization", bearer), ("Content-Length", "0")];
        fetch(address, "POST /stop", &headers).0
    };
    let own = format!("http://{host}");
    let view = format!("Bearer {}", run.token(Access::View));
    assert!(stop("http://evil.example", &bearer).starts_with("HTTP/1.1 403"));
    assert!(stop(&own, "Bearer 00").starts_with("HTTP/1.1 403"));
    assert!(stop(&own, &view).starts_with("HTTP/1.1 403"));
    assert!(stop(&own, &bearer).starts_with("HTTP/1.1 200"));
}

#[test]
fn a_wrong_token_and_no_hello_are_sent_away() {
    let run = LiveRun::start();
    let mut wrong = Browser::connect(&run, None).unwrap();
    wrong.hello(&"0".repeat(32), "guest");
    assert_eq!(wrong.wait_for_close().0, 4401);
    let mut rude = Browser::connect(&run, None).unwrap();
    rude.send(&json!({"type": "stop", "id": 1}));
    assert_eq!(rude.wait_for_close().0, 4408);
    let mut old = Browser::connect(&run, None).unwrap();
    old.send(&json!({"type": "hello", "version": 0, "token": run.token(Access::Drive)}));
    assert_eq!(old.wait_for_close().0, 4406);
}

#[test]
fn broken_large_and_many_messages_end_the_link_and_not_the_server() {
    let run = LiveRun::start();
    let large = format!(r#"{{"type":"go","id":1,"goals":[{}]}}"#, " ".repeat(10_000_000));
    let bomb = format!(r#"{{"type":"go","id":1,"goals":{}"#, "[".repeat(8000));
    for text in [large, bomb, "{}".to_owned(), "\u{0}".to_owned()] {
        let mut browser = Browser::enter(&run, Access::Drive, "fuzzer");
        // The server may close the link during the transfer of a large message.
        _ = browser.send_text(text);
        browser.wait_for_close();
    }
    let mut sender = Browser::enter(&run, Access::Drive, "flood");
    let sent = (0..2000)
        .take_while(|i| sender.send_text(format!(r#"{{"type":"seen","batch":{i}}}"#)).is_ok())
        .count();
    assert!(sent > 50, "{sent}");
    let (code, reason) = sender.wait_for_close();
    assert!(code == 0 || reason.contains("too many requests"), "{code} {reason}");
    assert_eq!(Browser::enter(&run, Access::Drive, "last").ask(json!({"type": "pause"})), None);
}

#[test]
fn a_thousand_connections_do_not_lock_viewers_out() {
    let run = LiveRun::start();
    let mut viewer = Browser::enter(&run, Access::Drive, "first");
    let idle: Vec<TcpStream> =
        (0..1000).filter_map(|_| TcpStream::connect(run.page.address()).ok()).collect();
    assert!(idle.len() > 500, "{}", idle.len());
    assert_eq!(viewer.ask(json!({"type": "pause"})), None, "who is in stays in");
    Browser::enter(&run, Access::View, "second");
}
