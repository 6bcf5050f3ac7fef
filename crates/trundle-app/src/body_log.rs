//! Events of the body over a run: losses of devices, wheel drops, the battery, buttons, the light of a charging station.

use std::collections::BTreeMap;
use trundle_core::{Battery, BodyEventKind, Button, Device};
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
    /// Number of presses of each button.
    pub button_presses: BTreeMap<u8, usize>,
    /// Number of times that the light of a charging station came into view.
    pub station_sightings: usize,
    /// Whether the light of a charging station is in view.
    is_station_in_view: bool,
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
            BodyEventKind::Button(Button { index, pressed: true }) => {
                *self.button_presses.entry(index).or_default() += 1;
            }
            BodyEventKind::DockInfrared(light) => {
                let was_in_view = std::mem::replace(&mut self.is_station_in_view, light.is_any());
                self.station_sightings += usize::from(light.is_any() && !was_in_view);
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
        rows.extend(
            self.button_presses
                .iter()
                .map(|(index, count)| row(format!("presses of button B{index}"), count.to_string())),
        );
        for (name, count) in [
            ("wheel drops", self.wheel_drops),
            ("over-currents", self.over_currents),
            ("sightings of the station's light", self.station_sightings),
        ] {
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
        if !self.button_presses.is_empty() {
            let name = |(index, count): (&u8, &usize)| (format!("B{index}"), *count);
            summary.set("button_presses", self.button_presses.iter().map(name).collect::<BTreeMap<_, _>>());
        }
        for (name, count) in [
            ("wheel_drops", self.wheel_drops),
            ("over_currents", self.over_currents),
            ("silences", self.silences),
            ("station_sightings", self.station_sightings),
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
    use trundle_core::{DockInfrared, Link, PerWheel, PowerSource};

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

    #[test]
    fn presses_are_counted_by_button_and_sightings_of_the_station_by_their_beginnings() {
        let mut log = BodyLog::default();
        for (index, pressed) in [(1, true), (1, false), (2, true), (1, true), (1, false)] {
            log.on_event(BodyEventKind::Button(Button { index, pressed }));
        }
        let (dark, mut light) = (DockInfrared::default(), DockInfrared::default());
        light.left.far_left = true;
        let mut other = light;
        other.center.far_center = true;
        for light in [dark, light, other, light, dark, dark, other] {
            log.on_event(BodyEventKind::DockInfrared(light));
        }
        let rows: Vec<String> = log.rows().iter().map(|row| row.join(": ")).collect();
        assert_eq!(
            rows,
            ["presses of button B1: 2", "presses of button B2: 1", "sightings of the station's light: 2"]
        );
        let mut summary = Summary::new("run");
        log.add_to(&mut summary);
        assert_eq!(summary.get("button_presses"), Some(&serde_json::json!({ "B1": 2, "B2": 1 })));
        assert_eq!(summary.get("station_sightings"), Some(&serde_json::json!(2)));
    }
}
