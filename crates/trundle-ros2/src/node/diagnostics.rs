//! Conditions of topics and devices, by name: logged when they begin, published on `/diagnostics`.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Time after which a condition that did not come again is over. Source: ours.
const CONDITION_LIFETIME: Duration = Duration::from_secs(5);
/// Maximum number of stored conditions: a peer may send arbitrary names. Source: ours.
const MAX_CONDITIONS: usize = 256;

/// Severity of a condition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// All is well.
    Ok,
    /// A problem with which the robot continues.
    Warning,
    /// Something does not work.
    Error,
}

/// A condition of a topic or device.
#[derive(Debug, Clone, PartialEq)]
pub struct Condition {
    /// Severity of the condition.
    pub level: Level,
    /// One sentence: what, value, expected, remedy.
    pub message: String,
    /// Number of reports since the condition began.
    pub count: u64,
}

struct Entry {
    condition: Condition,
    newest: Instant,
}

/// The conditions of all topics and devices. Clones share them.
#[derive(Clone, Default)]
pub struct Diagnostics(Arc<Mutex<BTreeMap<String, Entry>>>);

impl Diagnostics {
    /// Reports a condition of `name`. The log gets one line when a condition begins or changes in kind.
    pub fn report(&self, name: &str, level: Level, message: impl Into<String>) {
        let (now, message) = (Instant::now(), message.into());
        let mut entries = self.entries();
        if entries.len() >= MAX_CONDITIONS && !entries.contains_key(name) {
            return;
        }
        let count = match entries.get(name) {
            Some(entry) if now - entry.newest < CONDITION_LIFETIME && entry.condition.level == level => {
                entry.condition.count + 1
            }
            _ => 1,
        };
        if count == 1 && level > Level::Ok {
            tracing::warn!("{name}: {message}");
        }
        let condition = Condition { level, message, count };
        entries.insert(name.to_owned(), Entry { condition, newest: now });
    }

    /// A warning of `name`.
    pub fn warn(&self, name: &str, message: impl Into<String>) {
        self.report(name, Level::Warning, message);
    }

    /// The conditions of the last 5 s, by name.
    #[must_use]
    pub fn conditions(&self) -> Vec<(String, Condition)> {
        let now = Instant::now();
        let mut entries = self.entries();
        entries.retain(|_, entry| now - entry.newest < CONDITION_LIFETIME);
        entries.iter().map(|(name, entry)| (name.clone(), entry.condition.clone())).collect()
    }

    /// The sentences of the conditions that are not good news, parted by `; `.
    #[must_use]
    pub fn summary(&self) -> String {
        let conditions = self.conditions();
        let bad = conditions.iter().filter(|(_, condition)| condition.level > Level::Ok);
        bad.map(|(name, condition)| format!("{name}: {}", condition.message)).collect::<Vec<_>>().join("; ")
    }

    fn entries(&self) -> MutexGuard<'_, BTreeMap<String, Entry>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_condition_that_comes_again_is_counted() {
        let diagnostics = Diagnostics::default();
        diagnostics.warn("/odom", "x is NaN");
        diagnostics.warn("/odom", "x is NaN");
        diagnostics.report("/scan", Level::Ok, "30 Hz");
        assert_eq!(diagnostics.conditions()[0].1.count, 2);
        assert_eq!(diagnostics.summary(), "/odom: x is NaN");
        for i in 0..1000 {
            diagnostics.warn(&format!("/t{i}"), "x");
        }
        assert_eq!(diagnostics.conditions().len(), MAX_CONDITIONS);
    }
}
