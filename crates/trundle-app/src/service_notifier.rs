//! Messages to the service manager that started this program: ready, alive, stopping. Source: systemd, `sd_notify(3)`.

use std::time::{Duration, Instant};

/// Variable with the socket of the service manager.
const SOCKET_VARIABLE: &str = "NOTIFY_SOCKET";
/// Variable with the time after which a silent program is ended \[µs\].
const WATCHDOG_VARIABLE: &str = "WATCHDOG_USEC";
/// Parts of that time between two messages. Source: `sd_watchdog_enabled(3)` advises half; a step may be late.
const MESSAGES_PER_WATCHDOG_TIME: u32 = 4;

/// Notifies the service manager that the robot's loop is alive. Without a service manager it does nothing.
#[derive(Debug, Default)]
pub struct ServiceNotifier {
    /// The connection, until the first message fails.
    socket: Option<NotifySocket>,
    /// Time between two messages; `None` without a watchdog.
    interval: Option<Duration>,
    last: Option<Instant>,
}

impl ServiceNotifier {
    /// The service manager of this process's environment, if there is one.
    #[must_use]
    pub fn from_environment() -> Self {
        let text = |name| std::env::var(name).ok().filter(|value: &String| !value.is_empty());
        text(SOCKET_VARIABLE)
            .map_or_else(Self::default, |socket| Self::new(&socket, text(WATCHDOG_VARIABLE).as_deref()))
    }

    /// The service manager at a socket: a path, or `@` and a name. `watchdog_us` is the time after which a silent program is ended.
    #[must_use]
    pub fn new(socket: &str, watchdog_us: Option<&str>) -> Self {
        let watchdog = watchdog_us.and_then(|text| text.parse().ok()).filter(|us| *us > 0);
        let interval = watchdog.map(|us| Duration::from_micros(us) / MESSAGES_PER_WATCHDOG_TIME);
        let socket = NotifySocket::connect(socket);
        if let Err(error) = &socket {
            tracing::warn!("{SOCKET_VARIABLE}: {error}; the service manager is not notified");
        }
        Self { socket: socket.ok(), interval, last: None }
    }

    /// The loop made a step: ready after the first, alive after others when due.
    pub fn note_step(&mut self, now: Instant) {
        match (self.last, self.interval) {
            _ if self.socket.is_none() => return,
            (None, _) => self.send("READY=1\nWATCHDOG=1"),
            (Some(last), Some(interval)) if now.saturating_duration_since(last) >= interval => {
                self.send("WATCHDOG=1");
            }
            _ => return,
        }
        self.last = Some(now);
    }

    /// The loop has ended; results are being written.
    pub fn note_end(&mut self) {
        self.send("STOPPING=1");
    }

    fn send(&mut self, message: &str) {
        let Some(Err(error)) = self.socket.as_ref().map(|socket| socket.send(message)) else { return };
        if error.kind() != std::io::ErrorKind::WouldBlock {
            tracing::warn!("the service manager does not listen: {error}");
            self.socket = None;
        }
    }
}

/// The socket of a service manager.
#[cfg(target_os = "linux")]
#[derive(Debug)]
struct NotifySocket(std::os::unix::net::UnixDatagram);

#[cfg(target_os = "linux")]
impl NotifySocket {
    fn connect(name: &str) -> std::io::Result<Self> {
        use std::os::linux::net::SocketAddrExt;
        use std::os::unix::net::{SocketAddr, UnixDatagram};
        let address = match name.strip_prefix('@') {
            Some(name) => SocketAddr::from_abstract_name(name)?,
            None => SocketAddr::from_pathname(name)?,
        };
        let socket = UnixDatagram::unbound()?;
        socket.set_nonblocking(true)?;
        socket.connect_addr(&address)?;
        Ok(Self(socket))
    }

    fn send(&self, message: &str) -> std::io::Result<()> {
        self.0.send(message.as_bytes()).map(|_| ())
    }
}

/// Other systems have no such socket.
#[cfg(not(target_os = "linux"))]
#[derive(Debug)]
struct NotifySocket;

#[cfg(not(target_os = "linux"))]
impl NotifySocket {
    fn connect(_name: &str) -> std::io::Result<Self> {
        Err(std::io::Error::from(std::io::ErrorKind::Unsupported))
    }

    fn send(&self, _message: &str) -> std::io::Result<()> {
        Ok(())
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;
    use std::os::unix::net::UnixDatagram;

    /// The next message at a socket; `None` if there is none.
    fn next(manager: &UnixDatagram) -> Option<String> {
        let mut bytes = [0; 256];
        manager.set_nonblocking(true).ok()?;
        let length = manager.recv(&mut bytes).ok()?;
        String::from_utf8(bytes[..length].to_vec()).ok()
    }

    #[test]
    fn steps_are_reported_at_a_quarter_of_the_watchdog_time() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("notify");
        let manager = UnixDatagram::bind(&path).unwrap();
        let mut notifier = ServiceNotifier::new(path.to_str().unwrap(), Some("4000000"));
        let start = Instant::now();
        notifier.note_step(start);
        assert_eq!(next(&manager).unwrap(), "READY=1\nWATCHDOG=1");
        notifier.note_step(start + Duration::from_millis(900));
        assert_eq!(next(&manager), None);
        notifier.note_step(start + Duration::from_millis(1000));
        assert_eq!(next(&manager).unwrap(), "WATCHDOG=1");
        notifier.note_end();
        assert_eq!(next(&manager).unwrap(), "STOPPING=1");
    }

    #[test]
    fn without_a_watchdog_only_ready_is_sent() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("notify");
        let manager = UnixDatagram::bind(&path).unwrap();
        for watchdog in [None, Some("0"), Some("soon")] {
            let mut notifier = ServiceNotifier::new(path.to_str().unwrap(), watchdog);
            let start = Instant::now();
            notifier.note_step(start);
            notifier.note_step(start + Duration::from_secs(1000));
            assert!(next(&manager).unwrap().starts_with("READY=1") && next(&manager).is_none());
        }
    }

    #[test]
    fn a_service_manager_that_is_absent_or_ends_does_not_stop_the_robot() {
        let mut absent = ServiceNotifier::new("/no/such/socket", Some("1000000"));
        absent.note_step(Instant::now());
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("notify");
        let manager = UnixDatagram::bind(&path).unwrap();
        let mut notifier = ServiceNotifier::new(path.to_str().unwrap(), Some("1000000"));
        drop(manager);
        notifier.note_step(Instant::now());
        notifier.note_end();
        assert!(notifier.socket.is_none());
        ServiceNotifier::default().note_step(Instant::now());
    }
}
