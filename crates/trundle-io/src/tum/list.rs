//! Parser of the image lists `rgb.txt` and `depth.txt` of a TUM folder.

use crate::IoError;
use crate::excerpt::excerpt;
use crate::files::content_lines;
use std::path::{Path, PathBuf};
use trundle_core::Stamp;

/// One line of `rgb.txt` or `depth.txt`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ListedImage {
    pub stamp: Stamp,
    /// Relative to the folder of the list.
    pub file: PathBuf,
    /// The line of the list, from 1.
    pub line: usize,
}

/// The images of a list: lines of `timestamp filename`, stamps rising, `#` for comments. A line that repeats the one
/// before is skipped: published sequences have such.
pub(super) fn parse_list(path: &Path, text: &str) -> Result<Vec<ListedImage>, IoError> {
    let mut images: Vec<ListedImage> = Vec::new();
    for (line, content) in content_lines(text) {
        let image = parse_line(content, line).map_err(|problem| IoError::line(path, line, problem))?;
        let before = images.last();
        if before.is_some_and(|before| (before.stamp, &before.file) == (image.stamp, &image.file)) {
            continue;
        }
        if let Some(before) = before.filter(|before| image.stamp <= before.stamp) {
            let how = if image.stamp == before.stamp { "is the same" } else { "goes back" };
            let problem = format!(
                "timestamp {how}: {} s after {} s of line {}",
                image.stamp, before.stamp, before.line
            );
            return Err(IoError::line(path, line, problem));
        }
        images.push(image);
    }
    if images.is_empty() {
        return Err(IoError::malformed(path, "no image in it, expected lines of: timestamp filename"));
    }
    Ok(images)
}

fn parse_line(content: &str, line: usize) -> Result<ListedImage, String> {
    let (stamp, file) = content
        .split_once(|c: char| c.is_whitespace() || c == ',')
        .ok_or_else(|| format!("'{}', expected: timestamp filename", excerpt(content)))?;
    let stamp = crate::parse_stamp(stamp).map_err(|invalid| invalid.to_string())?;
    let file = PathBuf::from(file.trim_start_matches([',', ' ', '\t']));
    Ok(ListedImage { stamp, file, line })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn problem(text: &str) -> String {
        parse_list(Path::new("rgb.txt"), text).unwrap_err().to_string()
    }

    #[test]
    fn reads_names_with_blanks_and_numbers_the_lines() {
        let list = parse_list(Path::new("rgb.txt"), "# color images\n1.25 rgb/a b.png\n2 c.jpg\n").unwrap();
        assert_eq!(
            list[0],
            ListedImage { stamp: Stamp::from_nanos(1_250_000_000), file: "rgb/a b.png".into(), line: 2 }
        );
        assert_eq!(list[1].line, 3);
    }

    #[test]
    fn stamps_must_rise() {
        assert_eq!(
            problem("2 a.png\n1.5 b.png"),
            "rgb.txt, line 2: timestamp goes back: 1.500000000 s after 2.000000000 s of line 1"
        );
        assert_eq!(parse_list(Path::new("rgb.txt"), "2 a.png\n2.0 a.png\n3 b.png").unwrap().len(), 2);
        assert!(problem("2 a.png\n\n2.0 b.png").contains("line 3: timestamp is the same: 2.000000000 s"));
        assert_eq!(problem("1.5"), "rgb.txt, line 1: '1.5', expected: timestamp filename");
        assert!(problem("#\n").starts_with("rgb.txt: no image"));
        assert!(problem("one a.png").contains("timestamp is 'one'"));
    }

    proptest! {
        #[test]
        fn any_text_is_no_panic(text in "[0-9 .,#ae/\n]{0,100}") {
            let _ = parse_list(Path::new("rgb.txt"), &text);
        }
    }
}
