//! Prose that can be read once: every file states its content, sentences are short, and words are about the product.

use super::finding::{Finding, Rule};
use super::tree::{File, Tree};

/// Words in a sentence of documents and doc comments. Source: ours.
const MAX_WORDS: usize = 40;

/// Words about the work on the project instead of the product. Written in halves, which keeps this file clean.
const PROCESS_WORDS: [&str; 6] = [
    concat!("fresh ", "eyes"),
    concat!("this ", "session"),
    concat!("last ", "session"),
    concat!("(iss", "ue "),
    concat!("session ", "of 20"),
    concat!("closing ", "note"),
];

/// Checks all sources and documents.
pub fn check(tree: &Tree) -> Vec<Finding> {
    let prose = tree.files.iter().filter(|f| f.path.ends_with(".rs") || f.path.ends_with(".md"));
    prose.flat_map(|file| [check_head(file), check_sentences(file), check_process(file)].concat()).collect()
}

/// Every source file begins with `//!`.
fn check_head(file: &File) -> Vec<Finding> {
    if file.path.ends_with(".rs") && !file.text.starts_with("//!") {
        let message = "a file begins by saying what it holds (`//!`)";
        return vec![Finding::ruled(Rule::FileDoc, &file.path, 1, message)];
    }
    Vec::new()
}

fn check_process(file: &File) -> Vec<Finding> {
    let lines = file.text.lines().enumerate();
    let found = lines.filter_map(|(i, line)| {
        let lower = line.to_lowercase();
        let word = PROCESS_WORDS.iter().find(|word| lower.contains(**word))?;
        let message = format!("'{word}' is about how the project is worked on, not about the product");
        Some(Finding::ruled(Rule::ProcessWord, &file.path, i + 1, message))
    });
    found.collect()
}

fn check_sentences(file: &File) -> Vec<Finding> {
    let paragraphs =
        if file.path.ends_with(".rs") { doc_paragraphs(&file.text) } else { markdown_paragraphs(&file.text) };
    let long = |(line, text): (usize, String)| {
        let words = longest_sentence(&text);
        let message = format!("a sentence of {words} words, {MAX_WORDS} at most: one fact a sentence");
        (words > MAX_WORDS).then(|| Finding::ruled(Rule::LongSentence, &file.path, line, message))
    };
    paragraphs.into_iter().filter_map(long).collect()
}

/// Paragraphs of doc comments with their first lines.
fn doc_paragraphs(text: &str) -> Vec<(usize, String)> {
    let doc = |line: &str| {
        let line = line.trim_start();
        line.strip_prefix("//!").or_else(|| line.strip_prefix("///")).map(str::to_owned).unwrap_or_default()
    };
    markdown_paragraphs(&text.lines().map(doc).collect::<Vec<_>>().join("\n"))
}

/// Paragraphs of Markdown with their first lines, without headings, code blocks and tables.
fn markdown_paragraphs(text: &str) -> Vec<(usize, String)> {
    let mut paragraphs: Vec<(usize, String)> = Vec::new();
    let (mut is_open, mut fenced) = (false, false);
    for (i, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.starts_with("```") {
            fenced = !fenced;
        }
        let is_item =
            line.starts_with("- ") || line.split_once(". ").is_some_and(|(n, _)| n.parse::<u8>().is_ok());
        let is_text = !fenced && !line.is_empty() && !line.starts_with(['#', '|', '`']);
        match paragraphs.last_mut().filter(|_| is_open && is_text && !is_item) {
            Some((_, paragraph)) => {
                paragraph.push(' ');
                paragraph.push_str(line);
            }
            None if is_text => paragraphs.push((i + 1, line.to_owned())),
            None => {}
        }
        is_open = is_text;
    }
    paragraphs
}

/// The number of words of the longest sentence.
fn longest_sentence(text: &str) -> usize {
    let (mut longest, mut words) = (0, 0);
    for word in text.split_whitespace() {
        words += usize::from(word.contains(char::is_alphanumeric));
        longest = longest.max(words);
        if word.trim_end_matches([')', '*', '_', '"', ']', '`']).ends_with(['.', ':', ';', '?', '!']) {
            words = 0;
        }
    }
    longest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tidy::tree::tests::tree;

    fn found(path: &str, text: &str) -> Vec<String> {
        check(&tree(&[(path, text)])).iter().map(Finding::to_string).collect()
    }

    #[test]
    fn long_sentences_are_found_in_docs_and_doc_comments() {
        let long = "word ".repeat(41);
        let two = format!("{}. {}.", "word ".repeat(20), "word ".repeat(20));
        assert!(found("a.md", &format!("# T\n\n{long}."))[0].starts_with("a.md:3: a sentence of 41 words"));
        assert!(found("a.md", &two).is_empty());
        assert!(found("a.md", &format!("| {long} |\n```\n{long}\n```\n")).is_empty());
        assert_eq!(found("x/src/a.rs", &format!("//! A.\n\n/// {long}\nfn f() {{}}\n// {long}\n")).len(), 1);
    }

    #[test]
    fn files_say_what_they_hold_and_nothing_of_the_work() {
        assert!(found("x/src/a.rs", "use a;\n")[0].contains("begins by saying"));
        assert!(found("x/tests/it/a.rs", "use a;\n")[0].contains("begins by saying"));
        let text = format!("It was found by {}.\n", PROCESS_WORDS[0]);
        assert!(found("a.md", &text)[0].contains("about how the project is worked on"));
    }
}
