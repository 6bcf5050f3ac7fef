//! `/state`: the state of the run with its reason, as a line of a log.

use super::timestamp;
use foxglove::messages::{Log, log::Level};
use trundle_app::operator::RunView;
use trundle_core::Stamp;

/// The state of a view; a warning if something keeps the robot at rest.
pub fn message(view: &RunView) -> Option<(Stamp, Log)> {
    let is_kept = view.hold.is_some() || view.state.reason().is_some();
    let level = if is_kept { Level::Warning } else { Level::Info };
    let message = Log {
        timestamp: Some(timestamp(view.stamp)),
        level: level.into(),
        message: text(view),
        name: "trundle".to_owned(),
        file: String::new(),
        line: 0,
    };
    Some((view.stamp, message))
}

/// The state in words: its name, the reason, and the condition under which no wheel may turn.
pub fn text(view: &RunView) -> String {
    let name = view.state.name().to_owned();
    let hold = view.hold.map(|hold| hold.to_string());
    [Some(name), view.state.reason(), hold].into_iter().flatten().collect::<Vec<_>>().join(": ")
}
