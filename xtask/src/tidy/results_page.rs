//! The page of results is generated from `results/*.json` and not edited by hand.

use super::finding::Finding;
use crate::results::{PAGE, render};
use std::path::Path;

/// Compares the page with the one that the measurements give.
pub fn check(root: &Path) -> Vec<Finding> {
    let page = std::fs::read_to_string(root.join(PAGE)).unwrap_or_default();
    match render(root) {
        Err(error) => vec![Finding::error(PAGE, 1, error)],
        Ok(text) => difference(&page, &text).into_iter().collect(),
    }
}

/// The first line in which the page differs from the generated text.
fn difference(page: &str, text: &str) -> Option<Finding> {
    let equal = page.lines().zip(text.lines()).take_while(|(old, new)| old == new).count();
    let message =
        "the page is not what results/*.json gives: change the measurement, then cargo xtask results";
    (page != text).then(|| Finding::error(PAGE, equal + 1, message))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edited_line_is_found() {
        assert_eq!(difference("a\nb\n", "a\nb\n"), None);
        assert_eq!(difference("a\nedited\n", "a\nb\n").unwrap().line, 2);
        assert_eq!(difference("a\n", "a\nb\n").unwrap().line, 2);
    }

    #[test]
    fn the_page_of_the_workspace_is_generated() {
        assert_eq!(check(&crate::workspace::root()), []);
        assert!(!check(Path::new("no-such-folder")).is_empty());
    }
}
