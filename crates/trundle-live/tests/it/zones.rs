//! Zones, places, settings and saved maps as a page uses them.

use crate::browser::{Browser, fetch};
use crate::live_run::LiveRun;
use serde_json::json;
use std::fs::File;
use std::io::Write;
use std::process::Command;
use std::time::{Duration, Instant};
use trundle_core::{OccupancyGrid, ZoneKind};
use trundle_io::{map_pgm, map_yaml};
use trundle_live::Access;

#[test]
fn zones_and_places_are_drawn_changed_and_deleted_and_every_viewer_sees_them() {
    let run = LiveRun::start();
    let mut page = Browser::enter(&run, Access::Drive, "page");
    let mut other = Browser::enter(&run, Access::View, "other");
    let zone = |id: u32, kind: serde_json::Value| json!({"id": id, "name": "rug", "kind": kind, "outline": [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]});
    assert_eq!(other.wait_for("annotations")["zones"], json!([]));
    assert_eq!(page.ask(json!({"type": "set_zone", "zone": zone(0, json!("no_go"))})), None);
    assert_eq!(other.wait_for("annotations")["zones"][0]["id"], 1);
    let desk = json!({"id": 0, "name": "desk", "pose": {"x": 1.0, "y": 2.0, "theta": 0.5}});
    assert_eq!(page.ask(json!({"type": "set_place", "place": desk})), None);
    assert_eq!(page.ask(json!({"type": "set_zone", "zone": zone(1, json!({"slow": 0.2}))})), None);
    assert_eq!(run.operator.annotations().zones[0].kind, ZoneKind::Slow(0.2));
    assert_eq!(run.operator.goal_of_place("desk").unwrap().x, 1.0);
    assert_eq!(page.ask(json!({"type": "remove_zone", "number": 1})), None);
    assert_eq!(page.ask(json!({"type": "remove_place", "number": 2})), None);
    assert!(run.operator.annotations().is_empty());
    let refusal = page.ask(json!({"type": "remove_place", "number": 2})).unwrap();
    assert!(refusal.contains("another viewer may have deleted it"), "{refusal}");
    assert!(
        other
            .ask(json!({"type": "set_zone", "zone": zone(0, json!("area"))}))
            .unwrap()
            .contains("for viewing only")
    );
}

#[test]
fn a_wrong_zone_is_refused_with_the_reason() {
    let run = LiveRun::start();
    let mut page = Browser::enter(&run, Access::Drive, "page");
    let mut refusal = |outline: serde_json::Value| {
        let zone = json!({"id": 0, "name": "", "kind": "no_go", "outline": outline});
        page.ask(json!({"type": "set_zone", "zone": zone})).unwrap()
    };
    assert!(refusal(json!([[0, 0], [1, 1], [1, 0], [0, 1]])).contains("crossed by itself"));
    assert!(refusal(json!([[0, 0], [1, 1]])).contains("expected 3 to 200"));
    let ring: Vec<[f64; 2]> = (0..300).map(|i| (0.02 * f64::from(i)).sin_cos().into()).collect();
    assert!(refusal(json!(ring)).contains("expected 3 to 200"));
    assert!(refusal(json!([[0, 0], [1e9, 0], [0, 1]])).contains("expected -1000000 to 1000000"));
}

#[test]
fn settings_have_text_and_range_and_change() {
    let run = LiveRun::start();
    let mut page = Browser::enter(&run, Access::Drive, "page");
    let settings = page.wait_for("settings")["settings"].clone();
    let speed = settings.as_array().unwrap().iter().find(|s| s["key"] == "limits.v_m_s").unwrap().clone();
    assert!(speed["text"].as_str().unwrap().contains("speed"));
    let change = |value: f64| json!({"type": "change", "key": "limits.v_m_s", "value": value});
    assert!(page.ask(change(99.0)).unwrap().contains("expected 0.05 to"));
    assert_eq!(page.ask(change(0.2)), None);
    let changed = std::iter::from_fn(|| Some(page.wait_for("settings"))).next().unwrap();
    assert!(changed["settings"].as_array().unwrap().iter().any(|s| s["value"] == 0.2), "{changed}");
}

#[test]
fn the_map_is_saved_by_whoever_may_look() {
    let run = LiveRun::start();
    let mut page = Browser::enter(&run, Access::View, "page");
    page.wait_for("state");
    let address = run.page.address();
    let (host, bearer) = (address.to_string(), format!("Bearer {}", run.token(Access::View)));
    let get = |name: &str, bearer: &str| {
        fetch(address, &format!("GET /files/{name}"), &[("Host", host.as_str()), ("Authorization", bearer)])
    };
    run.wait_for("a map", |view| view.map.is_some());
    let (head, body) = get("map.yaml", &bearer);
    assert!(head.starts_with("HTTP/1.1 200") && body.contains("resolution: 0.05"), "{head} {body}");
    assert!(get("zones.geojson", &bearer).1.contains("FeatureCollection"));
    assert!(get("map.yaml", "Bearer 00").0.starts_with("HTTP/1.1 403"));
    assert!(get("other", &bearer).0.starts_with("HTTP/1.1 404"));
}

#[test]
fn a_map_of_the_folder_is_loaded_and_another_name_is_refused() {
    let run = LiveRun::start();
    run.wait_for("a step", |view| view.odometry.is_some());
    let wall = OccupancyGrid::from_ascii(0.05, &"#########\n#.......#\n".repeat(40)).unwrap();
    std::fs::write(run.place.path().join("attic.yaml"), map_yaml(&wall, "attic.pgm")).unwrap();
    std::fs::write(run.place.path().join("attic.pgm"), map_pgm(&wall)).unwrap();
    let bearer = format!("Bearer {}", run.token(Access::View));
    let headers = [("Host", "127.0.0.1"), ("Authorization", bearer.as_str())];
    let (head, body) = fetch(run.page.address(), "GET /maps", &headers);
    assert!(head.starts_with("HTTP/1.1 200") && body.contains(r#"["attic"]"#), "{head} {body}");
    assert!(fetch(run.page.address(), "GET /maps", &headers[..1]).0.starts_with("HTTP/1.1 403"));
    let mut viewer = Browser::enter(&run, Access::View, "viewer");
    assert!(viewer.ask(json!({"type": "load_map", "name": "attic"})).unwrap().contains("for viewing only"));
    let mut page = Browser::enter(&run, Access::Drive, "page");
    let refusal = page.ask(json!({"type": "load_map", "name": "../attic"})).unwrap();
    assert!(refusal.contains("no map '../attic'"), "{refusal}");
    assert_eq!(page.ask(json!({"type": "load_map", "name": "attic"})), None);
    run.wait_for("the map", |view| view.map.as_ref().is_some_and(|map| map.number == 1));
}

#[test]
fn while_a_large_map_is_read_the_robot_stops_and_other_viewers_go_on() {
    let run = LiveRun::start();
    run.wait_for("a step", |view| view.odometry.is_some());
    // 96 MB of zeros in a sparse file, with a yaw that requires every cell to be computed; no robot here has such cells.
    let mut picture = File::create(run.place.path().join("large.pgm")).unwrap();
    picture.write_all(b"P5 6000 8000 65535\n").unwrap();
    picture.set_len(19 + 2 * 6000 * 8000).unwrap();
    let yaml = "image: large.pgm\nresolution: 0.3\norigin: [0, 0, 0.5]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
    std::fs::write(run.place.path().join("large.yaml"), yaml).unwrap();
    let mut page = Browser::enter(&run, Access::Drive, "page");
    let mut other = Browser::enter(&run, Access::Drive, "other");
    let start = Instant::now();
    page.send(&json!({"type": "load_map", "id": 71, "name": "large"}));
    page.send(&json!({"type": "load_map", "id": 72, "name": "large"}));
    let second = page.wait_for("answer");
    assert_eq!(second["id"], 72, "{second}");
    assert!(second["refusal"].as_str().unwrap().contains("Another map is being loaded"), "{second}");
    let address = run.page.address();
    let (host, origin) = (address.to_string(), format!("http://{address}"));
    let bearer = format!("Bearer {}", run.token(Access::Drive));
    let headers = [("Host", host.as_str()), ("Origin", &origin), ("Authorization", &bearer)];
    let (head, body) = fetch(address, "POST /stop", &headers);
    assert!(head.starts_with("HTTP/1.1 200"), "{head} {body}");
    assert_eq!(other.ask(json!({"type": "stop"})), None);
    let stopped = start.elapsed();
    // The answer comes last, to the requesting viewer.
    let first = page.wait_for("answer");
    let read = start.elapsed();
    assert_eq!(first["id"], 71, "{first}");
    assert!(first["refusal"].as_str().unwrap().contains("Map 'large': "), "{first}");
    assert!(stopped < read / 2, "stopped after {stopped:?}, read after {read:?}");
    // Maps are read one after the other.
    assert!(page.ask(json!({"type": "load_map", "name": "attic"})).unwrap().contains("no map 'attic'"));
}

#[cfg(unix)]
#[test]
fn a_pipe_among_the_maps_is_refused_and_the_page_ends_with_the_run() {
    let run = LiveRun::start();
    run.wait_for("a step", |view| view.odometry.is_some());
    let pipe = run.place.path().join("pipe.yaml");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let mut page = Browser::enter(&run, Access::Drive, "page");
    let refusal = page.ask(json!({"type": "load_map", "name": "pipe"})).unwrap();
    assert_eq!(refusal, "Map 'pipe': its YAML file is no regular file.");
    assert_eq!(page.ask(json!({"type": "stop"})), None);
    let (send, ended) = std::sync::mpsc::channel();
    std::thread::spawn(move || {
        drop(run);
        send.send(()).unwrap();
    });
    ended.recv_timeout(Duration::from_secs(10)).expect("the page does not end");
}

#[test]
fn a_map_is_not_loaded_for_a_viewer_without_the_wheel() {
    let run = LiveRun::start();
    let mut holder = Browser::enter(&run, Access::Drive, "Anna");
    let mut other = Browser::enter(&run, Access::Drive, "Bert");
    assert_eq!(holder.ask(json!({"type": "take_wheel"})), None);
    let refusal = other.ask(json!({"type": "load_map", "name": "attic"})).unwrap();
    assert!(refusal.contains("Anna holds the wheel"), "{refusal}");
    let unsteered = LiveRun::with_steering(false);
    let mut page = Browser::enter(&unsteered, Access::Drive, "page");
    assert!(page.ask(json!({"type": "load_map", "name": "attic"})).unwrap().contains("takes no commands"));
}
