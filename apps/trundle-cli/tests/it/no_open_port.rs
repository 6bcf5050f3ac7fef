//! A run opens no port, unless an option asks for one.

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Longest time until the run under test records \[s\].
const MAX_START_S: u64 = 60;

/// A program that ends with the test.
struct Program(Child);

impl Drop for Program {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Program {
    fn start(args: &[&str]) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_trundle"));
        command.args(args).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        Self(command.spawn().unwrap())
    }

    /// What the program has open: files, pipes and sockets.
    fn open(&self) -> Vec<String> {
        let folder = format!("/proc/{}/fd", self.0.id());
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let targets = entries.filter_map(|entry| std::fs::read_link(entry.path()).ok());
        targets.map(|target| target.display().to_string()).collect()
    }

    /// What the program has open as soon as one of it has this word.
    fn open_with(&self, word: &str) -> Vec<String> {
        let end = Instant::now() + Duration::from_secs(MAX_START_S);
        while Instant::now() < end {
            let open = self.open();
            if open.iter().any(|target| target.contains(word)) {
                return open;
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        panic!("{word} is not open after {MAX_START_S} s: {:?}", self.open());
    }
}

fn demo(place: &Path, options: &[&str]) -> Program {
    let out = place.join("out").display().to_string();
    Program::start(&[&["demo", "--quiet", "--real-time", "--out", &out], options].concat())
}

#[test]
fn no_socket_is_opened_by_default() {
    let place = tempfile::tempdir().unwrap();
    let open = demo(place.path(), &[]).open_with("recording.mcap");
    // The signals' pair of sockets has no address, and is not among the system's ports.
    let ports = listening();
    assert!(
        !open.iter().any(|target| ports.iter().any(|inode| target == &format!("socket:[{inode}]"))),
        "{open:?}"
    );
}

/// The check sees a port where there is one.
#[test]
fn the_live_page_opens_one() {
    let place = tempfile::tempdir().unwrap();
    let program = demo(place.path(), &["--live", "127.0.0.1:0"]);
    let open = program.open_with("recording.mcap");
    let ports = listening();
    assert!(
        open.iter().any(|target| ports.iter().any(|inode| target == &format!("socket:[{inode}]"))),
        "{open:?}"
    );
}

/// Numbers of all TCP and UDP sockets of this system.
fn listening() -> Vec<String> {
    let tables =
        ["tcp", "tcp6", "udp", "udp6"].map(|name| std::fs::read_to_string(format!("/proc/net/{name}")));
    let lines = tables.iter().flatten().flat_map(|table| table.lines().skip(1));
    lines.filter_map(|line| line.split_whitespace().nth(9).map(str::to_owned)).collect()
}
