//! A pseudo terminal: a serial port without hardware, that any program can open.
//!
//! As with a real port, bytes sent while no program has the port open are lost.

use super::link::ByteLink;
use super::serial_port::{or_none, wait_readable};
use rustix::event::PollFlags;
use rustix::fd::OwnedFd;
use rustix::fs::{Mode, OFlags, fcntl_setfl, open};
use rustix::io::Errno;
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};
use std::ffi::OsString;
use std::io;
use std::os::unix::ffi::OsStringExt;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The device's end of a pseudo terminal. A drop is like unplugging the cable.
#[derive(Debug)]
pub struct PseudoTerminal {
    device: OwnedFd,
    path: PathBuf,
    link: Option<PathBuf>,
}

impl PseudoTerminal {
    /// A new pair of terminals, raw.
    ///
    /// # Errors
    /// When the system has no pseudo-terminal left.
    pub fn open() -> io::Result<Self> {
        let device = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
        grantpt(&device)?;
        unlockpt(&device)?;
        fcntl_setfl(&device, OFlags::NONBLOCK)?;
        let path = PathBuf::from(OsString::from_vec(ptsname(&device, Vec::new())?.into_bytes()));
        let port = open(&path, OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC, Mode::empty())?;
        let mut termios = tcgetattr(&port)?;
        termios.make_raw();
        tcsetattr(&port, OptionalActions::Now, &termios)?;
        Ok(Self { device, path, link: None })
    }

    /// A new pseudo terminal with a symbolic link to its port at `link`. A link to a missing port is replaced; the link is removed at the
    /// end.
    ///
    /// # Errors
    /// When the system has no free terminal, or the link cannot be created: its folder is missing, or the path is a file or a link to an
    /// existing port.
    pub fn open_at(link: &Path) -> io::Result<Self> {
        let mut terminal = Self::open()?;
        if link.exists() {
            let what = if link.is_symlink() {
                "a link to a port that exists: another simulator may use it"
            } else {
                "a file"
            };
            let problem = format!("{} is {what}; remove it, or choose another name", link.display());
            return Err(io::Error::new(io::ErrorKind::AlreadyExists, problem));
        }
        if link.is_symlink() {
            std::fs::remove_file(link)?;
        }
        std::os::unix::fs::symlink(&terminal.path, link)?;
        terminal.link = Some(link.to_owned());
        Ok(terminal)
    }

    /// The port for programs: the link if given.
    pub fn port(&self) -> &Path {
        self.link.as_deref().unwrap_or(&self.path)
    }

    /// Whether a program has the port open.
    ///
    /// # Errors
    /// When the terminal is broken.
    pub fn is_connected(&self) -> io::Result<bool> {
        Ok(!wait_readable(&self.device, Duration::ZERO)?.contains(PollFlags::HUP))
    }
}

impl Drop for PseudoTerminal {
    fn drop(&mut self) {
        let is_ours = |link: &PathBuf| std::fs::read_link(link).is_ok_and(|target| target == self.path);
        if let Some(link) = self.link.as_ref().filter(|link| is_ours(link))
            && let Err(error) = std::fs::remove_file(link)
        {
            tracing::debug!("cannot remove the link {}: {error}", link.display());
        }
    }
}

impl ByteLink for PseudoTerminal {
    fn read(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        if !wait_readable(&self.device, wait)?.contains(PollFlags::IN) {
            if !self.is_connected()? {
                std::thread::sleep(wait);
            }
            return Ok(0);
        }
        match rustix::io::read(&self.device, buffer) {
            Err(Errno::IO) => Ok(0),
            read => or_none(read),
        }
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.is_connected()? { or_none(rustix::io::write(&self.device, bytes)) } else { Ok(bytes.len()) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::link::ConnectError;
    use super::super::serial_port::SerialPort;
    use super::*;

    /// Longer than any machine needs.
    const LONG: Duration = Duration::from_secs(10);

    #[test]
    fn bytes_go_both_ways_unchanged() {
        let mut terminal = PseudoTerminal::open().unwrap();
        let mut port = SerialPort::open(terminal.port()).unwrap();
        let (all, mut buffer): (Vec<u8>, _) = ((0..=255).collect(), [0; 300]);
        assert_eq!(terminal.write(&all).unwrap(), 256);
        assert_eq!(port.read(&mut buffer, LONG).unwrap(), 256);
        assert_eq!(buffer[..256], all);
        assert_eq!(port.write(&all).unwrap(), 256);
        assert_eq!(terminal.read(&mut buffer, LONG).unwrap(), 256);
        assert_eq!(buffer[..256], all);
    }

    #[test]
    fn a_port_is_for_one_program_and_free_again_afterwards() {
        let terminal = PseudoTerminal::open().unwrap();
        let first = SerialPort::open(terminal.port()).unwrap();
        assert!(matches!(SerialPort::open(terminal.port()), Err(ConnectError::Busy { .. })));
        drop(first);
        assert!(SerialPort::open(terminal.port()).is_ok());
    }

    #[test]
    fn bytes_sent_to_nobody_are_lost_and_an_unplugged_port_says_so() {
        let mut terminal = PseudoTerminal::open().unwrap();
        assert!(!terminal.is_connected().unwrap());
        assert_eq!(terminal.write(&[1, 2, 3]).unwrap(), 3);
        let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::NONBLOCK;
        let raw = open(terminal.port(), flags, Mode::empty()).unwrap();
        assert_eq!(rustix::io::read(&raw, &mut [0; 9]), Err(Errno::AGAIN));
        assert!(terminal.is_connected().unwrap());
        assert_eq!(terminal.write(&[1, 2, 3]).unwrap(), 3);
        assert!(wait_readable(&raw, LONG).unwrap().contains(PollFlags::IN), "bytes wait for a reader");
        let mut port = SerialPort::open(terminal.port()).unwrap();
        assert_eq!(port.read(&mut [0; 9], Duration::from_millis(1)).unwrap(), 0);
        drop(terminal);
        assert!(port.read(&mut [0; 9], LONG).is_err());
    }

    #[test]
    fn a_link_is_made_replaced_and_removed() {
        let link = std::env::temp_dir().join(format!("trundle-pty-{}", std::process::id()));
        let first = PseudoTerminal::open_at(&link).unwrap();
        let refusal = PseudoTerminal::open_at(&link).unwrap_err().to_string();
        assert!(refusal.contains("another simulator may use it"), "{refusal}");
        drop(first);
        assert!(!link.is_symlink());
        // The link of a simulator that was killed.
        std::os::unix::fs::symlink("/dev/pts/no-such-port", &link).unwrap();
        let second = PseudoTerminal::open_at(&link).unwrap();
        assert_eq!(std::fs::read_link(&link).unwrap(), second.path);
        drop(second);
        assert!(!link.is_symlink());
        std::fs::write(&link, "a file").unwrap();
        let refusal = PseudoTerminal::open_at(&link).unwrap_err().to_string();
        std::fs::remove_file(&link).unwrap();
        assert!(refusal.contains("is a file; remove it"), "{refusal}");
    }
}
