//! Sources of constants: the documentation of a number names the source of its value.
//!
//! A number whose value is made of literals has a choice or a measurement in it. Four kinds need no source of their own: an expression of
//! other constants, a whole number that describes the place or form of stored data, a table of whole numbers, and a constant that shares the
//! documentation of the line above.

use super::constants::{NUMBERS, declared};
use super::finding::{Finding, Rule};
use super::source::identifiers;
use super::tree::Tree;

/// Start of the sentence that names the source.
const MARK: &str = "Source: ";

/// Last words of names of whole numbers that say where or how something is stored.
const LAYOUT_WORDS: [&str; 16] = [
    "BIT", "BITS", "BYTES", "INDEX", "INDICES", "LANES", "MAGIC", "MARK", "MASK", "PLACE", "SHIFT", "SLOT",
    "STRIDE", "UNKNOWNS", "VALUE", "VERSION",
];

/// Words of names of limits: a limit is chosen, whatever it limits.
const LIMIT_WORDS: [&str; 3] = ["MAX", "MIN", "MOST"];

/// Checks the constants of every package, those of types and functions included.
pub fn check(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for package in &tree.packages {
        for source in
            tree.sources(package).filter(|source| !source.is_generated() && !is_test(&source.file.path))
        {
            let found = |(line, name)| {
                let message = format!("constant {name} has no source: write `{MARK}KEY, document or ours.`");
                Finding::ruled(Rule::ConstantSource, &source.file.path, line, message)
            };
            findings.extend(without_source(source.code.text(), &source.file.text).into_iter().map(found));
        }
    }
    findings
}

/// Whether a file has tests alone.
fn is_test(path: &str) -> bool {
    path.ends_with("/tests.rs") || path.contains("/tests/") || path.ends_with("/testing.rs")
}

/// Line and name of each documented constant that needs a source and has none.
fn without_source(code: &str, text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    let mut doc = String::new();
    let mut start = 0;
    for (i, (line, whole)) in code.split_inclusive('\n').zip(text.lines()).enumerate() {
        if let Some((name, kind)) = declared(line.trim()) {
            let value = value(&code[start..]);
            if !doc.is_empty() && !doc.contains(MARK) && needs_source(name, kind, value) {
                found.push((i + 1, name.to_owned()));
            }
        }
        start += line.len();
        match whole.trim_start().strip_prefix("///") {
            Some(more) => doc.push_str(more),
            None if whole.trim_start().starts_with("#[") => {}
            None => doc.clear(),
        }
    }
    found
}

/// The value of the constant with which `code` begins.
fn value(code: &str) -> &str {
    let (_, value) = code.split_once(" =").unwrap_or_default();
    let mut depth = 0;
    let end = value.find(|c| {
        depth += i32::from("[{(".contains(c)) - i32::from("]})".contains(c));
        c == ';' && depth == 0
    });
    &value[..end.unwrap_or(value.len())]
}

/// Whether a constant of this name, type and value needs a source.
fn needs_source(name: &str, kind: &str, value: &str) -> bool {
    let has_case = |word: &&str| word.contains(|c: char| c.is_ascii_lowercase());
    let mut types = identifiers(kind).filter(has_case).peekable();
    let is_number = types.peek().is_some() && types.all(|word| NUMBERS.contains(&word));
    let has_digits = identifiers(value).any(|word| word.starts_with(|c: char| c.is_ascii_digit()));
    is_number && has_digits && !is_derived(value) && !is_layout(name, kind)
}

/// Whether a value is an expression of other constants.
fn is_derived(value: &str) -> bool {
    let is_constant = |word: &str| {
        word.starts_with(|c: char| c.is_ascii_uppercase()) && !word.contains(|c: char| c.is_ascii_lowercase())
    };
    identifiers(value).any(is_constant)
}

/// Whether whole numbers are a table, or one describes the place or form of stored data.
fn is_layout(name: &str, kind: &str) -> bool {
    let is_whole = !identifiers(kind).any(|word| ["f64", "f32", "Duration"].contains(&word));
    let is_limit = name.split('_').any(|word| LIMIT_WORDS.contains(&word));
    let is_table = kind.starts_with(['[', '(', '&']);
    let has_word = name.rsplit('_').next().is_some_and(|word| LAYOUT_WORDS.contains(&word));
    is_whole && !is_limit && (is_table || has_word)
}

#[cfg(test)]
mod tests {
    use super::{needs_source, without_source};

    #[test]
    fn a_documented_number_without_a_source_is_found() {
        let code = "/// Gap [m].\nconst GAP_M: f64 = 0.1;\nconst STEP_M: f64 = 0.2;\n\
            /// Gap [m]. Source: ours.\n#[allow(dead_code)]\nconst FAR_GAP_M: f64 = 1.0;\n\
            /// Sum.\nconst fn sum(a: f64) -> f64 { a + 1.0 }\n\
            struct A;\nimpl A {\n    /// Rounds of the search.\n    pub const SEARCH_ROUNDS: usize = 3;\n}\n";
        assert_eq!(without_source(code, code), [(2, "GAP_M".to_owned()), (12, "SEARCH_ROUNDS".to_owned())]);
    }

    #[test]
    fn rows_and_durations_are_numbers_on_any_number_of_lines() {
        let code = "/// Corners [m].\nconst CORNERS_M: [[f64; 2]; 2] = [\n    [0.0, 1.0],\n    [2.0, 3.0],\n];\n\
            /// Wait.\nconst FIRST_WAIT: Duration = Duration::from_secs(1);\n\
            /// Texts.\nconst TEXTS: [&str; 2] = [\"1\", \"2\"];\n";
        let lines: Vec<usize> = without_source(code, code).into_iter().map(|(line, _)| line).collect();
        assert_eq!(lines, [2, 7]);
    }

    #[test]
    fn derived_values_and_layouts_need_none() {
        assert!(needs_source("SETTLING_RATIO", "f64", " 2.0"));
        assert!(needs_source("RANGE_M", "(f64, f64)", " (0.7, 1.6)"));
        assert!(needs_source("MAX_REPLY_BYTES", "usize", " 1152"));
        assert!(!needs_source("HEAD_BYTES", "usize", " 12"));
        assert!(!needs_source("RUN_S", "f64", " 2.0 * SETTLING_S"));
        assert!(!needs_source("FOREVER_S", "f64", " f64::INFINITY"));
        assert!(!needs_source("CELL_CORNERS", "[(i32, i32); 2]", " [(0, 0), (1, 1)]"));
        assert!(needs_source("SHARE_INDEX", "f64", " 0.5"), "no place is a fraction");
        assert!(!needs_source("KINDS", "&[(&[u8], FileKind)]", " &[(1, FileKind::A)]"));
    }
}
