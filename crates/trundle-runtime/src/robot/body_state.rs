//! State of the body besides its motion: holding conditions and the battery.

use crate::range_source::RangeSource;
use trundle_control::MotionHold;
use trundle_core::{Battery, BodyEventKind, Button, Device, DockInfrared, Link, PerWheel, PowerSource};

/// Charge below which the battery counts as empty and the robot stops, 0 to 1. The motors of a Kobuki fail soon below it. Source: ours.
const EMPTY_CHARGE: f64 = 0.02;
/// Number of the button that pauses and continues the robot. Source: button B0 of a Kobuki.
const PAUSE_BUTTON: u8 = 0;

/// State of the body besides its motion.
#[derive(Debug, Default)]
pub(super) struct BodyState {
    wheel_drop: PerWheel,
    over_current: PerWheel,
    battery: Option<Battery>,
    station_light: DockInfrared,
    lost: Vec<Device>,
    is_paused: bool,
    is_goal_link_lost: bool,
}

impl BodyState {
    /// Updates the state by an event.
    pub(super) fn update(&mut self, event: BodyEventKind) {
        match event {
            BodyEventKind::WheelDrop(wheels) => self.wheel_drop = wheels,
            BodyEventKind::OverCurrent(wheels) => self.over_current = wheels,
            BodyEventKind::Battery(battery) => self.battery = Some(battery),
            BodyEventKind::DockInfrared(light) => self.station_light = light,
            BodyEventKind::Button(Button { index: PAUSE_BUTTON, pressed: true }) => {
                self.is_paused = !self.is_paused;
            }
            BodyEventKind::Link(link) => self.set_link(link),
            _ => {}
        }
    }

    /// Sets whether a person has paused the robot.
    pub(super) fn set_paused(&mut self, is_paused: bool) {
        self.is_paused = is_paused;
    }

    /// Notes that the link by which goals come has died: the hold lasts until the program is started anew.
    pub(super) fn lose_goal_link(&mut self) {
        self.is_goal_link_lost = true;
    }

    /// The battery; `None` before the body's first report.
    pub(super) fn battery(&self) -> Option<Battery> {
        self.battery
    }

    /// The last reported light of a charging station.
    pub(super) fn station_light(&self) -> DockInfrared {
        self.station_light
    }

    /// Whether the robot is on the contacts of a charging station.
    pub(super) fn is_docked(&self) -> bool {
        self.battery.is_some_and(|battery| battery.source == PowerSource::ChargingStation)
    }

    /// Whether a wheel has dropped. The odometry does not measure a lifted robot's motion.
    pub(super) fn is_lifted(&self) -> bool {
        self.wheel_drop.any()
    }

    /// The first condition under which no wheel may turn; `None` if the robot may drive. The camera counts for every range source, since
    /// the visual map needs it.
    pub(super) fn hold(&self, range_source: RangeSource) -> Option<MotionHold> {
        let link = self.is_goal_link_lost.then_some(MotionHold::GoalLinkLost);
        let paused = self.is_paused.then_some(MotionHold::Paused);
        self.hold_besides_pause(range_source).or(link).or(paused)
    }

    /// The first condition of the body itself, for a robot that a person drives by hand.
    pub(super) fn hold_besides_pause(&self, range_source: RangeSource) -> Option<MotionHold> {
        let needed = |device: &Device| *device != Device::Laser || range_source == RangeSource::Laser;
        let lost = self.lost.iter().copied().find(needed).map(MotionHold::DeviceLost);
        let battery = |is: fn(&Battery) -> bool| self.battery.as_ref().is_some_and(is);
        let conditions = [
            (self.wheel_drop.any(), MotionHold::WheelDrop),
            (self.over_current.any(), MotionHold::OverCurrent),
            (battery(|b| b.source == PowerSource::Adapter), MotionHold::AdapterConnected),
            (battery(is_empty), MotionHold::BatteryEmpty),
        ];
        lost.or_else(|| conditions.into_iter().find_map(|(holds, hold)| holds.then_some(hold)))
    }

    fn set_link(&mut self, link: Link) {
        self.lost.retain(|device| *device != link.device);
        if !link.is_up {
            self.lost.push(link.device);
        }
        self.lost.sort();
    }
}

fn is_empty(battery: &Battery) -> bool {
    !battery.is_charging && battery.charge.is_some_and(|charge| charge <= EMPTY_CHARGE)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(events: &[BodyEventKind]) -> Option<MotionHold> {
        let mut body = BodyState::default();
        events.iter().for_each(|event| body.update(*event));
        body.hold(RangeSource::DepthCamera)
    }

    fn link(device: Device, is_up: bool) -> BodyEventKind {
        BodyEventKind::Link(Link { device, is_up })
    }

    fn battery(charge: f64, source: PowerSource, is_charging: bool) -> BodyEventKind {
        BodyEventKind::Battery(Battery { voltage_v: 15.0, charge: Some(charge), source, is_charging })
    }

    #[test]
    fn each_condition_holds_until_the_body_reports_its_end() {
        let left = PerWheel { left: true, right: false };
        let pause = BodyEventKind::Button(Button { index: 0, pressed: true });
        let release = BodyEventKind::Button(Button { index: 0, pressed: false });
        for (begin, end, hold) in [
            (
                BodyEventKind::WheelDrop(left),
                BodyEventKind::WheelDrop(PerWheel::default()),
                MotionHold::WheelDrop,
            ),
            (
                BodyEventKind::OverCurrent(left),
                BodyEventKind::OverCurrent(PerWheel::default()),
                MotionHold::OverCurrent,
            ),
            (link(Device::Base, false), link(Device::Base, true), MotionHold::DeviceLost(Device::Base)),
            (
                battery(0.5, PowerSource::Adapter, true),
                battery(0.5, PowerSource::Battery, false),
                MotionHold::AdapterConnected,
            ),
            (
                battery(0.01, PowerSource::Battery, false),
                battery(0.01, PowerSource::ChargingStation, true),
                MotionHold::BatteryEmpty,
            ),
            (pause, pause, MotionHold::Paused),
        ] {
            assert_eq!(after(&[begin]), Some(hold));
            assert_eq!(after(&[begin, release]), Some(hold));
            assert_eq!(after(&[begin, end]), None, "{hold}");
        }
    }

    #[test]
    fn a_laser_holds_only_a_robot_that_drives_by_it() {
        let mut body = BodyState::default();
        body.update(link(Device::Laser, false));
        assert_eq!(body.hold(RangeSource::DepthCamera), None);
        assert_eq!(body.hold(RangeSource::Laser), Some(MotionHold::DeviceLost(Device::Laser)));
    }

    #[test]
    fn other_buttons_and_light_of_a_station_hold_nothing() {
        let other = BodyEventKind::Button(Button { index: 1, pressed: true });
        assert_eq!(
            after(&[other, BodyEventKind::DockInfrared(Default::default()), BodyEventKind::Silence]),
            None
        );
    }
}
