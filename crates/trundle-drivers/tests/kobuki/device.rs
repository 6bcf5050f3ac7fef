//! An emulated base on a separate thread, with faults.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard};
use std::thread::JoinHandle;
use std::time::Duration;
use trundle_core::Twist2;
use trundle_drivers::kobuki::protocol::Version;
use trundle_drivers::kobuki::{ByteLink, EmulatedKobuki, KobukiState, PseudoTerminal};

/// Data that the device sends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sends {
    /// Sound packets.
    Packets,
    /// No data.
    Nothing,
    /// Sound packets in pieces of seven bytes, with garbage between.
    PiecesAndGarbage,
    /// Packets of two bases alternately.
    TwoBases,
    /// Packets of which every second one lacks a byte.
    LostBytes,
    /// Ten packets in one burst.
    Bursts,
    /// Message of a satellite receiver.
    OtherDevice,
}

/// State of the device for tests.
pub struct State {
    pub base: EmulatedKobuki,
    pub sensors: KobukiState,
    pub sends: Sends,
    /// Every speed that came.
    pub twists: Vec<Twist2>,
    pub is_plugged: bool,
    is_ended: bool,
}

/// The running device.
pub struct Device {
    port: PathBuf,
    state: Arc<Mutex<State>>,
    thread: Option<JoinHandle<()>>,
}

impl Device {
    /// A device whose port is a link in the folder for temporary files.
    pub fn plugged(name: &str, sends: Sends, firmware: Version) -> Self {
        let port = std::env::temp_dir().join(format!("trundle-{name}-{}", std::process::id()));
        let state = Arc::new(Mutex::new(State {
            base: EmulatedKobuki::new(firmware),
            sensors: KobukiState::default(),
            sends,
            twists: Vec::new(),
            is_plugged: true,
            is_ended: false,
        }));
        let terminal = PseudoTerminal::open_at(&port).unwrap();
        let (shared, path) = (Arc::clone(&state), port.clone());
        let thread = std::thread::spawn(move || run(&shared, &path, Some(terminal)));
        Self { port, state, thread: Some(thread) }
    }

    pub fn port(&self) -> &Path {
        &self.port
    }

    pub fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap()
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        self.state.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).is_ended = true;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn run(state: &Mutex<State>, port: &Path, mut terminal: Option<PseudoTerminal>) {
    let mut second = EmulatedKobuki::default();
    (0..777).for_each(|_| drop(second.feedback(&KobukiState::default())));
    loop {
        std::thread::sleep(Duration::from_millis(20));
        let mut state = state.lock().unwrap();
        if state.is_ended {
            return;
        }
        match (&mut terminal, state.is_plugged) {
            (Some(terminal), true) => cycle(terminal, &mut state, &mut second),
            (None, true) => terminal = Some(PseudoTerminal::open_at(port).unwrap()),
            (_, false) => terminal = None,
        }
    }
}

/// Handles the received commands, and sends.
fn cycle(terminal: &mut PseudoTerminal, state: &mut State, second: &mut EmulatedKobuki) {
    let mut buffer = [0; 4096];
    let bytes = terminal.read(&mut buffer, Duration::ZERO).unwrap();
    for byte in buffer[..bytes].chunks(1) {
        let twist = state.base.on_bytes(byte);
        state.twists.extend(twist);
    }
    for piece in pieces(state, second) {
        terminal.write(&piece).unwrap();
    }
}

fn pieces(state: &mut State, second: &mut EmulatedKobuki) -> Vec<Vec<u8>> {
    let (left, right) = state.sensors.ticks;
    state.sensors.ticks = (left.wrapping_add(1), right.wrapping_sub(1));
    let packet = match state.sends {
        Sends::Nothing | Sends::OtherDevice => Vec::new(),
        _ => state.base.feedback(&state.sensors),
    };
    match state.sends {
        Sends::Packets => vec![packet],
        Sends::Nothing => Vec::new(),
        Sends::PiecesAndGarbage => {
            let garbage =
                [&[0x2D][..], &[0xAA], &[0xAA, 0x55, 0x4D, 0x01], b"garbage"][usize::from(left % 4)];
            [garbage, &packet].concat().chunks(7).map(<[u8]>::to_vec).collect()
        }
        Sends::TwoBases => vec![packet, second.feedback(&state.sensors)],
        Sends::LostBytes if left % 2 == 0 => vec![packet[..30].to_vec(), packet[31..].to_vec()],
        Sends::LostBytes => vec![packet],
        Sends::Bursts => {
            let later = (0..9).map(|_| state.base.feedback(&state.sensors));
            std::iter::once(packet).chain(later).collect()
        }
        Sends::OtherDevice => vec![b"$GPGGA,123519,4807.038,N\xAA\x55\r\n".to_vec()],
    }
}
