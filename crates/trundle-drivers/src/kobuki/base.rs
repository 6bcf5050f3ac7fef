//! The driver of a Kobuki base: sensor events out, speeds and accessories in.
//!
//! Two threads: one owns the link, the other calls the sink. A slow sink therefore keeps no command waiting; events beyond 1024 are
//! dropped and counted.
//!
//! The driver stops the base when commands cease, when the link is lost, and at the end. Whether a bumper, a cliff or a hanging wheel
//! stops the robot is decided by the receiver of the events.

use super::accessories::Accessories;
use super::base_config::KobukiBaseConfig;
use super::base_status::{BaseCounters, Status, Versions, locked};
use super::io_loop::{IoLoop, Queues};
use super::link::Connector;
use super::probe::probe;
use super::protocol::{Feedback, Gains, KobukiCommand, Outputs, SoundSequence, Version};
use super::start_error::StartError;
use crate::clock::HostClock;
use std::sync::mpsc::{Receiver, Sender, channel, sync_channel};
use std::sync::{Arc, Mutex};
use std::thread::{Builder, JoinHandle};
use trundle_core::{Invalid, SensorEvent, Twist2, require_in};

/// Maximum number of events that wait for the sink: 1024, five seconds of a base. Source: ours.
const MAX_WAITING_EVENTS: usize = 1024;
/// Largest gain that fits the protocol's 32 bits in thousandths: 4294967. Source: the protocol's "Set Controller Gain".
const MAX_GAIN: f64 = 4_294_967.0;

/// Oldest firmware with commands for gains: 1.2.0. Source: the vendor's driver, issue 289 of yujinrobot/kobuki.
const GAINS_FIRMWARE: Version = Version::new(1, 2, 0);

/// Receiver of the events of a base, called on the base's thread.
pub type EventSink = Box<dyn FnMut(SensorEvent) + Send>;

/// A running base. A drop stops the base.
#[derive(Debug)]
pub struct KobukiBase {
    commands: Sender<Twist2>,
    accessories: Accessories,
    status: Arc<Mutex<Status>>,
    threads: Vec<JoinHandle<()>>,
}

impl KobukiBase {
    /// Opens the port, stops the base, waits until it has sent packets and versions, and starts the threads.
    ///
    /// `sink` receives the events in the order of their stamps, which are in the time of `clock`. The first event is the link's.
    ///
    /// # Errors
    /// When a setting is out of range, the port cannot be opened, or no Kobuki answers within `start_limit_s`.
    pub fn start(
        mut connector: Box<dyn Connector>,
        config: KobukiBaseConfig,
        clock: HostClock,
        sink: EventSink,
    ) -> Result<Self, StartError> {
        let config = config.validated()?;
        let mut link = connector.connect()?;
        let port = connector.port();
        let (decoder, versions) = probe(&mut *link, &port, &config, &clock)?;
        let status = Arc::new(Mutex::new(Status { versions, ..Status::default() }));
        let (commands, command_queue) = channel();
        let (accessories, accessory_queue) = channel();
        let (events, event_queue) = sync_channel(MAX_WAITING_EVENTS);
        let queues = Queues {
            commands: command_queue,
            accessories: accessory_queue,
            events,
            status: Arc::clone(&status),
        };
        let io_loop = IoLoop::new(config, clock, connector, (link, decoder), queues);
        let accessories = Accessories::new(accessories);
        let mut base = Self { commands, accessories, status, threads: Vec::new() };
        base.spawn("kobuki-events", &port, move || deliver(&event_queue, sink))?;
        base.spawn("kobuki-link", &port, move || io_loop.run())?;
        Ok(base)
    }

    /// A sender of speeds: v in m/s, omega in rad/s, counter-clockwise. The newest speed is active for `command_timeout_s`, then the base
    /// stops. Speeds sent while the link is down are dropped.
    pub fn commands(&self) -> Sender<Twist2> {
        self.commands.clone()
    }

    /// Lights, sounds and outputs, for other threads.
    pub fn accessories(&self) -> Accessories {
        self.accessories.clone()
    }

    /// Sets all outputs: digital outputs, supplies, lights. They are set again after the return of a lost link.
    pub fn set_outputs(&self, outputs: Outputs) {
        self.accessories.set_outputs(outputs);
    }

    /// Plays a melody of the firmware. While the link is down the newest melody waits for its return.
    pub fn play(&self, sequence: SoundSequence) {
        self.accessories.play(sequence);
    }

    /// Plays a note of `frequency_hz` (Hz) for `duration_ms`.
    pub fn play_note(&self, frequency_hz: f64, duration_ms: u8) {
        self.accessories.send(KobukiCommand::note(frequency_hz, duration_ms));
    }

    /// Sets the gains of the wheels' speed controllers. Firmware 1.2.0 or later. They are set again after the return of a lost link.
    ///
    /// # Errors
    /// When a gain is below zero or above 4294967.
    pub fn set_gains(&self, gains: Gains) -> Result<(), Invalid> {
        for (name, gain) in [("gain p", gains.p), ("gain i", gains.i), ("gain d", gains.d)] {
            require_in(name, gain, "", 0.0, MAX_GAIN)?;
        }
        self.warn_of_old_firmware();
        self.accessories.send(KobukiCommand::SetGains(gains));
        Ok(())
    }

    /// Requests the gains; [`KobukiBase::gains`] returns them after the answer. Firmware 1.2.0 or later.
    pub fn request_gains(&self) {
        self.warn_of_old_firmware();
        self.accessories.send(KobukiCommand::GetGains);
    }

    /// Gains in the last report of the base.
    pub fn gains(&self) -> Option<Gains> {
        locked(&self.status).gains
    }

    /// Versions and unique id.
    pub fn versions(&self) -> Versions {
        locked(&self.status).versions
    }

    /// Events on the link since the start.
    pub fn counters(&self) -> BaseCounters {
        locked(&self.status).counters
    }

    /// Whether the base answers.
    pub fn is_up(&self) -> bool {
        locked(&self.status).is_up
    }

    /// The last packet: it also holds the values without an event: currents, cliff signals, inputs.
    pub fn latest(&self) -> Option<Feedback> {
        locked(&self.status).latest.clone()
    }

    /// Sends zero speed, closes the port, and waits for the threads. The call blocks as long as the sink does.
    pub fn stop(self) {
        drop(self);
    }

    fn warn_of_old_firmware(&self) {
        if let Some(firmware) = self.versions().firmware.filter(|firmware| *firmware < GAINS_FIRMWARE) {
            tracing::warn!(
                "the base's firmware is {firmware}, expected {GAINS_FIRMWARE} or later for gains: it ignores them"
            );
        }
    }

    fn spawn(
        &mut self,
        name: &str,
        port: &str,
        run: impl FnOnce() + Send + 'static,
    ) -> Result<(), StartError> {
        let thread = Builder::new().name(name.to_owned()).spawn(run);
        self.threads.push(thread.map_err(|source| StartError::Thread { port: port.to_owned(), source })?);
        Ok(())
    }
}

impl Drop for KobukiBase {
    fn drop(&mut self) {
        locked(&self.status).is_stopping = true;
        for thread in self.threads.drain(..).rev() {
            if thread.join().is_err() {
                tracing::warn!("a thread of the base has panicked");
            }
        }
    }
}

fn deliver(events: &Receiver<SensorEvent>, mut sink: EventSink) {
    events.iter().for_each(&mut sink);
}
