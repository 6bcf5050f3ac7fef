//! The errors of a failed start.

use crate::device::{Device, Sends};
use crate::rig::{Rig, clock, patient, start_error, wait_for};
use trundle_core::Twist2;
use trundle_drivers::kobuki::protocol::Version;
use trundle_drivers::kobuki::stream_check::StreamFault;
use trundle_drivers::kobuki::{ConnectError, KobukiBase, SerialConnector, StartError};

const FIRMWARE: Version = Version::new(1, 2, 0);

#[test]
fn a_missing_port_is_named() {
    let connector = Box::new(SerialConnector::new("/dev/trundle-no-such-port"));
    let error = KobukiBase::start(connector, patient(), clock(), Box::new(drop)).unwrap_err();
    assert!(matches!(error, StartError::Connect(ConnectError::Missing { .. })), "{error}");
    assert!(error.to_string().starts_with("port /dev/trundle-no-such-port does not exist: "));
}

#[test]
fn a_busy_port_is_named_and_free_after_the_stop() {
    let rig = Rig::start("busy", Sends::Packets);
    let error = start_error(&rig.device, 30.0);
    assert!(matches!(error, StartError::Connect(ConnectError::Busy { .. })), "{error}");
    let Rig { base, device, .. } = rig;
    base.stop();
    let connector = Box::new(SerialConnector::new(device.port()));
    let again = KobukiBase::start(connector, patient(), clock(), Box::new(drop)).unwrap();
    wait_for("the link", || again.is_up());
}

#[test]
fn a_port_without_rights_names_the_group() {
    use std::os::unix::fs::{MetadataExt, PermissionsExt};
    let device = Device::plugged("rights", Sends::Packets, FIRMWARE);
    std::fs::set_permissions(device.port(), std::fs::Permissions::from_mode(0o0)).unwrap();
    if std::fs::metadata("/proc/self").is_ok_and(|own| own.uid() == 0) {
        return eprintln!("skipped: root may open every port");
    }
    let error = start_error(&device, 30.0);
    assert!(error.to_string().contains("usermod -aG dialout"), "{error}");
}

#[test]
fn another_device_is_shown_by_its_bytes() {
    let device = Device::plugged("other", Sends::OtherDevice, FIRMWARE);
    let error = start_error(&device, 1.0);
    assert!(matches!(error, StartError::NotAKobuki { bytes: 16.., refused: 1.., .. }), "{error}");
    assert!(error.to_string().contains("the first bytes are 24 47 50 47 47 41 2C"), "{error}");
}

#[test]
fn a_device_that_is_switched_off_is_named() {
    let device = Device::plugged("off", Sends::Nothing, FIRMWARE);
    let error = start_error(&device, 0.3);
    assert!(matches!(error, StartError::NoBytes { .. }), "{error}");
    assert!(error.to_string().contains("switch the base on"), "{error}");
}

#[test]
fn two_bases_on_a_port_are_noticed() {
    let device = Device::plugged("two", Sends::TwoBases, FIRMWARE);
    let error = start_error(&device, 30.0);
    assert!(matches!(error, StartError::Stream { fault: StreamFault::TwoSources { .. }, .. }), "{error}");
}

#[test]
fn a_firmware_of_another_protocol_is_refused_and_an_old_one_is_not() {
    let device = Device::plugged("new", Sends::Packets, Version::new(2, 0, 0));
    let error = start_error(&device, 30.0);
    assert!(matches!(error, StartError::Firmware { .. }), "{error}");
    assert!(error.to_string().contains("firmware is 2.0.0, expected 1.x"), "{error}");
    wait_for("zero speed all the same", || device.state().twists.contains(&Twist2::ZERO));
    let device = Device::plugged("old", Sends::Packets, Version::new(1, 0, 0));
    let connector = Box::new(SerialConnector::new(device.port()));
    let base = KobukiBase::start(connector, patient(), clock(), Box::new(drop)).unwrap();
    let fault = base.versions().firmware_fault().unwrap();
    assert!(fault.starts_with("the base's firmware is 1.0.0, expected 1.1.4 or later: it drives"), "{fault}");
}

#[test]
fn a_wrong_setting_is_refused_before_the_port_is_opened() {
    let mut config = patient();
    config.command_timeout_s = f64::NAN;
    let connector = Box::new(SerialConnector::new("/dev/trundle-no-such-port"));
    let error = KobukiBase::start(connector, config, clock(), Box::new(drop)).unwrap_err();
    assert_eq!(error.to_string(), "command_timeout_s is NaN s, expected 0.05 to 10");
}
