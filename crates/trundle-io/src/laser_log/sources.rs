//! The topics used for a log, and their selection.

use std::collections::BTreeMap;

/// The topics of a bag, or the lines of a CARMEN log, that made a laser log.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct LaserLogSources {
    /// Topic of the scans; empty if the log has no topics.
    pub scans: String,
    /// Topic of the odometry.
    pub odometry: String,
    /// Unused topics of scans or odometry, with the number of their messages.
    pub left: Vec<(String, usize)>,
}

/// The requested topic, or else the one with the most messages, the first in case of equality.
///
/// # Errors
/// Names the topics of the file when the requested one does not exist.
pub(crate) fn chosen(
    counts: &BTreeMap<String, usize>,
    asked: Option<&str>,
    kind: &str,
) -> Result<String, String> {
    let max = counts.values().max().ok_or_else(|| format!("no {kind} in it"))?;
    let found = match asked {
        Some(asked) => counts.keys().find(|topic| is_named(topic, asked)),
        None => counts.iter().find(|(_, count)| *count == max).map(|(topic, _)| topic),
    };
    found.cloned().ok_or_else(|| {
        let all: Vec<String> = counts.iter().map(|(topic, count)| format!("{topic} ({count})")).collect();
        format!("no {kind} on {}, expected one of: {}", asked.unwrap_or_default(), all.join(", "))
    })
}

/// Whether a topic has the requested name; a slash before the name is ignored.
pub(crate) fn is_named(topic: &str, asked: &str) -> bool {
    topic.trim_start_matches('/') == asked.trim_start_matches('/')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_topic_asked_for_or_the_largest_is_chosen() {
        let counts = BTreeMap::from([("/a".to_owned(), 3), ("/b".to_owned(), 7), ("/c".to_owned(), 7)]);
        assert_eq!(chosen(&counts, None, "scan").unwrap(), "/b");
        assert_eq!(chosen(&counts, Some("a"), "scan").unwrap(), "/a");
        assert_eq!(
            chosen(&counts, Some("/d"), "scan").unwrap_err(),
            "no scan on /d, expected one of: /a (3), /b (7), /c (7)"
        );
        assert_eq!(chosen(&BTreeMap::new(), Some("/d"), "scan").unwrap_err(), "no scan in it");
    }
}
