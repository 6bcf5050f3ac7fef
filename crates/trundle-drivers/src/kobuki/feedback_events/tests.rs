//! Tests of the events of feedback packets.

use super::*;
use crate::kobuki::protocol::{Inertia, RawGyro};
use trundle_core::PowerSource;

fn at(ms: i64) -> Stamp {
    Stamp::from_nanos(ms * 1_000_000)
}

fn core(stamp_ms: u16) -> CoreSensors {
    CoreSensors { stamp_ms, battery_decivolts: 150, ..CoreSensors::default() }
}

fn packet(core: CoreSensors) -> Feedback {
    Feedback { core: Some(core), ..Feedback::default() }
}

/// A converter that has reported the battery, and its packets at 0 and 20 ms.
fn started() -> FeedbackEvents {
    let mut events = FeedbackEvents::new(GyroSource::Raw, 0.0);
    events.events(&packet(core(100)), at(1000));
    events.events(&packet(core(120)), at(1020));
    events
}

/// The kinds of the events besides wheels and gyro.
fn changes(events: &[SensorEvent]) -> Vec<SensorEvent> {
    let is_periodic = |event: &&SensorEvent| matches!(event, SensorEvent::Wheels(_) | SensorEvent::Gyro(_));
    events.iter().filter(|event| !is_periodic(event)).cloned().collect()
}

#[test]
fn ticks_and_gyro_readings_have_their_stamps_and_signs() {
    let gyro = RawGyro { frame_id: 0, readings: vec![[5, 5, 1000], [5, 5, -1000]] };
    let core = CoreSensors { left_ticks: 7, right_ticks: 65_535, ..core(140) };
    let feedback = Feedback { gyro: Some(gyro), ..packet(core) };
    let events = started().events(&feedback, at(1040));
    let omega = 8.75f64.to_radians();
    let gyro = |ms, omega| SensorEvent::Gyro(GyroRate { stamp: at(ms), omega });
    let wheels = SensorEvent::Wheels(WheelTicks { stamp: at(1040), left: 7, right: 65_535 });
    assert_eq!(events, [gyro(1030, omega), gyro(1040, -omega), wheels]);
}

#[test]
fn after_lost_packets_readings_still_cover_one_period() {
    let gyro = RawGyro { frame_id: 0, readings: vec![[0; 3]; 2] };
    let events = started().events(&Feedback { gyro: Some(gyro), ..packet(core(220)) }, at(1120));
    assert_eq!(events.iter().map(SensorEvent::stamp).collect::<Vec<_>>(), [at(1110), at(1120), at(1120)]);
}

#[test]
fn the_calibrated_rate_is_the_other_source() {
    let mut events = FeedbackEvents::new(GyroSource::Calibrated, 0.0);
    let inertia = Some(Inertia { angle_centideg: 0, rate_centideg_s: -100 });
    let events = events.events(&Feedback { inertia, ..packet(core(0)) }, at(50));
    assert_eq!(events[0], SensorEvent::Gyro(GyroRate { stamp: at(50), omega: -1f64.to_radians() }));
}

#[test]
fn every_change_is_one_event_and_a_lasting_state_none() {
    let mut events = started();
    let both = PerWheel { left: true, right: true };
    let left = PerWheel { left: true, right: false };
    let state = CoreSensors {
        bumper: ThreeSides { left: true, ..ThreeSides::default() },
        cliff: ThreeSides { center: true, ..ThreeSides::default() },
        wheel_drop: both,
        over_current: left,
        buttons: [false, true, false],
        ..core(140)
    };
    let mut dock = DockInfrared::default();
    dock.left.far_center = true;
    let stamp = at(1040);
    let expected = [
        SensorEvent::Touch(Touch { stamp, pressed: true }),
        SensorEvent::Cliff(Cliff { stamp, over_edge: true }),
        body(stamp, BodyEventKind::WheelDrop(both)),
        body(stamp, BodyEventKind::OverCurrent(left)),
        body(stamp, BodyEventKind::DockInfrared(dock)),
        body(stamp, BodyEventKind::Button(Button { index: 1, pressed: true })),
    ];
    let feedback = Feedback { dock: Some(dock), ..packet(state) };
    assert_eq!(changes(&events.events(&feedback, stamp)), expected);
    let same = Feedback { dock: Some(dock), ..packet(CoreSensors { stamp_ms: 160, ..state }) };
    assert_eq!(changes(&events.events(&same, at(1060))), []);
    let bumper = ThreeSides { right: true, ..ThreeSides::default() };
    let other_side = packet(CoreSensors { stamp_ms: 180, bumper, ..state });
    assert_eq!(changes(&events.events(&other_side, at(1080))), []);
    assert_eq!(changes(&events.events(&packet(core(200)), at(1100))).len(), 5, "all but the dock end");
}

#[test]
fn the_battery_is_reported_at_once_by_charger_and_once_a_second_by_voltage() {
    let mut events = FeedbackEvents::new(GyroSource::Raw, 0.0);
    let mut reports = Vec::new();
    for i in 0..150u16 {
        let is_charging = i >= 100;
        let source = if is_charging { PowerSource::ChargingStation } else { PowerSource::Battery };
        let charger = Charger { source, is_charging };
        let state = CoreSensors { charger, battery_decivolts: 140 + (i % 2) as u8, ..core(i * 20) };
        for event in changes(&events.events(&packet(state), at(i64::from(i) * 20))) {
            let SensorEvent::Body(BodyEvent { stamp, kind: BodyEventKind::Battery(battery), .. }) = event
            else {
                panic!("{event:?}");
            };
            reports.push(((stamp - at(0)) * 1000.0, battery.voltage_v, battery.is_charging));
        }
    }
    let times: Vec<_> = reports.iter().map(|report| report.0.round() as i64).collect();
    assert_eq!(times, [0, 1020, 2000], "a change of voltage, then the charger");
    assert_eq!((reports[1].1, reports[2].2), (14.1, true));
}

#[test]
fn the_charge_is_linear_and_bounded() {
    assert!((charge_of(14.95) - 0.5).abs() < 1e-9);
    assert_eq!((charge_of(12.0), charge_of(17.0)), (0.0, 1.0));
}

#[test]
fn stamps_never_run_backwards_whatever_the_base_says() {
    let mut events = FeedbackEvents::new(GyroSource::Raw, 0.007);
    let mut last = at(-20);
    for i in 0..2000i64 {
        let gyro = Some(RawGyro { frame_id: 0, readings: vec![[0; 3]; (i % 4) as usize] });
        let stamp_ms = (i * 7919 % 65_536) as u16;
        let arrival = at(i * 13);
        let mut batch = events.events(&Feedback { gyro, ..packet(core(stamp_ms)) }, arrival);
        if i % 50 == 0 {
            batch.push(events.link_event(i % 100 == 0, arrival));
        }
        for event in batch {
            assert!(event.stamp() >= last && event.stamp() <= arrival, "packet {i}: {event:?}");
            last = event.stamp();
        }
    }
}

#[test]
fn a_repeated_packet_and_one_without_core_sensors_give_nothing() {
    let mut events = started();
    assert_eq!(events.events(&packet(core(120)), at(1041)), []);
    assert_eq!(events.events(&Feedback::default(), at(1042)), []);
}

#[test]
fn the_link_comes_before_the_first_packet() {
    let mut events = started();
    let down = events.link_event(false, at(1200));
    let up = events.events_after_link_up(&packet(core(320)), at(1220));
    let link = |stamp, is_up| body(stamp, BodyEventKind::Link(Link { device: Device::Base, is_up }));
    assert_eq!((down, &up[0]), (link(at(1200), false), &link(at(1220), true)));
    assert!(matches!(up[1], SensorEvent::Wheels(_)));
}

#[test]
fn a_base_that_was_switched_off_has_a_new_clock() {
    let mut events = started();
    events.link_event(false, at(1200));
    let up = events.events_after_link_up(&packet(core(19_820)), at(21_000));
    assert!(up.iter().all(|event| event.stamp() == at(21_000)), "280 ms late by the old clock: {up:?}");
}
