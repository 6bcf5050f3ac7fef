//! Reports of the robot's body about the station: light on change, and the battery.

use super::config::StationConfig;
use super::contacts::touches_plates;
use super::light::{beams, is_in_sight, receivers};
use crate::rng::{hash, normal, unit};
use crate::world::SceneSnapshot;
use trundle_core::{Battery, BodyEventKind, DockBeams, DockInfrared, Footprint, Pose2, PowerSource};

/// Voltage of the simulated battery \[V\]: nearly full. Source: the emulated Kobuki's default.
const BATTERY_V: f64 = 16.5;
/// Number of receivers. Source: the protocol's "Docking IR": left, central and right.
const RECEIVER_COUNT: u64 = 3;
/// Draws of a receiver in a reading. Source: ours.
const DRAWS_PER_RECEIVER: u64 = 2;

/// The body's receivers and charger near the station of the scene.
#[derive(Debug)]
pub(crate) struct StationSensing {
    config: StationConfig,
    /// `world_from_station`.
    station: Pose2,
    /// `base_from_receiver`: left, middle, right.
    receivers: [Pose2; 3],
    seed: u64,
    readings: u64,
    light: DockInfrared,
    source: Option<PowerSource>,
}

impl StationSensing {
    /// Sensors near a station at `world_from_station`; `seed` is the seed of the noise.
    pub(crate) fn new(config: StationConfig, station: Pose2, seed: u64) -> Self {
        let (receivers, light) = (receivers(&config), DockInfrared::default());
        Self { config, station, receivers, seed, readings: 0, light, source: None }
    }

    /// The changes at a base at `pose`, `world_from_base`. The first reading has the battery's state.
    pub(crate) fn read(
        &mut self,
        pose: Pose2,
        footprint: &Footprint,
        snapshot: &SceneSnapshot<'_>,
    ) -> Vec<BodyEventKind> {
        let mut events = Vec::new();
        let light = self.light_at(pose, snapshot);
        if light != self.light {
            self.light = light;
            events.push(BodyEventKind::DockInfrared(light));
        }
        let source = self.source_at(pose, footprint);
        if self.source != Some(source) {
            self.source = Some(source);
            events.push(BodyEventKind::Battery(battery(source)));
        }
        events
    }

    fn light_at(&mut self, pose: Pose2, snapshot: &SceneSnapshot<'_>) -> DockInfrared {
        let reading = self.readings;
        self.readings += 1;
        let [left, center, right] = [0, 1, 2].map(|which: usize| {
            let receiver = pose * self.receivers[which];
            let draw =
                |k: u64| hash(self.seed, (reading * RECEIVER_COUNT + which as u64) * DRAWS_PER_RECEIVER + k);
            let error = self.config.edge_noise_deg.to_radians() * normal(draw(0));
            let is_missed = unit(draw(1)) < self.config.miss_probability;
            let seen = beams(&self.config, self.station.inverse() * receiver, error);
            let is_dark = is_missed || seen == DockBeams::default();
            let is_seen = !is_dark && is_in_sight(snapshot, self.station, receiver.position());
            if is_seen { seen } else { DockBeams::default() }
        });
        DockInfrared { left, center, right }
    }

    fn source_at(&self, pose: Pose2, footprint: &Footprint) -> PowerSource {
        let touches = touches_plates(&self.config, footprint, self.station.inverse() * pose);
        if touches && self.config.charges { PowerSource::ChargingStation } else { PowerSource::Battery }
    }
}

fn battery(source: PowerSource) -> Battery {
    let is_charging = source == PowerSource::ChargingStation;
    Battery { voltage_v: BATTERY_V, charge: None, source, is_charging }
}
