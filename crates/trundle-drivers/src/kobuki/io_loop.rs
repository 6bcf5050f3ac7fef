//! The thread that owns the link to a base: it reads, writes, and opens the port again after a loss.
//!
//! The port is closed when the link counts as lost, which discards bytes from before the loss. The first bytes of a new connection are zero
//! speed. Speeds that come while the link is down are dropped; of lights, sounds and gains the newest are sent after its return.
//!
//! Two bases on one port are a lost link until a window of packets is that of one base. A base other than the run's is a lost link until
//! the run's base answers.

use super::base_config::KobukiBaseConfig;
use super::base_identity::BaseIdentity;
use super::base_status::{Status, locked};
use super::command_schedule::CommandSchedule;
use super::decoder::FeedbackDecoder;
use super::feedback_events::FeedbackEvents;
use super::kept_accessories::KeptAccessories;
use super::link::{ByteLink, Connector};
use super::link_state::{LinkState, Loss, LostLink};
use super::outbox::Outbox;
use super::probe::greeting;
use super::protocol::{BaseControl, Feedback, KobukiCommand};
use super::stream_check::{StreamCheck, StreamFault};
use crate::clock::HostClock;
use std::sync::mpsc::{Receiver, SyncSender};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use trundle_core::{SensorEvent, Stamp, Twist2};

/// Longest wait for bytes: 5 ms, by which a command may be late. Source: ours, a quarter of a packet's period.
const READ_WAIT: Duration = Duration::from_millis(5);
/// Period of checks of the queues while the port is closed: 10 ms. Source: ours.
const CLOSED_WAIT: Duration = Duration::from_millis(10);
/// Time that an opened port is given to bring the first packet: 1 s. Source: ours; a base needs less after it is switched on.
const FIRST_PACKET_LIMIT_S: f64 = 1.0;
/// Maximum number of commands read from a queue in one step: 256. Source: ours; a flood of commands must not delay packets.
const MAX_COMMANDS_AT_ONCE: usize = 256;
/// Time that the last zero speed is given to go out: 0.2 s. Source: ours.
const STOP_LIMIT_S: f64 = 0.2;

/// The queues between a base's thread and its users.
pub(super) struct Queues {
    pub(super) commands: Receiver<Twist2>,
    pub(super) accessories: Receiver<KobukiCommand>,
    pub(super) events: SyncSender<SensorEvent>,
    pub(super) status: Arc<Mutex<Status>>,
}

/// The link's state.
pub(super) struct IoLoop {
    config: KobukiBaseConfig,
    clock: HostClock,
    connector: Box<dyn Connector>,
    queues: Queues,
    link: Option<Box<dyn ByteLink>>,
    state: LinkState,
    decoder: FeedbackDecoder,
    events: FeedbackEvents,
    schedule: CommandSchedule,
    check: StreamCheck,
    identity: BaseIdentity,
    outbox: Outbox,
    accessories: KeptAccessories,
    /// Stamp of the newest packet \[ms\], of this connection or the previous one.
    last_ms: Option<u16>,
}

impl IoLoop {
    pub(super) fn new(
        config: KobukiBaseConfig,
        clock: HostClock,
        connector: Box<dyn Connector>,
        (link, decoder): (Box<dyn ByteLink>, FeedbackDecoder),
        queues: Queues,
    ) -> Self {
        let identity = BaseIdentity::new(locked(&queues.status).versions.unique_id);
        Self {
            config,
            state: LinkState::new(clock(), config.min_retry_s),
            clock,
            connector,
            queues,
            link: Some(link),
            decoder,
            events: FeedbackEvents::new(config.gyro_source, config.transport_delay_s),
            schedule: CommandSchedule::new(config.command_timeout_s),
            check: StreamCheck::default(),
            identity,
            outbox: Outbox::default(),
            accessories: KeptAccessories::default(),
            last_ms: None,
        }
    }

    /// Runs until the base is stopped, then sends zero speed.
    pub(super) fn run(mut self) {
        while !locked(&self.queues.status).is_stopping {
            self.step();
        }
        self.stop();
    }

    fn step(&mut self) {
        match self.link.take() {
            None => self.reconnect(),
            Some(mut link) => match self.exchange(&mut *link) {
                Ok(()) => self.link = Some(link),
                Err(lost) => self.lose(&lost),
            },
        }
    }

    /// Reads packets, stores commands, writes. A speed goes out before accessories that came with it.
    fn exchange(&mut self, link: &mut dyn ByteLink) -> Result<(), LostLink> {
        let (before, was_up) = ((self.clock)(), self.state.is_up);
        self.read(link)?;
        let limit = if self.state.is_up { self.config.silence_limit_s } else { FIRST_PACKET_LIMIT_S };
        // Packets that waited during a pause of this thread have been read: only the time before counts.
        if before - self.state.since >= limit {
            return Err(LostLink::new(Loss::Silence, format!("no new packet came for {limit} s")));
        }
        let now = (self.clock)();
        self.take_speeds(now);
        self.queue_speed(now);
        if self.state.is_up && !was_up {
            self.restore_accessories();
        }
        self.take_accessories();
        if self.identity.is_request_due(now) {
            self.greet(now);
        }
        Ok(self.outbox.write(link, now)?)
    }

    fn read(&mut self, link: &mut dyn ByteLink) -> Result<(), LostLink> {
        let mut buffer = [0; 4096];
        let bytes = link.read(&mut buffer, READ_WAIT)?;
        if bytes == 0 {
            return Ok(());
        }
        let arrival = (self.clock)();
        let refused = self.decoder.counters().refused();
        let mut packets = Vec::new();
        self.decoder.push(&buffer[..bytes], |feedback| packets.push(feedback));
        self.check.on_refused(self.decoder.counters().refused() - refused);
        packets.into_iter().try_for_each(|feedback| self.on_feedback(feedback, arrival))?;
        self.report_fault()?;
        let mut status = locked(&self.queues.status);
        status.counters.decoder = self.decoder.counters();
        status.counters.clock_jumps = self.events.clock_jumps();
        Ok(())
    }

    /// Handles a packet.
    ///
    /// # Errors
    /// When another base answers than the run's.
    fn on_feedback(&mut self, feedback: Feedback, arrival: Stamp) -> Result<(), LostLink> {
        if let Some(id) = feedback.unique_id {
            self.identity.on_answer(id).map_err(|other| LostLink::new(Loss::OtherBase, other))?;
        }
        if let Some(core) = feedback.core {
            self.check.on_packet(core.stamp_ms);
        }
        // A packet with the stamp of the previous one has no new content.
        let stamp_ms = feedback.core.map(|core| core.stamp_ms);
        if stamp_ms.is_some() && std::mem::replace(&mut self.last_ms, stamp_ms) != stamp_ms {
            let is_steady = self.state.on_packet(arrival, self.config.silence_limit_s);
            let events = if is_steady && self.identity.is_confirmed() {
                self.link_up(arrival);
                self.events.events_after_link_up(&feedback, arrival)
            } else if self.state.is_up {
                self.events.events(&feedback, arrival)
            } else {
                Vec::new()
            };
            events.into_iter().for_each(|event| self.deliver(event));
        }
        let mut status = locked(&self.queues.status);
        status.versions.update(&feedback);
        status.gains = feedback.gains.or(status.gains);
        status.latest = Some(feedback);
        Ok(())
    }

    /// The first packet of a connection: speeds from before are dropped. Zero speed is sent since the port is open.
    fn link_up(&mut self, now: Stamp) {
        self.take_speeds(now);
        self.take_accessories();
        (self.state.is_up, self.state.retry_s) = (true, self.config.min_retry_s);
        locked(&self.queues.status).is_up = true;
        tracing::info!("port {}: the base answers", self.connector.port());
    }

    fn restore_accessories(&mut self) {
        self.accessories.on_return().for_each(|command| self.outbox.push(&command.encode()));
    }

    fn take_speeds(&mut self, now: Stamp) {
        let mut dropped = 0;
        for twist in self.queues.commands.try_iter().take(MAX_COMMANDS_AT_ONCE) {
            if self.state.is_up {
                self.schedule.set(twist, now);
            } else {
                dropped += 1;
            }
        }
        self.count_dropped(dropped);
    }

    fn take_accessories(&mut self) {
        let mut dropped = 0;
        for command in self.queues.accessories.try_iter().take(MAX_COMMANDS_AT_ONCE) {
            if self.state.is_up {
                self.accessories.note_sent(command);
                self.outbox.push(&command.encode());
            } else {
                dropped += u64::from(self.accessories.note_unsent(command));
            }
        }
        self.count_dropped(dropped);
    }

    fn count_dropped(&self, commands: u64) {
        if commands > 0 {
            locked(&self.queues.status).counters.commands_dropped += commands;
        }
    }

    /// Queues the speed that is due, if the line has taken all earlier bytes.
    fn queue_speed(&mut self, now: Stamp) {
        if self.outbox.is_empty()
            && let Some(control) = self.schedule.due(now)
        {
            self.outbox.push(&KobukiCommand::BaseControl(control).encode());
            locked(&self.queues.status).counters.speeds_sent += 1;
        }
    }

    fn lose(&mut self, lost: &LostLink) {
        let now = (self.clock)();
        let was_up = self.state.is_up;
        if was_up || lost.loss == Loss::OtherBase && self.identity.refusals().is_power_of_two() {
            tracing::warn!(
                "port {}: the link to the base is lost: {lost}; it is opened again",
                self.connector.port()
            );
        }
        if was_up {
            let event = self.events.link_event(false, now);
            self.deliver(event);
        }
        let mut status = locked(&self.queues.status);
        status.counters.link_losses += u64::from(was_up);
        status.is_up = false;
        drop(status);
        self.state.lose(now, lost.loss);
        self.identity.forget();
        self.decoder.clear();
        self.outbox.clear();
        self.schedule.restart();
    }

    /// Opens the port if the next attempt is due.
    fn reconnect(&mut self) {
        let now = (self.clock)();
        self.take_speeds(now);
        self.take_accessories();
        if now - self.state.since < self.state.retry_s {
            return std::thread::sleep(CLOSED_WAIT);
        }
        let retry_s = (2.0 * self.state.retry_s).min(self.config.max_retry_s);
        (self.state.since, self.state.retry_s) = (now, retry_s);
        locked(&self.queues.status).counters.reconnects += 1;
        match self.connector.connect() {
            Ok(link) => {
                self.greet(now);
                self.link = Some(link);
            }
            Err(error) => tracing::debug!("{error}"),
        }
    }

    fn greet(&mut self, now: Stamp) {
        self.outbox.push(&greeting());
        self.identity.note_request(now);
    }

    fn deliver(&self, event: SensorEvent) {
        if self.queues.events.try_send(event).is_err() {
            let counters = &mut locked(&self.queues.status).counters;
            counters.events_dropped += 1;
            if counters.events_dropped.is_power_of_two() {
                let dropped = counters.events_dropped;
                tracing::warn!("{dropped} events of the base are dropped: their receiver is too slow");
            }
        }
    }

    /// Warns when the stream becomes faulty: the first time, the second, the fourth and so on.
    ///
    /// # Errors
    /// When two bases send on the port and the link is up. A link that is down stays so until one base has sent alone for a second.
    fn report_fault(&mut self) -> Result<(), LostLink> {
        let new = self.check.new_fault();
        locked(&self.queues.status).counters.stream_faults += u64::from(new.is_some());
        if let Some(fault @ StreamFault::TwoSources { .. }) = self.check.fault() {
            self.state.restart_count();
            let lost = self.state.is_up.then(|| LostLink::new(Loss::OtherBase, fault));
            return lost.map_or(Ok(()), Err);
        }
        let Some((fault, count)) = new else { return Ok(()) };
        let port = self.connector.port();
        match count {
            1 => tracing::warn!("port {port}: {fault}"),
            _ if count.is_power_of_two() => {
                tracing::warn!("port {port}: {fault} ({count} faults of the stream so far)");
            }
            _ => {}
        }
        Ok(())
    }

    /// Sends zero speed, then the accessories that still wait.
    fn stop(&mut self) {
        let Some(mut link) = self.link.take() else { return };
        self.outbox.push(&KobukiCommand::BaseControl(BaseControl::STOP).encode());
        self.take_accessories();
        let start = (self.clock)();
        while !self.outbox.is_empty() && (self.clock)() - start < STOP_LIMIT_S {
            if let Err(error) = self.outbox.write(&mut *link, start) {
                return tracing::warn!("port {}: the base is not stopped: {error}", self.connector.port());
            }
            if !self.outbox.is_empty() {
                std::thread::sleep(READ_WAIT);
            }
        }
    }
}

#[cfg(test)]
mod tests;
