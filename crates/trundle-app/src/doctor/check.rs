//! One check of the computer: its level, finding and remedy.

use serde::Serialize;

/// Result of one check.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Check {
    /// The subject of the check, in two words at most.
    pub topic: &'static str,
    /// CheckLevel of the finding.
    pub level: CheckLevel,
    /// The finding, as a sentence.
    pub finding: String,
    /// The remedy, in words or as a command; `None` if all is well.
    pub remedy: Option<String>,
}

/// CheckLevel of a finding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum CheckLevel {
    /// All is well.
    Ok,
    /// Some uses of the program are slower or not possible.
    Warning,
    /// The program cannot do its work.
    Problem,
}

impl CheckLevel {
    /// The level's word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::Warning => "warning",
            Self::Problem => "problem",
        }
    }
}

impl Check {
    pub(super) fn ok(topic: &'static str, finding: impl Into<String>) -> Self {
        Self { topic, level: CheckLevel::Ok, finding: finding.into(), remedy: None }
    }

    pub(super) fn warning(
        topic: &'static str,
        finding: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self { topic, level: CheckLevel::Warning, finding: finding.into(), remedy: Some(remedy.into()) }
    }

    pub(super) fn problem(
        topic: &'static str,
        finding: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self { level: CheckLevel::Problem, ..Self::warning(topic, finding, remedy) }
    }

    pub(super) fn row(&self) -> Vec<String> {
        let remedy = self.remedy.as_ref().map_or_else(String::new, |remedy| format!(": {remedy}"));
        vec![self.level.word().to_owned(), self.topic.to_owned(), format!("{}{remedy}", self.finding)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_have_level_topic_and_remedy() {
        let row = Check::problem("disk", "1 MB are free", "free some").row();
        assert_eq!(row, ["problem", "disk", "1 MB are free: free some"]);
        assert_eq!(Check::ok("disk", "9 GB are free").row()[2], "9 GB are free");
    }
}
