//! A serial port of the system: 115200 baud, 8 data bits, no parity, 1 stop bit, raw.
//!
//! The port has two locks. TIOCEXCL prevents other programs from opening it, except those of root. An exclusive lock of the file excludes
//! other users of this crate, including root.

use super::base_guard::BaseGuard;
use super::link::{ByteLink, ConnectError, Connector};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fd::OwnedFd;
use rustix::fs::{FlockOperation, Mode, OFlags, flock, open};
use rustix::io::Errno;
use rustix::termios::{
    ControlModes, OptionalActions, QueueSelector, ioctl_tiocexcl, ioctl_tiocnxcl, tcflush, tcgetattr,
    tcsetattr,
};
use std::io;
use std::os::fd::AsFd;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Speed of the line: 115200 baud. Source: the Kobuki's documentation, "Communication".
const LINE_SPEED_BAUD: u32 = 115_200;

/// Opens the serial port at a path.
#[derive(Debug, Clone)]
pub struct SerialConnector {
    path: PathBuf,
    guard_program: Option<PathBuf>,
}

impl SerialConnector {
    /// For the port at `path`, as /dev/ttyUSB0.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into(), guard_program: None }
    }

    /// This port, guarded while open by a process of `program`, which has the command [`GUARD_COMMAND`](super::base_guard::GUARD_COMMAND).
    /// The process stops the base if this program dies.
    #[must_use]
    pub fn guarded_by(self, program: &Path) -> Self {
        Self { guard_program: Some(program.to_owned()), ..self }
    }
}

impl Connector for SerialConnector {
    fn connect(&mut self) -> Result<Box<dyn ByteLink>, ConnectError> {
        let mut port = SerialPort::open(&self.path)?;
        if let Some(program) = &self.guard_program {
            port.start_guard(program);
        }
        Ok(Box::new(port))
    }

    fn port(&self) -> String {
        self.path.display().to_string()
    }
}

/// An open serial port.
#[derive(Debug)]
pub struct SerialPort {
    fd: OwnedFd,
    /// Dropped before the port is released.
    guard: Option<BaseGuard>,
}

impl SerialPort {
    /// Opens and locks the port at `path`, sets the line, and drops bytes from before.
    ///
    /// # Errors
    /// When the port is missing, busy, not permitted, or not a serial port.
    pub fn open(path: &Path) -> Result<Self, ConnectError> {
        let port = Self { fd: open_unblocked(path)?, guard: None };
        port.lock().and_then(|()| port.set_line()).map_err(|errno| connect_error(path, errno))?;
        Ok(port)
    }

    /// Starts a guard. Without a guard the base repeats its last command after this program is killed.
    fn start_guard(&mut self, program: &Path) {
        match BaseGuard::start(program, self.fd.as_fd()) {
            Ok(guard) => self.guard = Some(guard),
            Err(error) => tracing::warn!(
                "no guard of the base: {} cannot be started: {error}; if this program is killed, the base drives on",
                program.display()
            ),
        }
    }

    fn lock(&self) -> Result<(), Errno> {
        flock(&self.fd, FlockOperation::NonBlockingLockExclusive)?;
        ioctl_tiocexcl(&self.fd)
    }

    fn set_line(&self) -> Result<(), Errno> {
        let mut termios = tcgetattr(&self.fd)?;
        termios.make_raw();
        termios.control_modes |= ControlModes::CLOCAL | ControlModes::CREAD;
        termios.control_modes -= ControlModes::CSTOPB | ControlModes::CRTSCTS;
        termios.set_speed(LINE_SPEED_BAUD)?;
        tcsetattr(&self.fd, OptionalActions::Now, &termios)?;
        tcflush(&self.fd, QueueSelector::IOFlush)
    }
}

impl Drop for SerialPort {
    fn drop(&mut self) {
        drop(self.guard.take());
        if let Err(errno) = ioctl_tiocnxcl(&self.fd) {
            tracing::debug!("the lock of a lost port cannot be released: {errno}");
        }
    }
}

impl ByteLink for SerialPort {
    fn read(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        if !wait_readable(&self.fd, wait)?.intersects(PollFlags::IN | PollFlags::HUP | PollFlags::ERR) {
            return Ok(0);
        }
        match rustix::io::read(&self.fd, buffer) {
            Ok(0) => Err(io::Error::new(io::ErrorKind::UnexpectedEof, "the port was unplugged")),
            read => or_none(read),
        }
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        or_none(rustix::io::write(&self.fd, bytes))
    }
}

/// Opens a port without a wait for its carrier, and not as the terminal of this program.
pub(crate) fn open_unblocked(path: &Path) -> Result<OwnedFd, ConnectError> {
    let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
    open(path, flags, Mode::empty()).map_err(|errno| connect_error(path, errno))
}

/// Waits until `fd` can be read, at most `wait`; returns the event.
pub(super) fn wait_readable(fd: &OwnedFd, wait: Duration) -> io::Result<PollFlags> {
    let mut fds = [PollFd::new(fd, PollFlags::IN)];
    let timeout = Timespec { tv_sec: wait.as_secs() as i64, tv_nsec: i64::from(wait.subsec_nanos()) };
    match poll(&mut fds, Some(&timeout)) {
        Ok(_) => Ok(fds[0].revents()),
        Err(Errno::INTR) => Ok(PollFlags::empty()),
        Err(errno) => Err(errno.into()),
    }
}

/// 0 if the system reports that the call would block.
pub(super) fn or_none(bytes: Result<usize, Errno>) -> io::Result<usize> {
    match bytes {
        Err(Errno::AGAIN | Errno::INTR) => Ok(0),
        bytes => Ok(bytes?),
    }
}

fn connect_error(path: &Path, errno: Errno) -> ConnectError {
    let port = path.to_owned();
    match errno {
        Errno::NOENT => ConnectError::Missing { port },
        Errno::NODEV | Errno::NXIO => ConnectError::NoDevice { port },
        Errno::BUSY | Errno::WOULDBLOCK => ConnectError::Busy { port },
        Errno::ACCESS | Errno::PERM => ConnectError::NoRights { port },
        Errno::NOTTY | Errno::ISDIR => ConnectError::NotASerialPort { port },
        errno => ConnectError::Io { port, source: errno.into() },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_say_what_to_do() {
        let text = |errno| connect_error(Path::new("/dev/ttyUSB0"), errno).to_string();
        assert!(text(Errno::ACCESS).contains("sudo usermod -aG dialout $USER"));
        assert!(text(Errno::NXIO).starts_with("port /dev/ttyUSB0 has no device behind it"));
        assert!(text(Errno::BUSY).starts_with("port /dev/ttyUSB0 is in use by another program"));
        assert!(text(Errno::NOENT).contains("connect the base's USB cable"));
        assert!(text(Errno::IO).starts_with("port /dev/ttyUSB0 cannot be opened: "));
    }

    #[test]
    fn a_file_is_not_a_serial_port() {
        let path = std::env::current_exe().unwrap();
        let port = std::env::temp_dir().join(format!("trundle-no-port-{}", std::process::id()));
        std::fs::write(&port, "").unwrap();
        let error = SerialPort::open(&port).unwrap_err();
        std::fs::remove_file(&port).unwrap();
        assert!(matches!(error, ConnectError::NotASerialPort { .. }), "{error}");
        assert!(matches!(SerialPort::open(path.parent().unwrap()), Err(ConnectError::NotASerialPort { .. })));
        assert!(matches!(SerialPort::open(&port), Err(ConnectError::Missing { .. })));
    }
}
