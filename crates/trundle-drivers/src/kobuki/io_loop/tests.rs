//! Tests of the link's thread, step by step, with links and a clock of the test.

use super::*;
use crate::kobuki::emulator::{EmulatedKobuki, KobukiState};
use crate::kobuki::link::ConnectError;
use crate::kobuki::protocol::Outputs;
use std::io;
use std::sync::atomic::{AtomicI64, Ordering};
use std::sync::mpsc::{Sender, channel, sync_channel};

/// A link that delivers given bytes, accepts a fixed number of bytes per write, and then breaks.
struct Scripted {
    reads: Vec<Vec<u8>>,
    taken_per_write: usize,
    written: Arc<Mutex<Vec<u8>>>,
    /// A clock that advances by half a second in each read.
    stalled: Arc<AtomicI64>,
}

impl ByteLink for Scripted {
    fn read(&mut self, buffer: &mut [u8], _: Duration) -> io::Result<usize> {
        self.stalled.fetch_add(500, Ordering::SeqCst);
        if self.reads.is_empty() {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        let bytes = self.reads.remove(0);
        buffer[..bytes.len()].copy_from_slice(&bytes);
        Ok(bytes.len())
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let taken = self.taken_per_write.min(bytes.len());
        self.written.lock().unwrap().extend(&bytes[..taken]);
        Ok(taken)
    }
}

/// Gives one link, then none.
struct Once(Option<Scripted>);

impl Connector for Once {
    fn connect(&mut self) -> Result<Box<dyn ByteLink>, ConnectError> {
        let link = self.0.take().ok_or(ConnectError::Missing { port: "test".into() })?;
        Ok(Box::new(link))
    }

    fn port(&self) -> String {
        "test".into()
    }
}

/// A loop on `first`, which finds `second` after a loss; its commands, its clock in ms, and its status.
fn looped(first: Scripted, second: Scripted) -> (IoLoop, Sender<Twist2>, Arc<AtomicI64>) {
    let millis = Arc::new(AtomicI64::new(0));
    let now = Arc::clone(&millis);
    let clock: HostClock = Arc::new(move || Stamp::from_nanos(now.load(Ordering::SeqCst) * 1_000_000));
    let (commands, command_queue) = channel();
    let (_, accessories) = channel();
    let (events, _) = sync_channel(9);
    let queues = Queues { commands: command_queue, accessories, events, status: Arc::default() };
    let link: Box<dyn ByteLink> = Box::new(first);
    let connector = Box::new(Once(Some(second)));
    let config = KobukiBaseConfig::default();
    (IoLoop::new(config, clock, connector, (link, FeedbackDecoder::default()), queues), commands, millis)
}

fn scripted(reads: Vec<Vec<u8>>, taken_per_write: usize) -> (Scripted, Arc<Mutex<Vec<u8>>>) {
    let written = Arc::default();
    (Scripted { reads, taken_per_write, written: Arc::clone(&written), stalled: Arc::default() }, written)
}

#[test]
fn half_a_frame_from_before_a_loss_is_not_ended_on_the_new_connection() {
    let mut base = EmulatedKobuki::default();
    let (first, packet) = (base.feedback(&KobukiState::default()), base.feedback(&KobukiState::default()));
    let (first, _) = scripted(vec![first], 3);
    let (second, written) = scripted(vec![Vec::new(), packet[..40].to_vec(), packet[40..].to_vec()], 1000);
    let (mut io_loop, commands, millis) = looped(first, second);
    commands.send(Twist2::new(0.3, 0.0)).unwrap();
    io_loop.step();
    assert!(io_loop.state.is_up && !io_loop.outbox.is_empty());
    io_loop.step();
    assert!(!io_loop.state.is_up && io_loop.link.is_none());
    commands.send(Twist2::new(0.3, 0.0)).unwrap();
    millis.store(100, Ordering::SeqCst);
    (0..4).for_each(|_| io_loop.step());
    assert!(io_loop.state.is_up);
    let zero = KobukiCommand::BaseControl(BaseControl::STOP).encode();
    assert_eq!(*written.lock().unwrap(), [greeting(), zero].concat(), "zero speed and the request alone");
}

#[test]
fn a_base_whose_clock_stands_still_is_lost_and_does_not_come_back_by_opening() {
    let packet = EmulatedKobuki::default().feedback(&KobukiState::default());
    let (first, _) = scripted(vec![packet.clone(), packet.clone()], 1000);
    let (second, _) = scripted(vec![packet.clone(), packet], 1000);
    let (mut io_loop, _commands, millis) = looped(first, second);
    io_loop.step();
    assert!(io_loop.state.is_up);
    millis.store(101, Ordering::SeqCst);
    io_loop.step();
    assert!(!io_loop.state.is_up && io_loop.link.is_none(), "the second packet says nothing new");
    millis.store(1000, Ordering::SeqCst);
    (0..3).for_each(|_| io_loop.step());
    assert!(!io_loop.state.is_up);
}

#[test]
fn attempts_to_open_the_port_come_slower_and_slower() {
    let (first, _) = scripted(Vec::new(), 0);
    let (second, _) = scripted(Vec::new(), 0);
    let (mut io_loop, _commands, millis) = looped(first, second);
    io_loop.connector = Box::new(Once(None));
    io_loop.step();
    let mut attempts = Vec::new();
    for ms in (0..4000).step_by(50) {
        millis.store(ms, Ordering::SeqCst);
        let before = locked(&io_loop.queues.status).counters.reconnects;
        io_loop.step();
        if locked(&io_loop.queues.status).counters.reconnects > before {
            attempts.push(ms);
        }
    }
    assert_eq!(attempts, [100, 300, 700, 1500, 2500, 3500]);
}

#[test]
fn a_thread_that_stands_still_does_not_lose_the_link() {
    let mut base = EmulatedKobuki::default();
    let mut packet = || base.feedback(&KobukiState::default());
    let (mut first, _) = scripted(vec![packet(), Vec::new(), packet(), Vec::new(), Vec::new()], 1000);
    let stalled = Arc::new(AtomicI64::new(0));
    first.stalled = Arc::clone(&stalled);
    let (mut io_loop, _commands, _) = looped(first, scripted(Vec::new(), 0).0);
    io_loop.clock = Arc::new(move || Stamp::from_nanos(stalled.load(Ordering::SeqCst) * 1_000_000));
    let states: Vec<bool> = (0..5)
        .map(|_| {
            io_loop.step();
            io_loop.state.is_up
        })
        .collect();
    assert_eq!(
        states,
        [true, true, true, true, false],
        "the last read began half a second after the last packet"
    );
}

#[test]
fn accessories_do_not_delay_a_speed() {
    let speeds = |with_accessories: bool| -> Vec<Vec<u8>> {
        let mut base = EmulatedKobuki::default();
        let reads = (0..12).map(|_| base.feedback(&KobukiState::default())).collect();
        let (link, written) = scripted(reads, 1000);
        let (mut io_loop, commands, millis) = looped(link, scripted(Vec::new(), 0).0);
        let (accessories, queue) = channel();
        io_loop.queues.accessories = queue;
        let mut speeds = Vec::new();
        for i in 0..12 {
            millis.store(5 * i, Ordering::SeqCst);
            commands.send(Twist2::new(0.01 * i as f64, 0.0)).unwrap();
            if with_accessories {
                accessories.send(KobukiCommand::Outputs(Outputs::from_word(i as u16))).unwrap();
            }
            io_loop.step();
            let bytes = std::mem::take(&mut *written.lock().unwrap());
            assert_eq!(bytes.len() > 10, with_accessories, "the accessory goes out in the same step");
            speeds.push(bytes.into_iter().take(10).collect());
        }
        speeds
    };
    assert_eq!(speeds(true), speeds(false));
}
