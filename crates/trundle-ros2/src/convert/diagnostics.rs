//! `diagnostic_msgs/DiagnosticArray`.

use super::stamp;
use crate::generated::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus, KeyValue};
use crate::node::{Condition, Level};
use trundle_core::Stamp;

/// The conditions of a node as a message. Names begin with `node`, as `diagnostic_aggregator` groups them.
#[must_use]
pub fn to_ros(conditions: &[(String, Condition)], node: &str, at: Stamp) -> DiagnosticArray {
    let status = |(name, condition): &(String, Condition)| DiagnosticStatus {
        level: match condition.level {
            Level::Ok => DiagnosticStatus::OK,
            Level::Warning => DiagnosticStatus::WARN,
            Level::Error => DiagnosticStatus::ERROR,
        },
        name: format!("{node}: {name}"),
        message: condition.message.clone(),
        hardware_id: node.to_owned(),
        values: vec![KeyValue { key: "reports".to_owned(), value: condition.count.to_string() }],
    };
    DiagnosticArray { header: stamp::header(at, ""), status: conditions.iter().map(status).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_condition_is_a_status() {
        let condition = Condition { level: Level::Error, message: "x is NaN".into(), count: 3 };
        let array = to_ros(&[("/odom".to_owned(), condition)], "trundle", Stamp::default());
        let status = &array.status[0];
        assert_eq!((status.level, status.name.as_str()), (DiagnosticStatus::ERROR, "trundle: /odom"));
        assert_eq!(status.values[0].value, "3");
    }
}
