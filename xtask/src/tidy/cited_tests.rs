//! The threat model and the safety case name tests that exist, and each row of the threat model names one, or says that nothing is there.

use super::finding::Finding;
use super::tree::Tree;

/// The documents whose code spans in the form of a test's name are checked.
const DOCUMENTS: [&str; 2] = [THREAT_MODEL, "docs/explanation/safety-case.md"];
/// The document whose tables have a defence and its test in their last two columns.
const THREAT_MODEL: &str = "docs/explanation/threat-model.md";
/// How a row says that there is no defence.
const NO_DEFENCE: &str = "**nothing";
/// Smallest number of underscores at which a span is the name of a test; names of options and files have fewer. Source: ours.
const MIN_UNDERSCORES: usize = 3;

/// Checks the documents.
pub fn check(tree: &Tree) -> Vec<Finding> {
    let cited = DOCUMENTS.iter().flat_map(|document| check_document(tree, document));
    cited.chain(tree.file(THREAT_MODEL).into_iter().flat_map(|file| untested(&file.text))).collect()
}

/// A finding for each row of a defence without a test.
fn untested(text: &str) -> Vec<Finding> {
    let is_untested = |row: &str| {
        let cells: Vec<&str> = row.trim().trim_matches('|').split(" | ").collect();
        let [.., defence, test] = cells[..] else { return false };
        row.starts_with("| ") && !test.contains('`') && !defence.contains(NO_DEFENCE)
    };
    let lines: Vec<&str> = text.lines().collect();
    // The line below a heading is `|---|---|`.
    let is_heading = |i: usize| lines.get(i + 1).is_some_and(|next| next.starts_with("|-"));
    let rows = lines.iter().enumerate().filter(|(i, row)| !is_heading(*i) && is_untested(row));
    let message = format!("a row names a test, script or command, or says {NO_DEFENCE}");
    rows.map(|(i, _)| Finding::error(THREAT_MODEL, i + 1, message.clone())).collect()
}

fn check_document(tree: &Tree, document: &str) -> Vec<Finding> {
    let Some(file) = tree.file(document) else { return Vec::new() };
    let lines = file.text.lines().enumerate();
    let cited = lines.flat_map(|(i, line)| line.split('`').skip(1).step_by(2).map(move |span| (i + 1, span)));
    let gone = cited.filter(|(_, span)| is_test_name(span) && !is_test(tree, span));
    gone.map(|(line, span)| Finding::error(document, line, format!("there is no test {span}"))).collect()
}

fn is_test_name(span: &str) -> bool {
    let is_word = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    span.chars().all(is_word) && span.matches('_').count() >= MIN_UNDERSCORES
}

/// Whether a Rust file has a function of this name below `#[test]`, with other attributes between at most.
fn is_test(tree: &Tree, name: &str) -> bool {
    let heads = [format!("fn {name}("), format!("async fn {name}(")];
    tree.ending(".rs").any(|file| {
        let lines: Vec<&str> = file.text.lines().map(str::trim).collect();
        let is_head = |line: &str| heads.iter().any(|head| line.starts_with(head.as_str()));
        let at = lines.iter().position(|line| is_head(line));
        at.is_some_and(|at| {
            let before = lines[..at].iter().rev().take_while(|line| line.starts_with('#'));
            before.into_iter().any(|line| line.starts_with("#[test]"))
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tidy::tree::tests::tree;

    #[test]
    fn a_defence_without_a_test_is_found() {
        let rows = "| who | stopped by | test |\n|---|---|---|\n| a | b | `c_d_e_f` |\n| a | **nothing: x** | |\n| a | b | |\ntext | b | |\n";
        let lines: Vec<usize> = untested(rows).iter().map(|finding| finding.line).collect();
        assert_eq!(lines, [5]);
    }

    #[test]
    fn tests_that_are_gone_are_found() {
        let source =
            "#[test]\n#[cfg(unix)]\nfn a_wrong_token_is_refused() {}\nfn a_helper_of_the_tests() {}\n";
        let text = "`a_wrong_token_is_refused`, `bench/x_y_z_w.sh`, `--ros2`\n`a_test_that_is_gone` `a_helper_of_the_tests`\n";
        let found = check(&tree(&[("x/src/lib.rs", source), (DOCUMENTS[1], text)]));
        let mut messages: Vec<&str> = found.iter().map(|finding| finding.message.as_str()).collect();
        messages.sort_unstable();
        assert_eq!(
            messages,
            ["there is no test a_helper_of_the_tests", "there is no test a_test_that_is_gone"]
        );
    }
}
