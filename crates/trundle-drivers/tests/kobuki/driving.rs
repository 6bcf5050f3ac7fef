//! Speeds reach the base, readings return, accessories work.

use crate::device::Sends;
use crate::rig::{Rig, wait_for};
use trundle_core::{BodyEventKind, SensorEvent, Twist2};
use trundle_drivers::kobuki::protocol::{Gains, KobukiCommand, Led, Outputs, SoundSequence, Version};

#[test]
fn speeds_arrive_and_end_with_zero() {
    let rig = Rig::start("speeds", Sends::Packets);
    assert!(rig.device.state().twists.iter().all(|twist| *twist == Twist2::ZERO), "zero before any command");
    rig.drive(Twist2::new(0.3, 0.0));
    rig.drive(Twist2::new(0.2, -0.8));
    rig.drive(Twist2::new(0.0, 1.0));
    wait_for("zero after the commands ceased", || rig.device.state().twists.last() == Some(&Twist2::ZERO));
    assert!(rig.base.counters().speeds_sent > 3);
    let commands = rig.device.state().base.command_counters();
    assert_eq!((commands.skipped_bytes, commands.refused()), (0, 0), "a damaged command");
}

#[test]
fn a_command_that_is_not_a_number_stops_the_base() {
    let rig = Rig::start("nan", Sends::Packets);
    rig.drive(Twist2::new(0.3, 0.0));
    rig.drive(Twist2::new(0.3, 0.1));
    let (commands, before) = (rig.base.commands(), rig.device.state().twists.len());
    wait_for("zero speed", || {
        commands.send(Twist2::new(f64::NAN, 0.0)).unwrap();
        rig.device.state().twists[before..].contains(&Twist2::ZERO)
    });
}

#[test]
fn stopping_sends_zero_last() {
    let rig = Rig::start("stop", Sends::Packets);
    rig.drive(Twist2::new(0.3, 0.0));
    let Rig { base, device, .. } = rig;
    base.commands().send(Twist2::new(0.3, 0.0)).unwrap();
    base.stop();
    wait_for("zero at the end", || device.state().twists.last() == Some(&Twist2::ZERO));
}

#[test]
fn readings_come_back_in_order() {
    let rig = Rig::start("readings", Sends::Packets);
    wait_for("the link", || rig.base.is_up());
    {
        let mut state = rig.device.state();
        state.sensors.gyro_rate = 0.5;
        state.sensors.bumper.left = true;
        state.sensors.wheel_drop.right = true;
        state.sensors.cliff.center = true;
        state.sensors.buttons[1] = true;
        state.sensors.dock.center.near_left = true;
    }
    wait_for("touch", || rig.has_event(|e| matches!(e, SensorEvent::Touch(touch) if touch.pressed)));
    wait_for("cliff", || rig.has_event(|e| matches!(e, SensorEvent::Cliff(cliff) if cliff.over_edge)));
    let is_gyro = |e: &SensorEvent| matches!(e, SensorEvent::Gyro(gyro) if (gyro.omega - 0.5).abs() < 1e-3);
    wait_for("gyro", || rig.has_event(is_gyro));
    let has_body = |is_it: fn(&BodyEventKind) -> bool| {
        rig.has_event(|event| matches!(event, SensorEvent::Body(body) if is_it(&body.kind)))
    };
    assert!(has_body(|kind| matches!(kind, BodyEventKind::WheelDrop(drop) if drop.right && !drop.left)));
    assert!(has_body(
        |kind| matches!(kind, BodyEventKind::Button(button) if button.index == 1 && button.pressed)
    ));
    assert!(has_body(|kind| matches!(kind, BodyEventKind::DockInfrared(dock) if dock.center.near_left)));
    assert!(has_body(|kind| matches!(kind, BodyEventKind::Battery(battery) if battery.voltage_v == 16.5)));
    let events = rig.events();
    assert!(events.is_sorted_by_key(SensorEvent::stamp), "stamps run backwards");
    assert_eq!(rig.links(), [true]);
    assert!(matches!(events[0], SensorEvent::Body(_)), "the link's event is the first");
}

#[test]
fn ticks_are_those_of_the_device() {
    let rig = Rig::start("ticks", Sends::Packets);
    let ticks = || -> Vec<(u16, u16)> {
        let events = rig.events();
        let wheels = |event: &SensorEvent| match event {
            SensorEvent::Wheels(wheels) => Some((wheels.left, wheels.right)),
            _ => None,
        };
        events.iter().filter_map(wheels).collect()
    };
    wait_for("ten packets", || ticks().len() >= 10);
    let ticks = ticks();
    assert!(ticks.iter().all(|(left, right)| left.wrapping_add(*right) == 0), "{ticks:?}");
    assert!(ticks.is_sorted_by(|a, b| a.0 < b.0), "{ticks:?}");
}

#[test]
fn versions_accessories_and_gains_work() {
    let rig = Rig::start("accessories", Sends::Packets);
    wait_for("the link", || rig.base.is_up());
    let versions = rig.base.versions();
    assert_eq!(
        (versions.hardware, versions.firmware),
        (Some(Version::new(1, 0, 4)), Some(Version::new(1, 2, 0)))
    );
    assert_eq!(versions.unique_id.unwrap().to_string(), "736034612-892621875-1125147971");
    let outputs = Outputs { led1: Led { red: true, green: true }, power_5v: false, ..Outputs::default() };
    let gains = Gains { is_user: true, p: 90.0, i: 0.2, d: 1.5 };
    rig.base.set_outputs(outputs);
    rig.base.play(SoundSequence::CleaningEnd);
    rig.base.play_note(440.0, 100);
    rig.base.set_gains(gains).unwrap();
    rig.base.request_gains();
    wait_for("the gains", || rig.base.gains() == Some(gains));
    assert_eq!(rig.device.state().base.outputs(), outputs);
    let sounds = rig.device.state().base.take_sounds();
    assert_eq!(
        sounds,
        [KobukiCommand::SoundSequence(SoundSequence::CleaningEnd), KobukiCommand::note(440.0, 100)]
    );
    assert!(rig.base.set_gains(Gains { p: -1.0, ..gains }).is_err());
    assert!(rig.base.latest().unwrap().cliff.is_some());
}
