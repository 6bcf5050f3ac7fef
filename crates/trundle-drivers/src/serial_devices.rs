//! The serial devices of this computer.
//!
//! Only the port of a Kobuki is opened: an opened port raises its control lines, which restarts some other devices.

use crate::kobuki::ConnectError;
use crate::kobuki::serial_port::open_unblocked;
use rustix::fs::{Access, access};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Folder of the devices on Linux.
const DEVICE_FOLDER: &str = "/dev";
/// Folder of Linux with serial devices named by manufacturer and serial number.
pub(crate) const BY_ID_FOLDER: &str = "/dev/serial/by-id";
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
    /// The user has the right to open the port, which was not opened: it is not known to be a Kobuki's.
    Permitted,
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
        is_kobuki_id(&self.id)
    }
}

/// Whether a name by manufacturer and serial number is that of a Kobuki's serial chip.
pub(crate) fn is_kobuki_id(id: &str) -> bool {
    id.to_lowercase().contains("kobuki")
}

/// The USB serial devices, sorted by path. Only available on Linux.
#[must_use]
pub fn serial_devices() -> Vec<SerialDevice> {
    list(Path::new(DEVICE_FOLDER), Path::new(BY_ID_FOLDER))
}

fn list(devices: &Path, by_id: &Path) -> Vec<SerialDevice> {
    let ids = device_ids(by_id);
    let is_serial = |name: &str| USB_SERIAL_NAMES.iter().any(|start| name.starts_with(start));
    let entries = fs::read_dir(devices).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries
        .filter(|entry| is_serial(&entry.file_name().to_string_lossy()))
        .map(|entry| entry.path())
        .collect();
    paths.sort();
    let device = |path: PathBuf| {
        let id =
            fs::canonicalize(&path).ok().and_then(|device| ids.get(&device).cloned()).unwrap_or_default();
        let access = if is_kobuki_id(&id) { opened(&path) } else { permitted(&path) };
        SerialDevice { path, id, access }
    };
    paths.into_iter().map(device).collect()
}

/// Names by manufacturer and serial number, by the path of their device.
pub(crate) fn device_ids(by_id: &Path) -> BTreeMap<PathBuf, String> {
    let entries = fs::read_dir(by_id).into_iter().flatten().flatten();
    let named = entries.filter_map(|entry| {
        let target = fs::canonicalize(entry.path()).ok()?;
        Some((target, entry.file_name().to_string_lossy().into_owned()))
    });
    named.collect()
}

/// Whether the port can be opened, by opening it.
fn opened(path: &Path) -> PortAccess {
    match open_unblocked(path) {
        Ok(_) => PortAccess::Free,
        Err(ConnectError::NoRights { .. }) => PortAccess::NoRights,
        Err(ConnectError::Busy { .. }) => PortAccess::Busy,
        Err(_) => PortAccess::Broken,
    }
}

/// Whether the user may open the port, without opening it.
fn permitted(path: &Path) -> PortAccess {
    match access(path, Access::READ_OK | Access::WRITE_OK) {
        Ok(()) => PortAccess::Permitted,
        Err(_) => PortAccess::NoRights,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rustix::fd::OwnedFd;
    use rustix::fs::{OFlags, fcntl_setfl};
    use rustix::io::Errno;
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};

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
        let accesses: Vec<PortAccess> = found.iter().map(|device| device.access).collect();
        assert_eq!(accesses, [PortAccess::Permitted, PortAccess::Permitted, PortAccess::Free]);
        assert!(list(&folder.path().join("none"), &by_id).is_empty());
    }

    /// The device's end of a pseudo terminal whose port no program has opened yet, and the path of the port.
    fn unopened_terminal() -> (OwnedFd, PathBuf) {
        let device = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC).unwrap();
        grantpt(&device).unwrap();
        unlockpt(&device).unwrap();
        fcntl_setfl(&device, OFlags::NONBLOCK).unwrap();
        let port = PathBuf::from(ptsname(&device, Vec::new()).unwrap().into_string().unwrap());
        (device, port)
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn no_port_but_that_of_a_kobuki_is_opened() {
        let folder = tempfile::tempdir().unwrap();
        let (devices, by_id) = (folder.path().join("dev"), folder.path().join("by-id"));
        fs::create_dir_all(&devices).unwrap();
        fs::create_dir_all(&by_id).unwrap();
        let (kobuki, kobuki_port) = unopened_terminal();
        let (other, other_port) = unopened_terminal();
        let link = |target: &Path, name: PathBuf| std::os::unix::fs::symlink(target, name).unwrap();
        link(&kobuki_port, devices.join("ttyUSB0"));
        link(&other_port, devices.join("ttyUSB1"));
        link(&kobuki_port, by_id.join("usb-Yujin_Robot_iClebo_Kobuki_kobuki_AH02B4AF-if00-port0"));
        let accesses: Vec<PortAccess> = list(&devices, &by_id).iter().map(|device| device.access).collect();
        assert_eq!(accesses, [PortAccess::Free, PortAccess::Permitted]);
        // Reading the device's end fails after its port was opened and closed.
        let read = |device: &OwnedFd| rustix::io::read(device, &mut [0; 1]);
        assert_eq!((read(&kobuki), read(&other)), (Err(Errno::IO), Err(Errno::AGAIN)));
    }
}
