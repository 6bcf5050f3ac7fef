//! `trundle run` on a real wire: the simulator is a Kobuki at a pseudo terminal and a camera at a FIFO, in another process.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Longest time of one run \[s\].
const RUN_LIMIT_S: &str = "60";
/// Longest time of a run of several tasks, or of an exploration \[s\].
const LONG_RUN_LIMIT_S: &str = "120";

/// Robots run in real time: one at a time, so that they do not wait for each other.
static TURN: Mutex<()> = Mutex::new(());

/// A simulated robot in a separate process.
struct EmulatedRobot {
    process: Child,
    folder: PathBuf,
    _turn: MutexGuard<'static, ()>,
}

impl EmulatedRobot {
    fn start(folder: &Path) -> Self {
        Self::start_in(folder, &["demo"])
    }

    /// A robot in the place of these arguments of `trundle sim`.
    fn start_in(folder: &Path, place: &[&str]) -> Self {
        let turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        let (port, camera) = (folder.join("kobuki"), folder.join("camera"));
        let process = trundle()
            .arg("sim")
            .args(place)
            .args(["--rate", "8", "--camera", "kinect-v2", "--kobuki"])
            .arg(&port)
            .arg("--camera-stream")
            .arg(&camera)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let start = Instant::now();
        while !(port.exists() && camera.exists()) {
            assert!(start.elapsed() < Duration::from_secs(60), "the emulated robot does not start");
            std::thread::sleep(Duration::from_millis(20));
        }
        Self { process, folder: folder.to_owned(), _turn: turn }
    }

    fn run(&self, arguments: &[&str]) -> Command {
        let mut command = trundle();
        command.arg("run").arg("--base").arg(format!("kobuki:{}", self.folder.join("kobuki").display()));
        command.arg("--camera").arg(format!("stream:{}", self.folder.join("camera").display()));
        command.args(["--out"]).arg(self.folder.join("out")).args(arguments);
        command
    }

    fn summary(&self) -> serde_json::Value {
        serde_json::from_slice(&std::fs::read(self.folder.join("out/summary.json")).unwrap()).unwrap()
    }

    /// Ends the process; its closing lines.
    fn stop(mut self) -> String {
        signal(&self.process, "INT");
        let mut text = String::new();
        std::io::Read::read_to_string(&mut self.process.stdout.take().unwrap(), &mut text).unwrap();
        self.process.wait().unwrap();
        text
    }
}

impl Drop for EmulatedRobot {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

fn trundle() -> Command {
    Command::new(env!("CARGO_BIN_EXE_trundle"))
}

fn signal(process: &Child, name: &str) {
    let done = Command::new("kill").args([&format!("-{name}"), &process.id().to_string()]).status().unwrap();
    assert!(done.success());
}

fn text(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

/// The first number of the row with this name.
fn first_number(table: &str, row: &str) -> f64 {
    let line =
        table.lines().find(|line| line.contains(row)).unwrap_or_else(|| panic!("no '{row}' in {table}"));
    let rest = line.split_once(row).unwrap().1;
    rest.split_whitespace().next().unwrap().trim_end_matches(',').parse().unwrap()
}

/// A service manager that listens to its service, as systemd does.
struct ServiceManager {
    socket: std::os::unix::net::UnixDatagram,
    path: PathBuf,
}

impl ServiceManager {
    fn start(folder: &Path) -> Self {
        let path = folder.join("notify");
        let socket = std::os::unix::net::UnixDatagram::bind(&path).unwrap();
        socket.set_nonblocking(true).unwrap();
        Self { socket, path }
    }

    /// A service that is ended after 4 s without a message. The socket holds the few messages of a run.
    fn starts(&self, mut command: Command) -> Command {
        command.env("NOTIFY_SOCKET", &self.path).env("WATCHDOG_USEC", "4000000");
        command
    }

    /// The service was ready, then alive. Only Linux has such managers.
    fn was_notified(&self) {
        if !cfg!(target_os = "linux") {
            return;
        }
        let mut bytes = [0; 256];
        let next =
            || self.socket.recv(&mut bytes).ok().map(|n| String::from_utf8_lossy(&bytes[..n]).into_owned());
        let messages: Vec<String> = std::iter::from_fn(next).collect();
        assert_eq!(messages.first().map(String::as_str), Some("READY=1\nWATCHDOG=1"), "{messages:?}");
        assert!(messages.iter().any(|text| text == "WATCHDOG=1"), "{messages:?}");
    }
}

#[test]
fn a_goal_is_reached_over_a_serial_line_and_a_camera_stream() {
    let folder = tempfile::tempdir().unwrap();
    let robot = EmulatedRobot::start(folder.path());
    let arguments = ["--goal", "0.6,0,0", "--time-limit", RUN_LIMIT_S, "--record", "all"];
    let manager = ServiceManager::start(folder.path());
    let output = manager.starts(robot.run(&arguments)).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    manager.was_notified();
    let summary = robot.summary();
    assert_eq!((summary["command"].as_str(), summary["success"].as_bool()), (Some("run"), Some(true)));
    assert_eq!(summary["battery_end"]["voltage_v"], 16.5);
    let world = &summary["wall_clock"]["real_time"]["world"];
    assert!(world["base_link"]["decoder"]["packets"].as_u64() > Some(50), "{world}");
    assert!(world["base_link"]["link_losses"].is_u64() && world["camera_frames"]["lost"].is_u64(), "{world}");
    assert!(
        text(&output).contains("base: bytes skipped, packets with a wrong checksum"),
        "{}",
        text(&output)
    );
    let truth = robot.stop();
    assert!((first_number(&truth, "true pose from the start") - 0.6).abs() < 0.03, "{truth}");
    assert_eq!(first_number(&truth, "true contacts"), 0.0);
    let row = |name: &str| truth.lines().find_map(|line| line.trim().strip_prefix(name)).unwrap().trim();
    assert_eq!(
        (row("first light"), row("melodies received")),
        ("off", "cleaning start, cleaning end"),
        "{truth}"
    );
    assert!(!folder.path().join("out/groundtruth.txt").exists(), "a real robot knows no truth");
    replayed_alike(folder.path());
}

/// A replay of the recording gives the map and the trajectory of the run, byte for byte.
fn replayed_alike(folder: &Path) {
    let (recording, again) = (folder.join("out/recording.mcap"), folder.join("again"));
    let replay = trundle().arg("replay").arg(&recording).arg("--out").arg(&again).output().unwrap();
    assert_eq!(replay.status.code(), Some(0), "{}", text(&replay));
    for name in ["map.pgm", "map.yaml", "trajectory.txt"] {
        let read = |folder: &Path| std::fs::read(folder.join(name)).unwrap();
        assert!(read(&folder.join("out")) == read(&again), "{name} differs");
    }
}

#[test]
fn an_unplugged_robot_stops_with_that_reason_and_continues_when_it_returns() {
    let folder = tempfile::tempdir().unwrap();
    let robot = EmulatedRobot::start(folder.path());
    let mut run = robot.run(&["--goal", "2,0,0", "--time-limit", RUN_LIMIT_S]);
    let run = run.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    std::thread::sleep(Duration::from_secs(6));
    // A stopped process is a silent base and camera.
    signal(&robot.process, "STOP");
    std::thread::sleep(Duration::from_secs(2));
    signal(&robot.process, "CONT");
    let output = run.wait_with_output().unwrap();
    let log = std::fs::read_to_string(folder.path().join("out/log.txt")).unwrap();
    assert!(log.contains("no motion: the base does not answer"), "{log}");
    assert!(log.contains("motion is free again"), "{log}");
    let summary = robot.summary();
    assert!(summary["device_losses"]["base"].as_u64() >= Some(1), "{summary}");
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
}

#[test]
fn a_robot_docks_by_its_infrared_light_and_charges() {
    let folder = tempfile::tempdir().unwrap();
    // On the axis of the station, 0.7 m before it: the search and most of the survey are short.
    let place = ["room", "--station", "2.9,0.4,180", "--start", "2.2,0.4,0"];
    let robot = EmulatedRobot::start_in(folder.path(), &place);
    let output = robot.run(&["--dock", "--time-limit", "240"]).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    let summary = robot.summary();
    let battery = |name: &str| (summary[name]["source"].as_str(), summary[name]["is_charging"].as_bool());
    assert_eq!(battery("battery_start"), (Some("battery"), Some(false)), "{summary}");
    assert_eq!(battery("battery_end"), (Some("charging_station"), Some(true)), "{summary}");
    assert!(summary["station_sightings"].as_u64() > Some(0), "{summary}");
    let truth = robot.stop();
    // The base's middle is 0.18 m before the station.
    assert!((first_number(&truth, "true pose from the start") - 0.52).abs() < 0.03, "{truth}");
    assert_eq!(first_number(&truth, "true contacts"), 0.0);
}

/// Interrupts a run with `-v` on the way to its second goal; its exit code.
fn interrupt_on_second_way(mut run: Command) -> Option<i32> {
    let mut run = run.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let messages = BufReader::new(run.stderr.take().unwrap());
    let mut lines = messages.lines().map(Result::unwrap);
    assert!(lines.any(|line| line.contains("arrived -> driving")), "the run ended before its second way");
    signal(&run, "INT");
    lines.for_each(drop);
    run.wait().unwrap().code()
}

#[test]
fn an_interrupted_mission_is_resumed_without_its_done_task() {
    let folder = tempfile::tempdir().unwrap();
    let robot = EmulatedRobot::start(folder.path());
    let (mission, checkpoint) = (folder.path().join("mission.toml"), folder.path().join("robot.checkpoint"));
    std::fs::write(&mission, "[[task]]\ngo = [0.4, 0.0, 0.0]\n\n[[task]]\ngo = [0.8, 0.0, 0.0]\n").unwrap();
    let mut first = robot.run(&["--time-limit", LONG_RUN_LIMIT_S, "-v"]);
    first.arg("--mission").arg(&mission).arg("--checkpoint").arg(&checkpoint);
    assert_eq!(interrupt_on_second_way(first), Some(130));
    let mut second = robot.run(&["--time-limit", LONG_RUN_LIMIT_S]);
    let output = second.arg("--resume").arg(&checkpoint).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    let announced = text(&output);
    assert!(announced.contains("go to (0.80 m, 0.00 m, 0 deg)."), "{announced}");
    assert!(!announced.contains("go to (0.40 m"), "the task that was done: {announced}");
    let truth = robot.stop();
    assert!((first_number(&truth, "true pose from the start") - 0.8).abs() < 0.04, "{truth}");
    assert_eq!(first_number(&truth, "true contacts"), 0.0);
}

/// Side of a small square room \[m\], and of its cells.
const SMALL_ROOM_M: f64 = 2.6;
const SMALL_ROOM_CELL_M: f64 = 0.05;

/// The map of a small square room with walls of two cells; the number of cells of a side.
fn write_small_room(folder: &Path) -> usize {
    let side = (SMALL_ROOM_M / SMALL_ROOM_CELL_M).round() as usize;
    let is_wall = |i: usize| i < 2 || i + 2 >= side;
    let cells = (0..side * side).map(|i| if is_wall(i / side) || is_wall(i % side) { 0 } else { 254 });
    let picture: Vec<u8> =
        format!("P5\n{side} {side}\n255\n").into_bytes().into_iter().chain(cells).collect();
    std::fs::write(folder.join("room.pgm"), picture).unwrap();
    let header = format!(
        "image: room.pgm\nresolution: {SMALL_ROOM_CELL_M}\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    );
    std::fs::write(folder.join("room.yaml"), header).unwrap();
    side
}

#[test]
fn a_small_room_is_explored_over_the_wires() {
    let folder = tempfile::tempdir().unwrap();
    let side = write_small_room(folder.path());
    let room = folder.path().join("room.yaml");
    let robot = EmulatedRobot::start_in(folder.path(), &[room.to_str().unwrap(), "--start", "1.3,1.3,0"]);
    let output = robot.run(&["--explore", "--time-limit", LONG_RUN_LIMIT_S]).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    let map = std::fs::read(folder.path().join("out/map.pgm")).unwrap();
    let free = map.iter().filter(|cell| **cell == 254).count();
    let true_free = (side - 4) * (side - 4);
    assert!(free * 10 > true_free * 8 && free * 10 < true_free * 11, "{free} free cells of {true_free}");
    let truth = robot.stop();
    assert!(first_number(&truth, "true pose from the start").abs() < 0.04, "{truth}");
    assert_eq!(first_number(&truth, "true contacts"), 0.0);
}

/// Whether this process, and therefore each child, ignores SIGHUP.
fn ignores_closed_terminal() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).unwrap();
    u64::from_str_radix(mask.trim(), 16).unwrap() & 1 == 1
}

#[test]
fn a_run_that_is_killed_or_loses_its_terminal_leaves_a_base_at_rest() {
    for (name, code) in [("KILL", None), ("HUP", Some(129))] {
        if name == "HUP" && ignores_closed_terminal() {
            // A program under nohup inherits this state.
            println!("skipped: these tests ignore SIGHUP, as under nohup");
            continue;
        }
        let folder = tempfile::tempdir().unwrap();
        let robot = EmulatedRobot::start(folder.path());
        let mut run = robot.run(&["--goal", "2,0,0", "--time-limit", RUN_LIMIT_S]);
        let mut run = run.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(Duration::from_secs(7));
        signal(&run, name);
        assert_eq!(run.wait().unwrap().code(), code, "{name}");
        std::thread::sleep(Duration::from_secs(1));
        assert_eq!(folder.path().join("out/summary.json").exists(), code.is_some());
        let truth = robot.stop();
        assert!(first_number(&truth, "true path") > 0.05, "{name}: it drove: {truth}");
        assert_eq!(first_number(&truth, "last command received"), 0.0, "{name}: {truth}");
    }
}

#[test]
fn a_recording_does_not_drive_a_base() {
    let folder = tempfile::tempdir().unwrap();
    let robot = EmulatedRobot::start(folder.path());
    let file = folder.path().join("recorded");
    // A file of the camera's header is a recording without frames.
    let mut stream = std::fs::File::open(folder.path().join("camera")).unwrap();
    let mut head = vec![0; 4096];
    std::io::Read::read_exact(&mut stream, &mut head).unwrap();
    std::fs::write(&file, head).unwrap();
    let arguments = ["--camera", &format!("stream:{}", file.display()), "--goal", "1,0,0"];
    let mut run = trundle();
    run.args(["run", "--base", &format!("kobuki:{}", folder.path().join("kobuki").display())])
        .args(arguments);
    let output = run.arg("--out").arg(folder.path().join("out")).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", text(&output));
    assert!(text(&output).contains("is a recording, expected a live camera"), "{}", text(&output));
    assert_eq!(first_number(&robot.stop(), "true path"), 0.0);
}

#[test]
fn a_check_shows_rates_and_tilt_and_writes_the_measured_part_of_the_robot_file() {
    let folder = tempfile::tempdir().unwrap();
    let robot = EmulatedRobot::start(folder.path());
    let file = folder.path().join("robot.toml");
    std::fs::write(&file, "# mine\n[mount]\npitch_deg = 5.0 # by eye\n").unwrap();
    let config = ["--config", file.to_str().unwrap(), "--write", file.to_str().unwrap()];
    let output = robot.run(&["--check"]).args(config).args(["--time-limit", "6"]).output().unwrap();
    let table = text(&output);
    assert_eq!(output.status.code(), Some(0), "{table}");
    // 50 Hz; the emulated base is late on a busy computer.
    assert!((25.0..55.0).contains(&first_number(&table, "wheels: rate, longest gap")), "{table}");
    assert!((first_number(&table, "images: rate, longest gap, age on arrival") - 8.0).abs() < 2.0, "{table}");
    assert!(table.contains("signs of the encoders not checked"), "the robot was not pushed: {table}");
    assert!((first_number(&table, "mount.pitch_deg") - 8.0).abs() < 0.5, "{table}");
    let written = std::fs::read_to_string(&file).unwrap();
    assert!(written.starts_with("# mine") && written.contains("# by eye"), "{written}");
    assert!(written.contains("fx_px") && written.contains("z_m = 0.4"), "{written}");
}

#[test]
fn devices_that_are_not_there_are_named_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let run = |arguments: &[&str]| {
        let output = trundle().arg("run").args(arguments).arg("--out").arg(&out).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{}", text(&output));
        assert!(!out.exists());
        text(&output)
    };
    let camera = format!("stream:{}", folder.path().join("none").display());
    assert!(run(&["--camera", &camera, "--goal", "1,0,0"]).contains(&camera));
    assert!(run(&["--camera", "webcam", "--goal", "1,0,0"]).contains("no camera 'webcam', expected one of"));
    assert!(run(&["--camera", &camera]).contains("--goal"), "a mission is needed");
    let base = run(&["--camera", &camera, "--base", "roomba", "--explore"]);
    assert!(base.contains("no base 'roomba', expected kobuki or kobuki:PORT"), "{base}");
}

#[test]
fn the_udev_rules_and_the_devices_are_listed() {
    let rules = trundle().args(["devices", "--udev"]).output().unwrap();
    assert!(rules.status.success() && text(&rules).contains("ATTRS{idVendor}==\"0403\""), "{}", text(&rules));
    let devices = trundle().arg("devices").output().unwrap();
    assert!(devices.status.success() && text(&devices).contains("Kobuki"), "{}", text(&devices));
}
