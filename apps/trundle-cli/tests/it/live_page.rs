//! The live page of `sim`, `slam`, `map`, `replay` and `experiment`, as a browser meets it.

use crate::program::{summary, text, trundle};
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

/// Version of the messages, as the page has it.
const WIRE_VERSION: u32 = 5;

/// A program with its live page.
struct LiveProgram {
    process: Child,
    /// Output before the link, and the line of the link.
    printed: String,
    address: String,
    token: String,
}

impl LiveProgram {
    fn start(args: &[&str]) -> Self {
        let mut process = Command::new(env!("CARGO_BIN_EXE_trundle"))
            .args(args)
            .args(["--live", "127.0.0.1:0"])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut out = BufReader::new(process.stdout.as_mut().unwrap());
        let mut printed = String::new();
        while !printed.contains("/#") {
            let read = out.read_line(&mut printed).unwrap();
            assert!(read > 0, "{args:?} ends without a link: {printed}");
        }
        let (before, token) = printed.split_once("/#").unwrap();
        let address = before.rsplit_once("http://").unwrap().1.to_owned();
        let token = token.trim().to_owned();
        Self { process, printed, address, token }
    }

    fn browser(&self) -> Browser {
        let mut browser = Browser { link: WebSocket::open(&self.address), last_id: 0, kinds: Vec::new() };
        browser.send(json!({"type": "hello", "version": WIRE_VERSION, "token": self.token, "name": "test"}));
        browser.send(json!({"type": "camera", "on": true}));
        browser.send(json!({"type": "visual_map", "on": true}));
        browser
    }

    fn end(self) -> Output {
        let output = self.process.wait_with_output().unwrap();
        assert!(
            output.status.code().is_some_and(|code| code < 2),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        output
    }
}

/// The client's end of a link by RFC 6455, as far as the page needs it.
struct WebSocket(BufReader<TcpStream>);

impl WebSocket {
    const TEXT: u8 = 1;
    const BYTES: u8 = 2;
    const CLOSE: u8 = 8;

    fn open(address: &str) -> Self {
        let mut stream = TcpStream::connect(address).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
        write!(
            stream,
            "GET /live HTTP/1.1\r\nHost: {address}\r\nOrigin: http://{address}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n\
             Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
        )
        .unwrap();
        let mut reader = BufReader::new(stream);
        let mut head = String::new();
        while !head.ends_with("\r\n\r\n") {
            assert!(reader.read_line(&mut head).unwrap() > 0, "{head}");
        }
        assert!(head.starts_with("HTTP/1.1 101"), "{head}");
        Self(reader)
    }

    /// Sends a text, masked by zeros; returns whether the other end is connected.
    fn send(&mut self, text: &str) -> bool {
        let length = text.len() as u16;
        let mut frame = vec![0x80 | Self::TEXT];
        if length < 126 {
            frame.push(0x80 | length as u8);
        } else {
            frame.push(0x80 | 126);
            frame.extend(length.to_be_bytes());
        }
        frame.extend([0; 4]);
        frame.extend(text.as_bytes());
        self.0.get_mut().write_all(&frame).is_ok()
    }

    /// Kind and content of the next message; `None` at the end.
    fn receive(&mut self) -> Option<(u8, Vec<u8>)> {
        let mut head = [0; 2];
        self.0.read_exact(&mut head).ok()?;
        let mut length = [0; 8];
        match head[1] {
            126 => self.0.read_exact(&mut length[6..]).ok()?,
            127 => self.0.read_exact(&mut length).ok()?,
            short => length[7] = short,
        }
        assert_eq!(head[0] & 0x80, 0x80, "the page's messages are whole");
        let mut content = vec![0; u64::from_be_bytes(length) as usize];
        self.0.read_exact(&mut content).ok()?;
        let kind = head[0] & 0x0f;
        (kind != Self::CLOSE).then_some((kind, content))
    }
}

struct Browser {
    link: WebSocket,
    last_id: u64,
    /// First bytes of the messages of bytes so far.
    kinds: Vec<u8>,
}

impl Browser {
    fn send(&mut self, message: Value) {
        assert!(self.link.send(&message.to_string()), "{message}");
    }

    /// The next message of JSON; `None` after the end of the program.
    fn next(&mut self) -> Option<Value> {
        loop {
            match self.link.receive()? {
                (WebSocket::TEXT, text) => {
                    let value: Value = serde_json::from_slice(&text).unwrap();
                    if value["type"] == "state" {
                        // The program may end in between, which the next message shows.
                        self.link.send(&json!({"type": "seen", "batch": value["batch"]}).to_string());
                    }
                    return Some(value);
                }
                (WebSocket::BYTES, bytes) => self.kinds.push(bytes[0]),
                _ => {}
            }
        }
    }

    fn wait_for(&mut self, kind: &str, is: impl Fn(&Value) -> bool) -> Value {
        while let Some(value) = self.next() {
            if value["type"] == kind && is(&value) {
                return value;
            }
        }
        panic!("no such {kind} before the end")
    }

    /// Sends a request; returns the refusal.
    fn refusal(&mut self, mut request: Value) -> String {
        self.last_id += 1;
        request["id"] = self.last_id.into();
        self.send(request);
        let id = self.last_id;
        let answer = self.wait_for("answer", |answer| answer["id"] == id);
        answer["refusal"].as_str().unwrap_or_default().to_owned()
    }

    /// Reads to the end of the program: the states, and the other messages of JSON.
    fn rest(&mut self) -> (Vec<Value>, Vec<Value>) {
        std::iter::from_fn(|| self.next()).partition(|value| value["type"] == "state")
    }
}

/// The images of a drive by a script, as a folder `data` below `place`.
fn recorded_drive(place: &Path, script: &str) -> PathBuf {
    let [drive, data] = ["drive.txt", "data"].map(|name| place.join(name));
    std::fs::write(&drive, script).unwrap();
    let record = ["sim", "demo", "--rate", "10", "--drive", text(&drive), "--record", text(&data)];
    assert!(trundle(&record).status.success());
    data
}

/// Files of a folder without wall-clock times, with their bytes.
fn files(folder: &Path, names: &[&str]) -> Vec<(PathBuf, Vec<u8>)> {
    names.iter().map(|name| (PathBuf::from(name), std::fs::read(folder.join(name)).unwrap())).collect()
}

#[test]
fn the_page_drives_a_simulated_base_and_its_silence_stops_it() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("out");
    let args =
        ["sim", "room", "--rate", "5", "--laser", "rplidar-a1", "--duration", "6", "--record", text(&out)];
    let program = LiveProgram::start(&args);
    let mut browser = program.browser();
    let welcome = browser.wait_for("welcome", |_| true);
    assert_eq!((&welcome["kind"], &welcome["drives"]), (&json!("drive"), &json!(true)), "{welcome}");
    let goal = browser.refusal(json!({"type": "go", "goals": [{"x": 1, "y": 1, "theta": 0}]}));
    assert!(goal.contains("drive by hand"), "{goal}");
    for _ in 0..8 {
        browser.send(json!({"type": "drive", "v": 0.5, "omega": 0.0}));
        browser.wait_for("state", |_| true);
    }
    let driven = browser.wait_for("state", |state| state["state"] == "driven by hand");
    assert!(driven["command"][0].as_f64().unwrap() > 0.1, "{driven}");
    let stopped = browser.wait_for("state", |state| state["state"] == "standing");
    assert!(stopped["time"].as_f64().unwrap() - driven["time"].as_f64().unwrap() < 1.0, "{driven} {stopped}");
    browser.rest();
    // Tiles, scan, image; depth is sent only while it is chosen.
    assert!([1, 2, 4].iter().all(|kind| browser.kinds.contains(kind)), "{:?}", browser.kinds);
    program.end();
    assert!(summary(&out)["path_length_m"].as_f64().unwrap() > 0.05);
}

#[test]
fn a_script_that_is_watched_records_the_same_bytes_and_the_page_cannot_drive() {
    let place = tempfile::tempdir().unwrap();
    let script = place.path().join("drive.txt");
    std::fs::write(&script, "0 0.3 0.2\n1.5 0 0\n").unwrap();
    let [plain, shown] = ["plain", "shown"].map(|name| place.path().join(name));
    let args = |out| ["sim", "demo", "--rate", "5", "--drive", text(&script), "--record", out];
    assert!(trundle(&args(text(&plain))).status.success());
    let program = LiveProgram::start(&args(text(&shown)));
    let mut browser = program.browser();
    let welcome = browser.wait_for("welcome", |_| true);
    assert_eq!((&welcome["kind"], &welcome["is_steered"]), (&json!("drive"), &json!(false)), "{welcome}");
    assert!(browser.refusal(json!({"type": "stop"})).contains("takes no commands"));
    assert!(!browser.rest().0.is_empty());
    assert!(program.end().status.success());
    let names =
        ["groundtruth.txt", "odometry.txt", "associations.txt", "map.pgm", "overview.png", "summary.json"];
    assert!(files(&plain, &names) == files(&shown, &names));
}

#[test]
fn a_sequence_is_shown_while_it_is_tracked_and_its_results_are_the_same() {
    let place = tempfile::tempdir().unwrap();
    let data = recorded_drive(place.path(), "0 0.3 0.2\n4 0.2 -0.3\n8 0 0\n");
    let [plain, shown] = ["plain", "shown"].map(|name| place.path().join(name));
    let args = |out| ["slam", text(&data), "--height", "0.45", "--tilt", "8", "--out", out];
    assert!(trundle(&args(text(&plain))).status.success());
    let program = LiveProgram::start(&args(text(&shown)));
    assert!(!program.printed.contains("Live page: "), "no link drives: {}", program.printed);
    let mut browser = program.browser();
    assert_eq!(browser.wait_for("welcome", |_| true)["kind"], "sequence");
    let (states, notes) = browser.rest();
    assert!(states.iter().any(|state| state["state"] == "tracking"), "{states:?}");
    let series = notes.iter().rfind(|note| note["type"] == "series").unwrap();
    assert_eq!((&series["unit"], &series["total"]), (&json!("images"), &json!(80)), "{series}");
    // Tiles, image, visual map, features; depth is sent only while it is chosen.
    assert!([1, 4, 6, 7].iter().all(|kind| browser.kinds.contains(kind)), "{:?}", browser.kinds);
    assert!(program.end().status.success());
    let names = ["trajectory.txt", "map.pgm", "visual.map", "recording.mcap"];
    assert!(files(&plain, &names) == files(&shown, &names));
}

#[test]
fn a_log_is_shown_while_it_is_mapped_and_localized_and_its_results_are_the_same() {
    let place = tempfile::tempdir().unwrap();
    let data = recorded_drive(place.path(), "0 0.3 0.2\n4 0.2 -0.3\n8 0 0\n");
    let mapped = place.path().join("mapped");
    for options in [&[][..], &["--map", text(&mapped.join("filter.map")), "--localise"]] {
        let [plain, shown] = match options {
            [] => [mapped.clone(), place.path().join("shown")],
            _ => ["plain-localised", "shown-localised"].map(|name| place.path().join(name)),
        };
        // Many particles take time, so that the page sees the map grow.
        let args = |out| [&["map", text(&data), "--particles", "1000", "--out", out], options].concat();
        assert!(trundle(&args(text(&plain))).status.success());
        let program = LiveProgram::start(&args(text(&shown)));
        let mut browser = program.browser();
        assert_eq!(browser.wait_for("welcome", |_| true)["title"], "map: data");
        let (states, notes) = browser.rest();
        let activities = ["mapping", "localizing", "searching the pose"];
        assert!(
            states.iter().all(|state| activities.contains(&state["state"].as_str().unwrap())),
            "{states:?}"
        );
        let series = notes.iter().rfind(|note| note["type"] == "series").unwrap();
        assert_eq!((&series["unit"], &series["total"]), (&json!("scans"), &json!(40)), "{series}");
        // Tiles and scan. A localization may end before the first view.
        let is_seen = |kind: &u8| browser.kinds.contains(kind) || !options.is_empty();
        assert!([1, 2].iter().all(is_seen), "{:?}", browser.kinds);
        assert!(program.end().status.success());
        assert!(files(&plain, &["trajectory.txt"]) == files(&shown, &["trajectory.txt"]));
    }
    let names = ["map.pgm", "filter.map", "overview.png"];
    assert!(files(&mapped, &names) == files(&place.path().join("shown"), &names));
}

#[test]
fn a_replay_is_shown_drives_nothing_and_its_results_are_the_same() {
    let place = tempfile::tempdir().unwrap();
    let data = recorded_drive(place.path(), "0 0.3 0.2\n3 0.2 -0.3\n6 0 0\n");
    let [plain, shown] = ["plain", "shown"].map(|name| place.path().join(name));
    let args = |out| ["replay", text(&data), "--out", out];
    assert!(trundle(&args(text(&plain))).status.success());
    let program = LiveProgram::start(&args(text(&shown)));
    let mut browser = program.browser();
    let welcome = browser.wait_for("welcome", |_| true);
    assert_eq!((&welcome["kind"], &welcome["drives"]), (&json!("robot"), &json!(false)), "{welcome}");
    assert!(browser.refusal(json!({"type": "stop"})).contains("takes no commands"));
    assert!(!browser.rest().0.is_empty());
    assert!(program.end().status.success());
    let names = ["trajectory.txt", "map.pgm", "recording.mcap"];
    assert!(files(&plain, &names) == files(&shown, &names));
}

#[test]
fn an_experiment_shows_one_of_its_runs_and_the_results_of_the_others() {
    let place = tempfile::tempdir().unwrap();
    let [plain, shown] = ["plain", "shown"].map(|name| place.path().join(name));
    let args = |out| ["experiment", "poses", "--only", "2, seed", "--seeds", "2", "--out", out];
    trundle(&args(text(&plain)));
    let program = LiveProgram::start(&args(text(&shown)));
    let mut browser = program.browser();
    let welcome = browser.wait_for("welcome", |_| true);
    assert_eq!((&welcome["kind"], &welcome["drives"]), (&json!("robot"), &json!(false)), "{welcome}");
    let series = browser.wait_for("series", |_| true);
    assert!(series["shown"].as_str().unwrap().starts_with("2, seed"), "{series}");
    assert_eq!((&series["unit"], &series["total"]), (&json!("runs"), &json!(2)), "{series}");
    browser.wait_for("state", |state| state["left"][0]["goal"].is_array());
    let ended = browser.wait_for("series", |series| series["ended"] == 1);
    assert!(ended["last"][0]["text"].as_str().unwrap().contains("reached"), "{ended}");
    browser.rest();
    // Tiles, scan, image, features.
    assert!([1, 2, 4, 7].iter().all(|kind| browser.kinds.contains(kind)), "{:?}", browser.kinds);
    program.end();
    assert!(files(&plain, &["poses.csv"]) == files(&shown, &["poses.csv"]));
}
