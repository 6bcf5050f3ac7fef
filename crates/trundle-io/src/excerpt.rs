//! Short, printable excerpts of a file's text, for messages.

/// The text for a message: its first 40 characters, without unprintable ones.
pub(crate) fn excerpt(text: &str) -> String {
    let short: String = text.chars().take(40).map(|c| if c.is_control() { '?' } else { c }).collect();
    if short.len() < text.len() { format!("{short}...") } else { short }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_excerpt_is_short_and_printable() {
        assert_eq!(excerpt("abc"), "abc");
        assert_eq!(excerpt("a\u{7}b"), "a?b");
        let long = "x".repeat(60);
        assert_eq!(excerpt(&long), format!("{}...", "x".repeat(40)));
    }
}
