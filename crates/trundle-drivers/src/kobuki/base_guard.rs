//! A separate process that stops the base if the program that drives it dies.
//!
//! A base repeats its last command forever. A killed or crashed program cannot send zero speed. The guard has the open port and a pipe from
//! the program. When the pipe closes, the guard sends zero speed and ends.

use super::protocol::{BaseControl, KobukiCommand};
use rustix::io::Errno;
use rustix::termios::ioctl_tiocnxcl;
use std::io::{self, Read};
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::time::{Duration, Instant};

/// Command of a program that guards a base: [`guard_base`].
pub const GUARD_COMMAND: &str = "guard-base";
/// Number of times that zero speed is sent: a packet on a noisy line may be lost. Source: ours.
const STOP_COUNT: u32 = 3;
/// Period of these commands: the base's cycle. Source: the protocol's "Feedback Identifier", 50 Hz.
const STOP_PERIOD: Duration = Duration::from_millis(20);
/// Longest time for the guard to end, after which it is killed. Source: ours.
const MAX_END_TIME: Duration = Duration::from_millis(500);

/// The guard of an open port. A drop ends the guard.
#[derive(Debug)]
pub(super) struct BaseGuard {
    process: Child,
    /// Pipe that closes when this value is dropped, or when this program dies.
    pipe: Option<ChildStdin>,
}

impl BaseGuard {
    /// Starts `program` with [`GUARD_COMMAND`]; its standard output is the port. A separate process group shields it from the terminal's
    /// signals.
    pub(super) fn start(program: &Path, port: BorrowedFd<'_>) -> io::Result<Self> {
        let mut process = Command::new(program)
            .arg(GUARD_COMMAND)
            .stdin(Stdio::piped())
            .stdout(Stdio::from(port.try_clone_to_owned()?))
            .stderr(Stdio::null())
            .process_group(0)
            .spawn()?;
        let pipe = process.stdin.take();
        Ok(Self { process, pipe })
    }
}

impl Drop for BaseGuard {
    fn drop(&mut self) {
        drop(self.pipe.take());
        let start = Instant::now();
        while matches!(self.process.try_wait(), Ok(None)) && start.elapsed() < MAX_END_TIME {
            std::thread::sleep(Duration::from_millis(5));
        }
        // The process may have ended by itself.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// The work of a guard: waits until `pipe` ends, then sends zero speed to `port` and releases the port.
///
/// # Errors
/// When the port accepts no data, for example after the base was unplugged.
pub fn guard_base(mut pipe: impl Read, port: impl AsFd) -> io::Result<()> {
    let mut ignored = [0; 64];
    loop {
        match pipe.read(&mut ignored) {
            Ok(0) => break,
            Ok(_) => {}
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            // A pipe that cannot be read is as good as closed.
            Err(_) => break,
        }
    }
    let stop = KobukiCommand::BaseControl(BaseControl::STOP).encode();
    for _ in 0..STOP_COUNT {
        write_all(&port, &stop)?;
        std::thread::sleep(STOP_PERIOD);
    }
    Ok(ioctl_tiocnxcl(&port)?)
}

/// Writes to a port that may be full for a moment.
fn write_all(port: &impl AsFd, mut bytes: &[u8]) -> io::Result<()> {
    let start = Instant::now();
    while !bytes.is_empty() {
        let written = match rustix::io::write(port, bytes) {
            Err(Errno::AGAIN | Errno::INTR) => 0,
            written => written?,
        };
        match written {
            0 if start.elapsed() > MAX_END_TIME => return Err(io::ErrorKind::TimedOut.into()),
            0 => std::thread::sleep(Duration::from_millis(1)),
            written => bytes = &bytes[written..],
        }
    }
    Ok(())
}
