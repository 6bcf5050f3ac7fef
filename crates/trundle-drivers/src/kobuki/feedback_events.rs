//! Sensor events out of feedback packets.
//!
//! The gyro's events come from its raw readings. The firmware's calibrated rate is one value per packet, so turns between packets are lost;
//! the firmware also subtracts its own bias. The raw readings are complete, two or three per packet, with a constant bias that the
//! localization estimates. Their z axis is up: counter-clockwise is positive, as in the base's frame.
//!
//! The base's stamps are mapped to the host's clock by a [`DeviceClock`]. Stamps of the events never run backwards.

use super::protocol::{Charger, CoreSensors, Feedback, ThreeSides};
use crate::clock::{DeviceClock, DeviceClockConfig, MillisUnwrapper};
use serde::{Deserialize, Serialize};
use trundle_core::{
    Battery, BodyEvent, BodyEventKind, Button, Cliff, Device, DockInfrared, GyroRate, Link, PerWheel,
    SensorEvent, Stamp, Touch, WheelTicks,
};

/// Time between feedback packets: 0.02 s. Source: the protocol's "Feedback Identifier", 50 Hz.
pub const FEEDBACK_PERIOD_S: f64 = 0.02;
/// Voltage of an empty battery: 13.2 V. Source: the vendor's driver, "dangerous" level.
const EMPTY_BATTERY_V: f64 = 13.2;
/// Voltage of a full battery: 16.7 V. Source: the protocol's "Basic Sensor Data".
const FULL_BATTERY_V: f64 = 16.7;
/// Time between battery events while only the voltage changes: 1 s. Source: ours.
const BATTERY_PERIOD_S: f64 = 1.0;

/// Source of the gyro's events.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GyroSource {
    /// The raw readings, two or three per packet, with the sensor's bias.
    #[default]
    Raw,
    /// The rate that the firmware calibrates, one per packet.
    Calibrated,
}

/// Converts feedback packets to events, in order; stores the reported states.
#[derive(Debug, Clone)]
pub struct FeedbackEvents {
    gyro_source: GyroSource,
    unwrapper: MillisUnwrapper,
    clock: DeviceClock,
    /// Device time of the last packet, ns.
    last_device: Option<i64>,
    /// Stamp of the last packet.
    last_packet: Option<Stamp>,
    /// Stamp of the last event.
    last_event: Option<Stamp>,
    reported: Reported,
}

/// States as last reported: a change of one is an event.
#[derive(Debug, Clone, Copy, Default)]
struct Reported {
    bumper: bool,
    cliff: bool,
    wheel_drop: PerWheel,
    over_current: PerWheel,
    buttons: [bool; 3],
    dock: DockInfrared,
    battery: Option<(Stamp, Charger, u8)>,
}

impl FeedbackEvents {
    /// A converter. `transport_delay_s`: smallest time from the base's stamp to the arrival, s.
    pub fn new(gyro_source: GyroSource, transport_delay_s: f64) -> Self {
        let clock = DeviceClock::new(DeviceClockConfig { transport_delay_s, ..DeviceClockConfig::default() });
        Self {
            gyro_source,
            unwrapper: MillisUnwrapper::default(),
            clock,
            last_device: None,
            last_packet: None,
            last_event: None,
            reported: Reported::default(),
        }
    }

    /// The events of a packet that arrived at `arrival` (host's clock), in the order of their stamps.
    ///
    /// A packet without core sensors has no stamp and gives none; neither does one with the stamp of the packet before.
    pub fn events(&mut self, feedback: &Feedback, arrival: Stamp) -> Vec<SensorEvent> {
        let Some(core) = feedback.core else { return Vec::new() };
        let device = self.unwrapper.unwrap(core.stamp_ms, arrival);
        if self.last_device.replace(device) == Some(device) {
            return Vec::new();
        }
        let mapped = self.clock.to_host(device, arrival);
        let stamp = self.last_event.map_or(mapped, |last| mapped.max(last));
        let mut events = self.gyro_events(feedback, stamp);
        let (left, right) = (core.left_ticks, core.right_ticks);
        events.push(SensorEvent::Wheels(WheelTicks { stamp, left, right }));
        self.push_contacts(&core, stamp, &mut events);
        self.push_body(&core, feedback.dock, stamp, &mut events);
        (self.last_packet, self.last_event) = (Some(stamp), Some(stamp));
        events
    }

    /// The event of a lost link at `now` (host's clock), or of one that is up again.
    pub fn link_event(&mut self, is_up: bool, now: Stamp) -> SensorEvent {
        let stamp = self.last_event.map_or(now, |last| now.max(last));
        self.last_event = Some(stamp);
        body(stamp, BodyEventKind::Link(Link { device: Device::Base, is_up }))
    }

    /// Events of the first packet of a link: first the link's event, with the stamp of the packet's first event. The estimate of the base's
    /// clock restarts.
    pub fn events_after_link_up(&mut self, feedback: &Feedback, arrival: Stamp) -> Vec<SensorEvent> {
        self.clock.restart();
        (self.unwrapper, self.last_device) = (MillisUnwrapper::default(), None);
        let mut events = self.events(feedback, arrival);
        let stamp = events.first().map_or(arrival, SensorEvent::stamp);
        events.insert(0, body(stamp, BodyEventKind::Link(Link { device: Device::Base, is_up: true })));
        events
    }

    /// Jumps of the base's clock so far.
    pub fn clock_jumps(&self) -> u64 {
        self.clock.jumps()
    }

    /// The gyro's readings, spread evenly over the time since the last packet, at most one period.
    fn gyro_events(&self, feedback: &Feedback, stamp: Stamp) -> Vec<SensorEvent> {
        let rates: Vec<f64> = match self.gyro_source {
            GyroSource::Raw => {
                feedback.gyro.iter().flat_map(|gyro| gyro.rates()).map(|[_, _, z]| z).collect()
            }
            GyroSource::Calibrated => feedback.inertia.iter().map(|inertia| inertia.rate()).collect(),
        };
        let earliest = stamp.after(-FEEDBACK_PERIOD_S);
        let begin = [self.last_packet, self.last_event].into_iter().flatten().fold(earliest, Stamp::max);
        let step = (stamp - begin) / rates.len().max(1) as f64;
        let after = |i: usize| stamp.after(-step * (rates.len() - 1 - i) as f64);
        let event =
            |(i, omega): (usize, &f64)| SensorEvent::Gyro(GyroRate { stamp: after(i), omega: *omega });
        rates.iter().enumerate().map(event).collect()
    }

    fn push_contacts(&mut self, core: &CoreSensors, stamp: Stamp, events: &mut Vec<SensorEvent>) {
        let any = |sides: ThreeSides| sides.any();
        if let Some(pressed) = changed(&mut self.reported.bumper, any(core.bumper)) {
            events.push(SensorEvent::Touch(Touch { stamp, pressed }));
        }
        if let Some(over_edge) = changed(&mut self.reported.cliff, any(core.cliff)) {
            events.push(SensorEvent::Cliff(Cliff { stamp, over_edge }));
        }
    }

    fn push_body(
        &mut self,
        core: &CoreSensors,
        dock: Option<DockInfrared>,
        stamp: Stamp,
        events: &mut Vec<SensorEvent>,
    ) {
        let reported = &mut self.reported;
        let mut kinds = Vec::new();
        kinds.extend(changed(&mut reported.wheel_drop, core.wheel_drop).map(BodyEventKind::WheelDrop));
        kinds.extend(changed(&mut reported.over_current, core.over_current).map(BodyEventKind::OverCurrent));
        kinds
            .extend(dock.and_then(|dock| changed(&mut reported.dock, dock)).map(BodyEventKind::DockInfrared));
        for (index, pressed) in (0..).zip(core.buttons) {
            let change = changed(&mut reported.buttons[usize::from(index)], pressed);
            kinds.extend(change.map(|pressed| BodyEventKind::Button(Button { index, pressed })));
        }
        kinds.extend(reported.battery_change(core, stamp).map(BodyEventKind::Battery));
        events.extend(kinds.into_iter().map(|kind| body(stamp, kind)));
    }
}

impl Reported {
    /// The battery's event: a change of the charger immediately, a change of the voltage once per second.
    fn battery_change(&mut self, core: &CoreSensors, stamp: Stamp) -> Option<Battery> {
        let (charger, decivolts) = (core.charger, core.battery_decivolts);
        let is_news = self.battery.is_none_or(|(then, last_charger, last_decivolts)| {
            charger != last_charger || (decivolts != last_decivolts && stamp - then >= BATTERY_PERIOD_S)
        });
        is_news.then(|| {
            self.battery = Some((stamp, charger, decivolts));
            let voltage_v = core.battery_v();
            let charge = Some(charge_of(voltage_v));
            Battery { voltage_v, charge, source: charger.source, is_charging: charger.is_charging }
        })
    }
}

/// Estimate of the charge, 0 to 1, linear in the voltage (V). The estimate is too low under load and too high while charging.
pub fn charge_of(voltage_v: f64) -> f64 {
    ((voltage_v - EMPTY_BATTERY_V) / (FULL_BATTERY_V - EMPTY_BATTERY_V)).clamp(0.0, 1.0)
}

/// The new state if it differs from the reported one, which is then replaced.
fn changed<T: PartialEq + Copy>(reported: &mut T, state: T) -> Option<T> {
    (*reported != state).then(|| {
        *reported = state;
        state
    })
}

fn body(stamp: Stamp, kind: BodyEventKind) -> SensorEvent {
    SensorEvent::Body(BodyEvent::new(stamp, kind))
}

#[cfg(test)]
mod tests;
