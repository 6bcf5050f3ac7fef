//! The reason for an impossible manoeuvre, in one sentence.

use trundle_docking::{Certificate, Impossible, SearchLimit};

/// The reason for an impossible manoeuvre, in one sentence.
#[must_use]
pub fn impossible_text(impossible: &Impossible) -> String {
    let by = impossible.by.as_ref().map_or_else(String::new, |by| format!(": {by} is in the way"));
    let ended = |limit: SearchLimit| {
        format!(
            "the search reached the limit docking.planner.{}; a larger value searches longer",
            limit.setting()
        )
    };
    let proof = match (impossible.certificate, impossible.limit) {
        (Certificate::Never, None) => "proven for motions of any kind".to_owned(),
        (Certificate::Never, Some(limit)) => {
            format!("proven for motions of any kind within this distance; beyond it no manoeuvre was found: {}", ended(limit))
        }
        (Certificate::AtResolution, _) => {
            "a complete search in steps of docking.planner.position_tolerance found no way through; a way that is narrower than such a step is \
             not ruled out".to_owned()
        }
        (Certificate::None, None) => "no manoeuvre was found, without a proof that none exists".to_owned(),
        (Certificate::None, Some(limit)) => format!("no manoeuvre was found, without a proof that none exists: {}", ended(limit)),
    };
    format!("No manoeuvre within {:.1} m{by} ({proof}).", impossible.within)
}
