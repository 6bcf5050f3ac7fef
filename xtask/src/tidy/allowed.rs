//! The allow-list: the number of findings of a rule that a file may have. The numbers may only decrease.

use super::finding::{Finding, Rule};
use std::collections::BTreeMap;

/// The list's file, relative to the workspace: a line `rule path count` each.
pub const FILE: &str = "xtask/tidy-allowed.txt";

/// Findings by rule and file.
type Counts = BTreeMap<(Rule, String), usize>;

/// The allow-list.
pub struct Allowed(Counts);

impl Allowed {
    /// Reads the list's text.
    ///
    /// # Errors
    /// When a line is not a rule, a path and a count.
    pub fn parse(text: &str) -> Result<Self, String> {
        let lines = text.lines().enumerate().filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
        let entry = |(i, line): (usize, &str)| {
            let fields: Vec<&str> = line.split(' ').collect();
            let [rule, path, count] = fields[..] else {
                return Err(format!("{FILE}, line {}: '{line}', expected `rule path count`", i + 1));
            };
            let known = Rule::ALL.into_iter().find(|known| known.name() == rule);
            match (known, count.parse()) {
                (Some(rule), Ok(count)) => Ok(((rule, path.to_owned()), count)),
                _ => Err(format!("{FILE}, line {}: '{line}', expected a known rule and a count", i + 1)),
            }
        };
        Ok(Self(lines.map(entry).collect::<Result<_, _>>()?))
    }

    /// Removes allowed findings; entries that allow more than the present findings become warnings.
    pub fn apply(&self, findings: Vec<Finding>) -> Vec<Finding> {
        let found = counts(&findings);
        let is_allowed = |finding: &Finding| {
            finding.rule.is_some_and(|rule| {
                let key = (rule, finding.path.clone());
                found.get(&key).copied().unwrap_or(0) <= self.0.get(&key).copied().unwrap_or(0)
            })
        };
        let stale = self.0.iter().filter(|(key, count)| found.get(*key).copied().unwrap_or(0) < **count);
        let stale = stale.map(|((rule, path), count)| {
            let message = format!(
                "allows {count} {} in {path}, fewer are there: cargo xtask tidy --shrink",
                rule.name()
            );
            Finding::warning(FILE, 1, message)
        });
        findings.iter().filter(|finding| !is_allowed(finding)).cloned().chain(stale).collect()
    }

    /// The list's text for the findings: never more than allowed, unless `grows`.
    pub fn shrunk(&self, findings: &[Finding], grows: bool) -> String {
        let min = |((rule, path), count): ((Rule, String), usize)| {
            let allowed = self.0.get(&(rule, path.clone())).copied().unwrap_or(0);
            (rule, path, if grows { count } else { count.min(allowed) })
        };
        let lines = counts(findings).into_iter().map(min).filter(|(.., count)| *count > 0);
        let head = "# Findings of `cargo xtask tidy` that are allowed until they are mended: rule, file, count. The list only shrinks:\n\
                    # `cargo xtask tidy --shrink` lowers the counts to what is there.\n";
        let lines = lines.map(|(rule, path, count)| format!("{} {path} {count}\n", rule.name()));
        std::iter::once(head.to_owned()).chain(lines).collect()
    }
}

fn counts(findings: &[Finding]) -> Counts {
    let mut counts = Counts::new();
    for finding in findings {
        if let Some(rule) = finding.rule {
            *counts.entry((rule, finding.path.clone())).or_default() += 1;
        }
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn findings(count: usize) -> Vec<Finding> {
        (0..count).map(|i| Finding::ruled(Rule::FileDoc, "a.rs", i + 1, "m")).collect()
    }

    #[test]
    fn allowed_findings_pass_and_further_ones_do_not() {
        let allowed = Allowed::parse("# list\nfile-doc a.rs 2\n").unwrap();
        assert!(allowed.apply(findings(2)).is_empty());
        assert_eq!(allowed.apply(findings(3)).len(), 3);
        assert!(allowed.apply(findings(1))[0].message.contains("--shrink"));
        assert!(Allowed::parse("no-such-rule a.rs 2").is_err());
    }

    #[test]
    fn the_list_only_shrinks() {
        let allowed = Allowed::parse("file-doc a.rs 2\n").unwrap();
        assert!(allowed.shrunk(&findings(1), false).ends_with("file-doc a.rs 1\n"));
        assert!(allowed.shrunk(&findings(3), false).ends_with("file-doc a.rs 2\n"));
        assert!(!allowed.shrunk(&findings(0), false).contains("a.rs"));
    }
}
