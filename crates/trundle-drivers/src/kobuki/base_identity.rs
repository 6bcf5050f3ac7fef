//! The unique id of the base that answers on the port: a run belongs to the base that it began with.

use super::protocol::UniqueId;
use std::fmt;
use trundle_core::Stamp;

/// Time between requests for the id on a connection that waits for it: 0.5 s. Source: ours, as at the start of a base.
const REQUEST_PERIOD_S: f64 = 0.5;

/// Another base answers than the one that the run began with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct OtherBase {
    /// The base that answers.
    pub(super) found: UniqueId,
    /// The base that the run began with.
    pub(super) expected: UniqueId,
}

impl fmt::Display for OtherBase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "base {} answers, expected base {}, with which the run began: connect that base alone, or start a new run for this one",
            self.found, self.expected
        )
    }
}

/// Whether the base on the present connection is the one that the run began with.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct BaseIdentity {
    /// The run's base; `None` as long as it has not reported its id.
    expected: Option<UniqueId>,
    /// Whether the run's base has answered on this connection.
    has_answered: bool,
    requested: Option<Stamp>,
    /// Answers of other bases since the last one of the run's base.
    refusals: u64,
}

impl BaseIdentity {
    /// Identity on the first connection, whose base has reported `expected`.
    pub(super) fn new(expected: Option<UniqueId>) -> Self {
        Self { expected, has_answered: true, requested: None, refusals: 0 }
    }

    /// A connection has ended: the base of the next one is unknown.
    pub(super) fn forget(&mut self) {
        *self = Self { has_answered: false, requested: None, ..*self };
    }

    /// Records an answer of the base.
    ///
    /// # Errors
    /// When it is another base.
    pub(super) fn on_answer(&mut self, found: UniqueId) -> Result<(), OtherBase> {
        let expected = *self.expected.get_or_insert(found);
        self.has_answered = found == expected;
        self.refusals = if self.has_answered { 0 } else { self.refusals + 1 };
        if self.has_answered { Ok(()) } else { Err(OtherBase { found, expected }) }
    }

    /// Whether the run's base is on the line. A base without a reported id looks like any other.
    pub(super) fn is_confirmed(&self) -> bool {
        self.has_answered || self.expected.is_none()
    }

    /// Answers of other bases since the last one of the run's base.
    pub(super) fn refusals(&self) -> u64 {
        self.refusals
    }

    /// Records a request for the id at `now`.
    pub(super) fn note_request(&mut self, now: Stamp) {
        self.requested = Some(now);
    }

    /// Whether the id must be requested at `now`.
    pub(super) fn is_request_due(&self, now: Stamp) -> bool {
        !self.is_confirmed() && self.requested.is_none_or(|last| now - last >= REQUEST_PERIOD_S)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OURS: UniqueId = UniqueId([1, 2, 3]);
    const OTHER: UniqueId = UniqueId([1, 2, 4]);

    fn at(ms: i64) -> Stamp {
        Stamp::from_nanos(ms * 1_000_000)
    }

    #[test]
    fn another_base_is_refused_until_the_own_one_answers() {
        let mut identity = BaseIdentity::new(Some(OURS));
        assert!(identity.is_confirmed());
        identity.forget();
        assert!(!identity.is_confirmed());
        let error = identity.on_answer(OTHER).unwrap_err();
        assert_eq!(error, OtherBase { found: OTHER, expected: OURS });
        assert!(error.to_string().starts_with("base 1-2-4 answers, expected base 1-2-3"), "{error}");
        assert!(!identity.is_confirmed() && identity.refusals() == 1);
        assert!(identity.on_answer(OURS).is_ok() && identity.is_confirmed() && identity.refusals() == 0);
        assert!(identity.on_answer(OTHER).is_err() && !identity.is_confirmed(), "both answer on one port");
    }

    #[test]
    fn the_first_id_of_a_base_without_one_is_its_own() {
        let mut identity = BaseIdentity::new(None);
        identity.forget();
        assert!(identity.is_confirmed() && !identity.is_request_due(at(0)));
        assert!(identity.on_answer(OURS).is_ok());
        assert!(identity.on_answer(OTHER).is_err());
    }

    #[test]
    fn the_id_is_requested_until_it_comes() {
        let mut identity = BaseIdentity::new(Some(OURS));
        assert!(!identity.is_request_due(at(0)));
        identity.forget();
        let mut due = Vec::new();
        for ms in (0..1200).step_by(100) {
            if identity.is_request_due(at(ms)) {
                identity.note_request(at(ms));
                due.push(ms);
            }
        }
        assert_eq!(due, [0, 500, 1000]);
        identity.on_answer(OURS).unwrap();
        assert!(!identity.is_request_due(at(5000)));
    }
}
