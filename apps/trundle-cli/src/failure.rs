use thiserror::Error;
use trundle::core::Invalid;
use trundle::io::IoError;

/// Why a command ended before its end, in one sentence for a person.
#[derive(Debug, Error)]
pub enum Failure {
    /// A file or folder cannot be read, understood or written.
    #[error(transparent)]
    Io(#[from] IoError),
    /// A value cannot be accepted.
    #[error("{0}")]
    Invalid(#[from] Invalid),
    /// An argument or a file's content cannot be accepted.
    #[error("{0}")]
    Input(String),
    /// The machine refused something.
    #[error("{0}")]
    Environment(String),
}

impl Failure {
    /// 2 for all of them: the input or the place to write to has to change first.
    pub fn exit_code(&self) -> u8 {
        2
    }
}
