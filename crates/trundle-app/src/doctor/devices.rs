//! Base and cameras: ports, libraries and connected devices.

use super::check::Check;
use trundle_drivers::camera::native::{LibraryReport, LibraryState, NativeKind, list_devices, reports};
use trundle_drivers::{PortAccess, SerialDevice, serial_devices};

/// Checks of the serial ports and of the cameras' libraries.
pub fn check() -> Vec<Check> {
    let (ports, cameras) = (serial_devices(), reports());
    let mut checks = bases(&ports);
    checks.extend(libraries(&cameras));
    checks
        .extend(NativeKind::ALL.iter().zip(&cameras).filter_map(|(kind, report)| plugged_in(*kind, report)));
    checks
}

/// A check of each port, and of the Kobuki.
fn bases(ports: &[SerialDevice]) -> Vec<Check> {
    let mut checks: Vec<Check> = ports.iter().map(port).collect();
    if !ports.iter().any(SerialDevice::is_kobuki) {
        let remedy = "connect its USB cable and switch it on; other serial devices may still be one";
        checks.push(Check::warning("base", "no Kobuki is found", remedy));
    }
    checks
}

fn port(device: &SerialDevice) -> Check {
    let (topic, name) = ("base", device.path.display());
    match device.access {
        PortAccess::Free => Check::ok(topic, format!("{name} {} can be opened", device.id)),
        PortAccess::Permitted => Check::ok(topic, format!("{name} {} may be opened", device.id)),
        PortAccess::Busy => Check::warning(
            topic,
            format!("{name} is in use by another program"),
            format!("fuser {name} names it"),
        ),
        PortAccess::NoRights => Check::problem(
            topic,
            format!("no right to open {name}"),
            "sudo usermod -aG dialout $USER, then log in again",
        ),
        PortAccess::Broken => Check::warning(topic, format!("{name} does not answer"), "plug it in again"),
    }
}

/// Whether the library of any camera can be loaded.
fn libraries(reports: &[LibraryReport]) -> Vec<Check> {
    let is_usable = |report: &&LibraryReport| matches!(report.state, LibraryState::Usable { .. });
    if reports.iter().any(|report| is_usable(&report)) {
        return Vec::new();
    }
    let remedy = "trundle devices lists them with their packages; --camera stream:PATH needs none";
    vec![Check::warning("camera", "no library of a camera's maker can be loaded", remedy)]
}

/// The cameras of a library that can be loaded.
fn plugged_in(kind: NativeKind, report: &LibraryReport) -> Option<Check> {
    let LibraryState::Usable { file, .. } = &report.state else { return None };
    let library = format!("library {}", file.display());
    Some(match list_devices(kind) {
        Ok(devices) if devices.is_empty() => {
            let finding = format!("{library}: no {} is plugged in", kind.cameras());
            Check::warning("camera", finding, "connect it to a USB 3 port; check the udev rules")
        }
        Ok(devices) => Check::ok("camera", format!("{library}: {} {}", devices.len(), kind.cameras())),
        Err(error) => {
            Check::warning("camera", format!("{library}: {error}"), "plug it in again; check the udev rules")
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::doctor::check::CheckLevel;
    use std::path::PathBuf;

    #[test]
    fn ports_without_rights_are_problems() {
        let device = |access| SerialDevice {
            path: PathBuf::from("/dev/ttyUSB0"),
            id: "usb-kobuki".to_owned(),
            access,
        };
        let level = |access| bases(&[device(access)])[0].level;
        assert_eq!(level(PortAccess::NoRights), CheckLevel::Problem);
        assert_eq!(level(PortAccess::Free), CheckLevel::Ok);
        assert_eq!(bases(&[device(PortAccess::Free)]).len(), 1, "a Kobuki is there");
        assert_eq!(bases(&[]).len(), 1, "none is");
    }
}
