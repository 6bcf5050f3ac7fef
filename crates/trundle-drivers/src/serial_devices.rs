//! The serial devices of this computer.

use std::collections::BTreeMap;
use std::fs::{self, OpenOptions};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Folder of the devices on Linux.
const DEVICE_FOLDER: &str = "/dev";
/// Folder of Linux with serial devices named by manufacturer and serial number.
const BY_ID_FOLDER: &str = "/dev/serial/by-id";
/// Prefixes of the names of USB serial devices. Source: Linux's drivers usb-serial and cdc-acm.
const USB_SERIAL_NAMES: [&str; 2] = ["ttyUSB", "ttyACM"];

/// A serial device at USB.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SerialDevice {
    /// Path of the device.
    pub path: PathBuf,
    /// Maker, model and number; empty if the system does not list them.
    pub id: String,
    /// Access of this user to the port.
    pub access: PortAccess,
}

/// Whether a port can be opened by this user.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PortAccess {
    /// The port can be opened.
    Free,
    /// Another program uses the port.
    Busy,
    /// The user lacks the right.
    NoRights,
    /// The device does not answer.
    Broken,
}

impl SerialDevice {
    /// Whether the device's name is that of a Kobuki's serial chip.
    #[must_use]
    pub fn is_kobuki(&self) -> bool {
        self.id.to_lowercase().contains("kobuki")
    }
}

/// The USB serial devices, sorted by path. Only available on Linux.
#[must_use]
pub fn serial_devices() -> Vec<SerialDevice> {
    list(Path::new(DEVICE_FOLDER), Path::new(BY_ID_FOLDER))
}

fn list(devices: &Path, by_id: &Path) -> Vec<SerialDevice> {
    let ids = ids(by_id);
    let is_serial = |name: &str| USB_SERIAL_NAMES.iter().any(|start| name.starts_with(start));
    let entries = fs::read_dir(devices).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries
        .filter(|entry| is_serial(&entry.file_name().to_string_lossy()))
        .map(|entry| entry.path())
        .collect();
    paths.sort();
    let device = |path: PathBuf| {
        let id = ids.get(&path).cloned().unwrap_or_default();
        SerialDevice { access: access(&path), path, id }
    };
    paths.into_iter().map(device).collect()
}

/// Names by manufacturer and serial number, by the path of their device.
fn ids(by_id: &Path) -> BTreeMap<PathBuf, String> {
    let entries = fs::read_dir(by_id).into_iter().flatten().flatten();
    let named = entries.filter_map(|entry| {
        let target = fs::canonicalize(entry.path()).ok()?;
        Some((target, entry.file_name().to_string_lossy().into_owned()))
    });
    named.collect()
}

fn access(path: &Path) -> PortAccess {
    match OpenOptions::new().read(true).write(true).open(path) {
        Ok(_) => PortAccess::Free,
        Err(error) if error.kind() == ErrorKind::PermissionDenied => PortAccess::NoRights,
        Err(error) if error.kind() == ErrorKind::ResourceBusy => PortAccess::Busy,
        Err(_) => PortAccess::Broken,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn devices_are_listed_with_their_names_in_order() {
        let folder = tempfile::tempdir().unwrap();
        let (devices, by_id) = (folder.path().join("dev"), folder.path().join("by-id"));
        fs::create_dir_all(&devices).unwrap();
        fs::create_dir_all(&by_id).unwrap();
        for name in ["ttyUSB1", "ttyUSB0", "ttyACM0", "tty0", "null"] {
            fs::write(devices.join(name), "").unwrap();
        }
        let id = "usb-Yujin_Robot_iClebo_Kobuki_kobuki_AH02B4AF-if00-port0";
        std::os::unix::fs::symlink(devices.join("ttyUSB1"), by_id.join(id)).unwrap();
        let found = list(&fs::canonicalize(&devices).unwrap(), &by_id);
        let names: Vec<_> = found.iter().map(|d| d.path.file_name().unwrap().to_str().unwrap()).collect();
        assert_eq!(names, ["ttyACM0", "ttyUSB0", "ttyUSB1"]);
        assert!(found[2].is_kobuki() && !found[0].is_kobuki() && found[2].id == id);
        assert_eq!(found[0].access, PortAccess::Free);
        assert!(list(&folder.path().join("none"), &by_id).is_empty());
    }
}
