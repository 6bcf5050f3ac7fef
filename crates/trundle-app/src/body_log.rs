//! Events of the body over a run: losses of devices, wheel drops, the battery.

use std::collections::BTreeMap;
use trundle_core::{Battery, BodyEventKind, Device};
use trundle_io::Summary;

/// Events of the body over a run.
#[derive(Debug, Default, Clone)]
pub struct BodyLog {
    /// Number of losses of each device.
    pub losses: BTreeMap<Device, usize>,
    /// Number of times that a wheel left the floor.
    pub wheel_drops: usize,
    /// Number of times that a wheel motor drew too much current.
    pub over_currents: usize,
    /// Times of silence that the body reported.
    pub silences: usize,
    /// First and newest state of the battery.
    pub battery: Option<(Battery, Battery)>,
}

impl BodyLog {
    /// Logs an event.
    pub fn on_event(&mut self, event: BodyEventKind) {
        match event {
            BodyEventKind::Link(link) if !link.is_up => *self.losses.entry(link.device).or_default() += 1,
            BodyEventKind::WheelDrop(wheels) => self.wheel_drops += usize::from(wheels.any()),
            BodyEventKind::OverCurrent(wheels) => self.over_currents += usize::from(wheels.any()),
            BodyEventKind::Silence => self.silences += 1,
            BodyEventKind::Battery(newest) => {
                self.battery = Some((self.battery.map_or(newest, |(first, _)| first), newest));
            }
            _ => {}
        }
    }

    /// Rows for people; none of a body that reports no such events.
    pub fn rows(&self) -> Vec<Vec<String>> {
        let row = |name: String, value: String| vec![name, value];
        let mut rows = Vec::new();
        if let Some((first, last)) = &self.battery {
            rows.push(row(
                "battery".to_owned(),
                format!("{} -> {}", battery_text(first), battery_text(last)),
            ));
        }
        rows.extend(
            self.losses
                .iter()
                .map(|(device, count)| row(format!("losses of the {device}"), count.to_string())),
        );
        for (name, count) in [("wheel drops", self.wheel_drops), ("over-currents", self.over_currents)] {
            if count > 0 {
                rows.push(row(name.to_owned(), count.to_string()));
            }
        }
        rows
    }

    /// Adds the figures to a summary; none of a body that reports no such events.
    pub fn add_to(&self, summary: &mut Summary) {
        if let Some((first, last)) = &self.battery {
            summary.set("battery_start", first).set("battery_end", last);
        }
        if !self.losses.is_empty() {
            summary.set("device_losses", &self.losses);
        }
        for (name, count) in [
            ("wheel_drops", self.wheel_drops),
            ("over_currents", self.over_currents),
            ("silences", self.silences),
        ] {
            if count > 0 {
                summary.set(name, count);
            }
        }
    }
}

fn battery_text(battery: &Battery) -> String {
    let charge = battery.charge.map_or_else(String::new, |charge| format!(", {:.0} %", charge * 100.0));
    format!("{:.1} V{charge}", battery.voltage_v)
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{Link, PerWheel, PowerSource};

    #[test]
    fn losses_are_counted_and_returns_are_not() {
        let mut log = BodyLog::default();
        assert!(log.rows().is_empty());
        for is_up in [false, true, false] {
            log.on_event(BodyEventKind::Link(Link { device: Device::Camera, is_up }));
            log.on_event(BodyEventKind::WheelDrop(PerWheel { left: !is_up, right: false }));
        }
        let battery = |voltage_v, charge| {
            BodyEventKind::Battery(Battery {
                voltage_v,
                charge,
                source: PowerSource::Battery,
                is_charging: false,
            })
        };
        log.on_event(battery(16.0, Some(0.8)));
        log.on_event(battery(15.5, None));
        let rows: Vec<String> = log.rows().iter().map(|row| row.join(": ")).collect();
        assert_eq!(rows, ["battery: 16.0 V, 80 % -> 15.5 V", "losses of the camera: 2", "wheel drops: 2"]);
    }
}
