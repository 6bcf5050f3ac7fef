//! Escaping of text and colours for HTML.

use crate::color::Color;

/// Text made safe between tags and within double quotes. Control characters that HTML forbids become a replacement sign.
pub(crate) fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            '\n' | '\t' => safe.push(character),
            c if c.is_control() => safe.push('\u{fffd}'),
            c => safe.push(c),
        }
    }
    safe
}

/// A colour of the palette as CSS that a dark scheme may lighten; any other colour unchanged.
pub(crate) fn ink(color: Color) -> String {
    let names = [
        ("blue", Color::BLUE),
        ("green", Color::GREEN),
        ("vermillion", Color::VERMILLION),
        ("purple", Color::PURPLE),
        ("black", Color::BLACK),
        ("yellow", Color::YELLOW),
    ];
    match names.iter().find(|(_, known)| *known == color) {
        Some((name, _)) => format!("var(--{name},{})", color.css()),
        None => color.css(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_dangerous_survives() {
        assert_eq!(
            escape("<a href='x' b=\"y\">&\u{1}é"),
            "&lt;a href=&#39;x&#39; b=&quot;y&quot;&gt;&amp;\u{fffd}é"
        );
        assert_eq!(ink(Color::BLUE), "var(--blue,#0072b2)");
        assert_eq!(ink(Color::SKY), "#56b4e9");
    }
}
