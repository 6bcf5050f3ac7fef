//! Commands for the base as messages, from a separate thread.

use super::BodySettings;
use crate::Ros2Error;
use crate::clock::RosClock;
use crate::convert::twist;
use crate::generated::geometry_msgs::{Twist, TwistStamped};
use crate::node::{Diagnostics, Level, RosNode, qos};
use ros2_client::Publisher;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;
use trundle_app::real_time::COMMAND_TIMEOUT_S;
use trundle_core::Twist2;

/// Longest wait for a command before the age of the newest one is checked. Source: ours.
const CHECK_PERIOD: Duration = Duration::from_millis(20);
/// Messages of standstill at the end: one may get lost. Source: ours.
const LAST_STOPS: usize = 5;
/// Period of the last stops. Source: ours.
const LAST_STOP_PERIOD: Duration = Duration::from_millis(20);

/// Publishes commands in either form.
pub struct CommandPublisher {
    form: Form,
    clock: RosClock,
    base_frame: String,
    name: String,
    diagnostics: Diagnostics,
}

enum Form {
    Stamped(Publisher<TwistStamped>),
    Plain(Publisher<Twist>),
}

impl CommandPublisher {
    /// The publisher of the topic `settings.cmd_vel`.
    ///
    /// # Errors
    /// When the topic cannot be created.
    pub fn new(node: &mut RosNode, settings: &BodySettings, clock: RosClock) -> Result<Self, Ros2Error> {
        let qos = qos::reliable(1);
        let form = if settings.stamped_commands {
            Form::Stamped(node.publisher(&settings.cmd_vel, &qos)?)
        } else {
            Form::Plain(node.publisher(&settings.cmd_vel, &qos)?)
        };
        let (name, base_frame) = (node.names().resolve(&settings.cmd_vel), settings.base_frame.clone());
        Ok(Self { form, clock, base_frame, name, diagnostics: node.diagnostics() })
    }

    /// Publishes a command; one that is not finite becomes standstill.
    pub fn publish(&self, command: Twist2) {
        let command = if command.is_finite() { command } else { Twist2::ZERO };
        let failure = match &self.form {
            Form::Stamped(publisher) => {
                let message = twist::stamped(command, self.clock.ros_now(), &self.base_frame);
                publisher.publish(message).err().map(|error| format!("{error:?}"))
            }
            Form::Plain(publisher) => {
                publisher.publish(twist::to_ros(command)).err().map(|error| format!("{error:?}"))
            }
        };
        if let Some(failure) = failure {
            self.diagnostics.report(&self.name, Level::Error, format!("a command was not sent: {failure}"));
        }
    }
}

/// The thread that publishes commands. Without a command for 0.2 s of the robot's time, and at its end, it commands zero speed.
pub struct CommandThread {
    commands: Option<Sender<Twist2>>,
    thread: Option<JoinHandle<()>>,
}

impl CommandThread {
    /// Starts the thread.
    ///
    /// # Errors
    /// When the system refuses a thread.
    pub fn start(publisher: CommandPublisher) -> Result<Self, Ros2Error> {
        let (commands, received) = channel();
        let thread = std::thread::Builder::new().name("cmd-vel".to_owned());
        let thread = thread.spawn(move || publish_all(&publisher, &received))?;
        Ok(Self { commands: Some(commands), thread: Some(thread) })
    }

    /// Sender for commands.
    #[must_use]
    pub fn commands(&self) -> Sender<Twist2> {
        self.commands.clone().unwrap_or_else(|| channel().0)
    }
}

impl Drop for CommandThread {
    fn drop(&mut self) {
        // Clones of the sender may live on: the last command is standstill all the same.
        if let Some(commands) = self.commands.take() {
            let _ = commands.send(Twist2::new(f64::NAN, f64::NAN));
        }
        if self.thread.take().is_some_and(|thread| thread.join().is_err()) {
            tracing::error!("the thread that sends commands panicked");
        }
    }
}

/// Publishes each command until the end, which is a command that is not a number.
fn publish_all(publisher: &CommandPublisher, commands: &Receiver<Twist2>) {
    // Time of the newest command with motion.
    let mut moving_since = None;
    loop {
        match commands.recv_timeout(CHECK_PERIOD) {
            Ok(command) if !command.is_finite() => break,
            Ok(command) => {
                publisher.publish(command);
                moving_since = (command != Twist2::ZERO).then(|| publisher.clock.now());
            }
            Err(RecvTimeoutError::Timeout) => {
                let silence = moving_since.map_or(0.0, |since| publisher.clock.now() - since);
                if silence > COMMAND_TIMEOUT_S {
                    publisher.publish(Twist2::ZERO);
                    moving_since = None;
                }
            }
            Err(RecvTimeoutError::Disconnected) => break,
        }
    }
    for _ in 0..LAST_STOPS {
        publisher.publish(Twist2::ZERO);
        std::thread::sleep(LAST_STOP_PERIOD);
    }
}
