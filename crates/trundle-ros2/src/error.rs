//! Reason why a node cannot be started.

use trundle_app::AppError;

/// Reason why a node cannot be started, or why a name or argument is refused.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Ros2Error {
    /// A name with characters that ROS 2 does not allow.
    #[error("'{name}' is not a ROS 2 name: {problem}; expected letters, digits and _ parted by /")]
    Name {
        /// The name.
        name: String,
        /// The problem.
        problem: String,
    },
    /// An unknown ROS argument.
    #[error(
        "'{argument}' after --ros-args is unknown; expected `-r FROM:=TO`, `-r __ns:=/NS`, `-r __node:=NAME`, `-p NAME:=VALUE`, `--params-file FILE` or `--log-level LEVEL`"
    )]
    Argument {
        /// The argument.
        argument: String,
    },
    /// A parameter file that cannot be read.
    #[error("the parameter file after --params-file cannot be read: {0}")]
    ParameterFile(String),
    /// A parameter whose value has the wrong type.
    #[error("parameter {name} is '{value}', expected {expected}")]
    Parameter {
        /// Name of the parameter.
        name: String,
        /// The value.
        value: String,
        /// Values that are accepted.
        expected: &'static str,
    },
    /// The DDS participant, a topic or a service cannot be created.
    #[error("cannot create {what}: {problem}")]
    Create {
        /// The object to create.
        what: String,
        /// Message of the library.
        problem: String,
    },
    /// The system refuses a thread.
    #[error("cannot start the thread of the ROS 2 node: {0}")]
    Thread(#[from] std::io::Error),
    /// A topic that is needed to begin stayed silent.
    #[error(
        "no usable message was received on {topics} within {seconds} s{reason}; `ros2 topic list` shows what is there, --ros-interface and ROS_DOMAIN_ID which network and domain are used; with --ros-interface loopback {}",
        crate::node::DISCOVERY
    )]
    Silent {
        /// The topics.
        topics: String,
        /// Time of the wait \[s\].
        seconds: f64,
        /// Problems of the messages that came; empty if none came.
        reason: String,
    },
    /// The user stopped the program during the start.
    #[error("stopped before the run began")]
    Interrupted,
}

impl From<Ros2Error> for AppError {
    fn from(error: Ros2Error) -> Self {
        Self::Input(error.to_string())
    }
}

impl Ros2Error {
    pub(crate) fn create(what: impl Into<String>, problem: impl std::fmt::Debug) -> Self {
        Self::Create { what: what.into(), problem: format!("{problem:?}") }
    }
}
