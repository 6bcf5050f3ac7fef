//! The link of a robot to a broker, on its own thread.

use crate::worker::FleetWorker;
use crate::{BrokerAddress, FleetError, FleetOptions, Password, RobotFacts, RobotName};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use trundle_app::operator::{Operator, OperatorLink};
use trundle_app::{AppError, RunSetup};

/// The link of a robot to a broker. A drop disconnects from the broker and ends the thread.
#[derive(Debug)]
pub struct FleetLink {
    options: FleetOptions,
    is_over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl FleetLink {
    /// Joins a broker, retrying until it answers. The log has a warning when the broker is lost and when it returns.
    ///
    /// # Errors
    /// When a password has no user, or the system refuses a thread.
    pub fn start(options: FleetOptions, operator: Operator, facts: RobotFacts) -> Result<Self, FleetError> {
        if options.password.is_some() && options.broker.user.is_none() {
            return Err(FleetError::PasswordWithoutUser);
        }
        let is_over = Arc::new(AtomicBool::new(false));
        let worker = FleetWorker::new(&options, operator, facts);
        let ends = Arc::clone(&is_over);
        let work = move || worker.run(|| ends.load(Ordering::Relaxed));
        let thread = std::thread::Builder::new().name("fleet".to_owned()).spawn(work)?;
        Ok(Self { options, is_over, thread: Some(thread) })
    }

    /// The link for a run of a setup, with the options of a command line.
    ///
    /// # Errors
    /// As [`FleetLink::start`]; when the password file or the robot's outline cannot be used, or the run accepts no commands.
    pub fn for_run(
        setup: &RunSetup,
        link: &OperatorLink,
        is_steered: bool,
        broker: BrokerAddress,
        password_file: Option<&Path>,
        name: Option<&RobotName>,
        map_id: &str,
    ) -> Result<Self, AppError> {
        if !is_steered {
            return Err(AppError::input("--mqtt: this run is a replay, which takes no commands"));
        }
        let mut options = FleetOptions::new(broker, map_id.to_owned());
        options.password = Password::read(password_file)?;
        options.name = name.cloned().unwrap_or_default();
        Ok(Self::start(options, link.operator(), RobotFacts::of(setup)?)?)
    }

    /// Notice for a person: the broker, the name of the robot, and a warning if the network is open.
    #[must_use]
    pub fn announcement(&self) -> String {
        let FleetOptions { broker, name, map_id, .. } = &self.options;
        let warning = match broker.is_local() {
            true => "",
            false => {
                "\nwarning: the connection to the broker is not encrypted: who reads or joins its network can drive the robot"
            }
        };
        format!("MQTT: {broker}, robot {name}, map '{map_id}'{warning}")
    }
}

impl Drop for FleetLink {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        if self.thread.take().is_some_and(|thread| thread.join().is_err()) {
            tracing::error!("the thread of the link to the broker panicked");
        }
    }
}
