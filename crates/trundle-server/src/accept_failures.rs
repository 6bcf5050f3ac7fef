//! Log of refused accepts: one line per kind and period.

use std::collections::BTreeMap;
use std::io::Error;
use std::time::{Duration, Instant};

/// Shortest time between two lines of the same kind. Source: ours.
const LOG_PERIOD: Duration = Duration::from_secs(60);

/// The kinds of refused accepts, by the number of the system's error.
#[derive(Debug, Default)]
pub struct AcceptFailures(BTreeMap<Option<i32>, Failures>);

#[derive(Debug)]
struct Failures {
    logged: Instant,
    /// Number of failures since the last line.
    unlogged: u64,
}

impl AcceptFailures {
    /// The line for a failure; `None` within the period after a line of the same kind.
    pub fn line(&mut self, server: &str, error: &Error, now: Instant) -> Option<String> {
        let known = self.0.get_mut(&error.raw_os_error());
        if let Some(known) = known.filter(|known| now.duration_since(known.logged) < LOG_PERIOD) {
            known.unlogged += 1;
            return None;
        }
        let new = Failures { logged: now, unlogged: 0 };
        let before = self.0.insert(error.raw_os_error(), new).map_or(0, |known| known.unlogged);
        Some(format!(
            "{server}: a connection is not accepted: {error}; {before} more since the last such line. The server goes on. With too many \
             open files, raise their limit (ulimit -n; LimitNOFILE= of a service)"
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kind_has_one_line_per_period_with_the_number_of_the_others() {
        let (mut failures, start) = (AcceptFailures::default(), Instant::now());
        let mut line = |code, after| {
            failures.line("live page", &Error::from_raw_os_error(code), start + Duration::from_secs(after))
        };
        let first = line(24, 0).unwrap();
        assert!(first.starts_with("live page: a connection is not accepted") && first.contains("ulimit -n"));
        assert_eq!((line(24, 1), line(24, 59)), (None, None));
        assert!(line(23, 59).is_some(), "another kind");
        assert!(line(24, 60).unwrap().contains("; 2 more since the last such line"));
        assert_eq!(line(24, 119), None);
    }
}
