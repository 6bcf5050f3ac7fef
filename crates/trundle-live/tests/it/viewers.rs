//! Several viewers: one is in control, others view, and a slow one delays no other.

use crate::browser::{Browser, fetch};
use crate::live_run::LiveRun;
use serde_json::json;
use std::time::{Duration, Instant};
use trundle_live::Access;

#[test]
fn a_link_for_viewing_does_not_drive() {
    let run = LiveRun::start();
    let mut viewer = Browser::enter(&run, Access::View, "viewer");
    for kind in ["explore", "return", "dock", "stop", "pause", "continue", "take_wheel"] {
        let refusal = viewer.ask(json!({"type": kind})).unwrap();
        assert!(refusal.contains("for viewing only"), "{kind}: {refusal}");
    }
    viewer.send(&json!({"type": "drive", "v": 1.0, "omega": 0.0}));
    assert!(viewer.wait_for("refused")["refusal"].as_str().unwrap().contains("for viewing only"));
    assert!(viewer.wait_for("state")["wheel"].is_null());
}

#[test]
fn a_replay_takes_no_commands() {
    let run = LiveRun::with_steering(false);
    assert_eq!(run.page.link(Access::Drive), None);
    let mut viewer = Browser::enter(&run, Access::Drive, "viewer");
    assert!(viewer.ask(json!({"type": "stop"})).unwrap().contains("takes no commands"));
}

#[test]
fn one_viewer_is_in_control_and_the_other_is_shown_which() {
    let run = LiveRun::start();
    let mut anna = Browser::enter(&run, Access::Drive, "Anna");
    let mut bert = Browser::enter(&run, Access::Drive, "Bert");
    assert_eq!(anna.ask(json!({"type": "pause"})), None);
    assert_eq!(bert.ask(json!({"type": "explore"})).unwrap(), "Anna holds the wheel. Take it over first.");
    let state = std::iter::from_fn(|| Some(bert.wait_for("state"))).find(|state| !state["wheel"].is_null());
    assert_eq!(state.unwrap()["wheel"], json!({"name": "Anna", "is_you": false}));
    assert_eq!(bert.ask(json!({"type": "stop"})), None, "a viewer that may drive may stop");
    assert_eq!(bert.ask(json!({"type": "take_wheel"})), None);
    assert_eq!(bert.ask(json!({"type": "explore"})), None);
    assert!(anna.ask(json!({"type": "explore"})).unwrap().starts_with("Bert holds"));
    drop(bert);
    let start = Instant::now();
    while anna.ask(json!({"type": "pause"})).is_some() {
        assert!(start.elapsed() < Duration::from_secs(5), "a wheel that was left is free");
    }
}

#[test]
fn a_viewer_that_draws_nothing_is_sent_three_views_and_the_others_go_on() {
    let run = LiveRun::start();
    let mut slow = Browser::enter(&run, Access::View, "slow");
    slow.draws = false;
    let mut fast = Browser::enter(&run, Access::View, "fast");
    let last = (0..15).map(|_| fast.wait_for("state")["batch"].as_u64().unwrap()).last().unwrap();
    assert!(last >= 15, "{last}");
    assert_eq!((0..3).map(|_| slow.wait_for("state")["batch"].as_u64().unwrap()).last(), Some(3));
    slow.send(&json!({"type": "seen", "batch": 3}));
    let fresh = slow.wait_for("state");
    assert_eq!(fresh["batch"], 4);
    let (newest, shown) = (run.operator.peek().unwrap().stamp.as_secs(), fresh["time"].as_f64().unwrap());
    assert!(newest - shown < 0.5, "the newest view, not one that waited: {newest} s, {shown} s");
}

#[test]
fn a_page_that_comes_again_after_a_restart_is_welcome_with_its_token() {
    let run = LiveRun::start();
    let mut page = Browser::enter(&run, Access::Drive, "page");
    page.wait_for("state");
    drop(run);
    assert!(page.wait_for_close().0 < 4400, "the page may try again");
}

#[test]
fn one_viewer_too_many_is_told_so_and_a_place_that_was_left_is_free() {
    let run = LiveRun::start();
    let mut viewers: Vec<_> = (0..24).map(|_| Browser::enter(&run, Access::View, "viewer")).collect();
    let mut late = Browser::connect(&run, None).unwrap();
    late.hello(run.token(Access::Drive), "late");
    assert_eq!(late.wait_for_close(), (1013, "too many viewers: close another page".to_owned()));
    assert!(stop_by_request(&run).starts_with("HTTP/1.1 200"), "STOP needs no place among the viewers");
    viewers.pop();
    let start = Instant::now();
    while viewers[0].wait_for("state")["viewers"] != 23 {
        assert!(start.elapsed() < Duration::from_secs(10), "a viewer that went is counted");
    }
    Browser::enter(&run, Access::Drive, "late");
}

/// The head of the answer to STOP by a request of its own.
fn stop_by_request(run: &LiveRun) -> String {
    let address = run.page.address();
    let (host, origin) = (address.to_string(), format!("http://{address}"));
    let bearer = format!("Bearer {}", run.token(Access::Drive));
    let headers =
        [("Host", host.as_str()), ("Origin", &origin), ("Authorization", &bearer), ("Content-Length", "0")];
    fetch(address, "POST /stop", &headers).0
}

#[test]
fn viewers_hear_that_the_program_ends() {
    let run = LiveRun::start();
    let mut viewer = Browser::enter(&run, Access::View, "viewer");
    let _silent = Browser::enter(&run, Access::View, "silent");
    viewer.wait_for("state");
    let start = Instant::now();
    drop(run);
    assert!(start.elapsed() < Duration::from_secs(2), "a viewer that reads nothing does not hold up the end");
    assert_eq!(viewer.wait_for_close(), (1001, "the program has ended".to_owned()));
}
