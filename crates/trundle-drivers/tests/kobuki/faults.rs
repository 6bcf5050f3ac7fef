//! Lost links, damaged streams, slow receivers.

use crate::device::{Device, Sends};
use crate::rig::{Rig, clock, is_near, patient, wait_for};
use std::sync::mpsc;
use trundle_core::{SensorEvent, Twist2};
use trundle_drivers::kobuki::protocol::{
    Gains, KobukiCommand, Led, Outputs, SoundSequence, UniqueId, Version,
};
use trundle_drivers::kobuki::{EmulatedKobuki, KobukiBase, SerialConnector};

#[test]
fn after_an_unplugged_cable_the_first_speed_is_zero() {
    // Commands with a long timeout: a stored one would be sent after the loss.
    let mut config = patient();
    config.command_timeout_s = 10.0;
    let rig = Rig::with("unplug", Sends::Packets, config);
    let fast = Twist2::new(0.3, 0.0);
    let outputs = Outputs { led2: Led { red: true, green: false }, ..Outputs::default() };
    let gains = Gains { is_user: true, p: 90.0, i: 0.2, d: 1.5 };
    rig.base.set_outputs(outputs);
    rig.base.set_gains(gains).unwrap();
    rig.drive(fast);
    rig.base.commands().send(fast).unwrap();
    rig.device.state().is_plugged = false;
    wait_for("the loss", || rig.links() == [true, false]);
    (0..10).for_each(|_| rig.base.commands().send(fast).unwrap());
    rig.base.play(SoundSequence::Error);
    rig.base.play(SoundSequence::CleaningEnd);
    rig.base.request_gains();
    wait_for("an attempt to open the port", || rig.base.counters().reconnects > 0);
    {
        let mut state = rig.device.state();
        state.twists.clear();
        state.base = Default::default();
        state.is_plugged = true;
    }
    wait_for("the link", || rig.links() == [true, false, true]);
    wait_for("the outputs", || rig.device.state().base.outputs() == outputs);
    wait_for("the gains", || rig.base.gains() == Some(gains));
    let melody = KobukiCommand::SoundSequence(SoundSequence::CleaningEnd);
    let mut sounds = Vec::new();
    wait_for("the last melody of the absence", || {
        sounds.extend(rig.device.state().base.take_sounds());
        sounds == [melody]
    });
    wait_for("speeds", || rig.device.state().twists.len() > 5);
    let twists = rig.device.state().twists.clone();
    assert!(twists.iter().all(|twist| *twist == Twist2::ZERO), "{twists:?}");
    rig.drive(Twist2::new(0.1, 0.0));
    assert!(!rig.device.state().twists.iter().any(|twist| is_near(*twist, fast)), "an old command was sent");
    let counters = rig.base.counters();
    assert!(counters.link_losses == 1 && counters.commands_dropped >= 11, "{counters:?}");
    assert!(rig.events().is_sorted_by_key(SensorEvent::stamp), "stamps run backwards");
}

#[test]
fn a_silent_base_is_a_lost_link_and_comes_back() {
    let mut config = patient();
    config.silence_limit_s = 0.1;
    let rig = Rig::with("silent", Sends::Packets, config);
    wait_for("the link", || rig.base.is_up());
    rig.device.state().sends = Sends::Nothing;
    wait_for("the loss", || rig.links().last() == Some(&false));
    wait_for("zero in the silence", || rig.device.state().twists.last() == Some(&Twist2::ZERO));
    rig.device.state().sends = Sends::Packets;
    wait_for("the link", || rig.links().last() == Some(&true));
    let links = rig.links();
    assert!(
        links.iter().zip([true, false].iter().cycle()).all(|(is_up, expected)| is_up == expected),
        "{links:?}"
    );
    assert!(rig.events().is_sorted_by_key(SensorEvent::stamp), "stamps run backwards");
}

#[test]
fn a_running_base_stays_up() {
    let mut config = patient();
    config.silence_limit_s = 1.5;
    let rig = Rig::with("running", Sends::Packets, config);
    wait_for("two seconds of packets", || rig.base.counters().decoder.packets > 120);
    assert_eq!(rig.links(), [true]);
}

#[test]
fn pieces_and_garbage_cost_nothing() {
    let rig = Rig::start("garbage", Sends::PiecesAndGarbage);
    let ticks = || -> Vec<u16> {
        let left = |event: &SensorEvent| match event {
            SensorEvent::Wheels(wheels) => Some(wheels.left),
            _ => None,
        };
        rig.events().iter().filter_map(left).collect()
    };
    wait_for("forty packets", || ticks().len() >= 40);
    let ticks = ticks();
    assert!(ticks.windows(2).all(|pair| pair[1] == pair[0] + 1), "a packet is missing: {ticks:?}");
    let counters = rig.base.counters();
    assert!(counters.decoder.skipped_bytes > 40 && counters.decoder.packets >= 40, "{counters:?}");
    assert_eq!(rig.links(), [true]);
    rig.drive(Twist2::new(0.2, 0.0));
}

#[test]
fn a_second_base_on_the_port_is_a_lost_link_until_it_is_gone() {
    let rig = Rig::start("second", Sends::Packets);
    let fast = Twist2::new(0.3, 0.0);
    rig.drive(fast);
    assert_eq!(rig.base.counters().stream_faults, 0);
    rig.device.state().sends = Sends::TwoBases;
    wait_for("the loss", || rig.links() == [true, false]);
    assert!(rig.base.counters().stream_faults > 0);
    wait_for("zero speed", || rig.device.state().twists.last() == Some(&Twist2::ZERO));
    let before = rig.device.state().twists.len();
    let packets = rig.base.counters().decoder.packets;
    wait_for("three seconds of packets of both", || {
        rig.base.commands().send(fast).unwrap();
        rig.base.counters().decoder.packets > packets + 300
    });
    assert!(rig.device.state().twists[before..].iter().all(|twist| *twist == Twist2::ZERO), "it drove");
    assert_eq!(rig.links(), [true, false]);
    rig.device.state().sends = Sends::Packets;
    let packets = rig.base.counters().decoder.packets;
    wait_for("the link", || rig.links() == [true, false, true]);
    assert!(rig.base.counters().decoder.packets >= packets + 50, "a clean window comes first");
    rig.drive(Twist2::new(0.2, 0.0));
    assert!(rig.events().is_sorted_by_key(SensorEvent::stamp), "stamps run backwards");
}

#[test]
fn another_base_on_the_port_is_not_driven() {
    let rig = Rig::start("other-base", Sends::Packets);
    let fast = Twist2::new(0.3, 0.0);
    rig.drive(fast);
    let plug = |base: EmulatedKobuki| {
        rig.device.state().is_plugged = false;
        wait_for("the loss", || !rig.base.is_up());
        let mut state = rig.device.state();
        state.twists.clear();
        state.base = base;
        state.is_plugged = true;
    };
    plug(EmulatedKobuki::default().with_unique_id(UniqueId([7, 7, 7])));
    let attempts = rig.base.counters().reconnects;
    wait_for("some attempts", || {
        rig.base.commands().send(fast).unwrap();
        rig.base.counters().reconnects > attempts + 3
    });
    assert_eq!(rig.links(), [true, false], "the other base brings no link");
    assert!(rig.device.state().twists.iter().all(|twist| *twist == Twist2::ZERO), "it drove another base");
    plug(EmulatedKobuki::default());
    wait_for("the link", || rig.links() == [true, false, true]);
    rig.drive(Twist2::new(0.2, 0.0));
}

#[test]
fn bytes_that_another_program_reads_are_noticed() {
    let rig = Rig::start("lost", Sends::Packets);
    wait_for("the link", || rig.base.is_up());
    rig.device.state().sends = Sends::LostBytes;
    wait_for("the fault", || rig.base.counters().stream_faults > 0);
    assert_eq!(rig.links(), [true], "every second packet is sound");
    let decoder = rig.base.counters().decoder;
    assert!(decoder.refused() >= 10 && decoder.skipped_bytes >= 800, "{decoder:?}");
}

#[test]
fn a_stuck_receiver_keeps_no_command_waiting() {
    let device = Device::plugged("stuck", Sends::Bursts, Version::new(1, 2, 0));
    let (release, released) = mpsc::channel::<()>();
    let sink = Box::new(move |_| assert!(released.recv().is_err()));
    let connector = Box::new(SerialConnector::new(device.port()));
    let base = KobukiBase::start(connector, patient(), clock(), sink).unwrap();
    wait_for("dropped events", || base.counters().events_dropped > 0);
    let (commands, twist) = (base.commands(), Twist2::new(0.25, 0.0));
    wait_for("the speed", || {
        commands.send(twist).unwrap();
        device.state().twists.last().is_some_and(|last| is_near(*last, twist))
    });
    wait_for("zero after it", || device.state().twists.last() == Some(&Twist2::ZERO));
    drop(release);
    base.stop();
}
