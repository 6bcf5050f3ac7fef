//! The search of a Kobuki's serial port by the names that the system gives to ports, without opening any of them.

use crate::kobuki::{ByteLink, ConnectError, Connector, SerialConnector};
use crate::serial_devices::{BY_ID_FOLDER, device_ids, is_kobuki_id};
use std::path::{Path, PathBuf};

/// Port of a Kobuki on a system with the udev rule [`KOBUKI_UDEV_RULE`](crate::KOBUKI_UDEV_RULE).
pub const KOBUKI_UDEV_PORT: &str = "/dev/kobuki";

/// Opens the port at which a Kobuki is found at the time of the attempt: a Kobuki that is plugged in again may get another port.
#[derive(Debug)]
pub(crate) struct KobukiFinder {
    udev_port: PathBuf,
    by_id: PathBuf,
    guard_program: PathBuf,
    /// Port of the latest attempt.
    port: PathBuf,
    attempts: usize,
}

impl KobukiFinder {
    /// A search on this computer. `program` has the command [`crate::kobuki::base_guard::GUARD_COMMAND`].
    pub(crate) fn new(program: &Path) -> Self {
        Self::in_places(Path::new(KOBUKI_UDEV_PORT), Path::new(BY_ID_FOLDER), program)
    }

    fn in_places(udev_port: &Path, by_id: &Path, program: &Path) -> Self {
        Self {
            udev_port: udev_port.to_owned(),
            by_id: by_id.to_owned(),
            guard_program: program.to_owned(),
            port: udev_port.to_owned(),
            attempts: 0,
        }
    }

    /// The ports of all Kobukis, that of the udev rule first; without any, the name that the rule would give.
    fn ports(&self) -> Vec<PathBuf> {
        let named = self.udev_port.canonicalize().ok();
        let listed = device_ids(&self.by_id).into_iter().filter(|(_, id)| is_kobuki_id(id));
        let others = listed.map(|(path, _)| path).filter(|path| Some(path) != named.as_ref());
        let mut ports: Vec<PathBuf> = named.iter().map(|_| self.udev_port.clone()).chain(others).collect();
        if ports.is_empty() {
            ports.push(self.udev_port.clone());
        }
        ports
    }
}

impl Connector for KobukiFinder {
    /// Several Kobukis are tried in turn, one an attempt: the driver refuses a base other than that of the run.
    fn connect(&mut self) -> Result<Box<dyn ByteLink>, ConnectError> {
        let ports = self.ports();
        self.port.clone_from(&ports[self.attempts % ports.len()]);
        self.attempts += 1;
        SerialConnector::new(&self.port).guarded_by(&self.guard_program).connect()
    }

    fn port(&self) -> String {
        self.port.display().to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kobuki::PseudoTerminal;
    use std::fs;
    use std::time::Duration;

    /// Names by manufacturer and serial number of two Kobukis. Source: Linux's names for the FTDI chip of a Kobuki.
    const IDS: [&str; 2] = [
        "usb-Yujin_Robot_iClebo_Kobuki_kobuki_AH02B4AF-if00-port0",
        "usb-Yujin_Robot_iClebo_Kobuki_kobuki_BH02B4AF-if00-port0",
    ];

    /// A folder of names, and a finder that searches there.
    fn finder() -> (tempfile::TempDir, KobukiFinder) {
        let folder = tempfile::tempdir().unwrap();
        let finder =
            KobukiFinder::in_places(&folder.path().join("kobuki"), folder.path(), Path::new("/no-guard"));
        (folder, finder)
    }

    fn name(folder: &tempfile::TempDir, id: &str, terminal: &PseudoTerminal) {
        let link = folder.path().join(id);
        if link.is_symlink() {
            fs::remove_file(&link).unwrap();
        }
        std::os::unix::fs::symlink(terminal.port(), link).unwrap();
    }

    /// Whether the next connection leads to this device.
    fn leads_to(finder: &mut KobukiFinder, device: &mut PseudoTerminal) -> bool {
        let mut link = finder.connect().unwrap();
        link.write(b"hello").unwrap();
        let mut buffer = [0; 16];
        device.read(&mut buffer, Duration::from_millis(500)).unwrap() > 0 && buffer.starts_with(b"hello")
    }

    #[test]
    fn a_kobuki_that_returns_at_another_port_is_found() {
        let (folder, mut finder) = finder();
        let (mut first, mut second) = (PseudoTerminal::open().unwrap(), PseudoTerminal::open().unwrap());
        let other = PseudoTerminal::open().unwrap();
        name(&folder, "usb-FTDI_FT232R_USB_UART_A1-if00-port0", &other);
        name(&folder, IDS[0], &first);
        assert!(leads_to(&mut finder, &mut first));
        assert_eq!(finder.port(), first.port().display().to_string());
        name(&folder, IDS[0], &second);
        assert!(leads_to(&mut finder, &mut second));
        assert_eq!(finder.port(), second.port().display().to_string());
    }

    #[test]
    fn two_kobukis_are_tried_in_turn() {
        let (folder, mut finder) = finder();
        let (mut first, mut second) = (PseudoTerminal::open().unwrap(), PseudoTerminal::open().unwrap());
        name(&folder, IDS[0], &first);
        name(&folder, IDS[1], &second);
        let found: Vec<bool> = (0..3).map(|_| leads_to(&mut finder, &mut first)).collect();
        assert!(found == [true, false, true] || found == [false, true, false], "{found:?}");
        finder.attempts = usize::from(found[0]);
        assert!(leads_to(&mut finder, &mut second));
    }

    #[test]
    fn the_port_of_the_rule_is_the_first_and_is_not_tried_twice() {
        let (folder, finder) = finder();
        let (terminal, other) = (PseudoTerminal::open().unwrap(), PseudoTerminal::open().unwrap());
        name(&folder, IDS[0], &terminal);
        name(&folder, IDS[1], &other);
        name(&folder, "kobuki", &terminal);
        assert_eq!(finder.ports(), [folder.path().join("kobuki"), other.port().to_owned()]);
    }

    #[test]
    fn without_a_kobuki_the_port_of_the_rule_is_missing() {
        let (folder, mut finder) = finder();
        let error = finder.connect().err().unwrap();
        assert!(
            matches!(&error, ConnectError::Missing { port } if *port == folder.path().join("kobuki")),
            "{error}"
        );
    }
}
