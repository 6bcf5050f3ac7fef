//! Parser of the image lists `rgb.txt`, `depth.txt` and `associations.txt` of a TUM folder.

use super::rows::sort;
use crate::excerpt::excerpt;
use crate::files::{is_decimal_comma, table_rows};
use crate::stamp_unit::StampUnit;
use crate::{IoError, Warnings};
use std::path::{Path, PathBuf};
use trundle_core::Stamp;

/// An image of a list.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ListedImage {
    pub stamp: Stamp,
    /// Relative to the folder of the list.
    pub file: PathBuf,
}

/// The images of a list by rising stamp: lines of `timestamp filename`, `#` for comments. A repeated line is skipped, as in some published
/// sequences. Of several images with one stamp, the first is used.
pub(super) fn parse_list(
    path: &Path,
    text: &str,
    warnings: &mut Warnings,
) -> Result<Vec<ListedImage>, IoError> {
    let mut rows = Vec::new();
    for (line, content) in table_rows(text) {
        rows.push(
            with_decimal_points(content)
                .and_then(one_image)
                .map_err(|problem| IoError::line(path, line, problem))?,
        );
    }
    if rows.is_empty() {
        return Err(IoError::malformed(path, "no image in it, expected lines of: timestamp filename"));
    }
    let unit = unit(rows.iter().map(|(stamp, _)| *stamp), path, warnings);
    let lines = table_rows(text);
    let mut images = Vec::with_capacity(rows.len());
    for ((stamp, file), (line, _)) in rows.into_iter().zip(lines) {
        let stamp = unit.parse(stamp).map_err(|invalid| IoError::line(path, line, invalid.to_string()))?;
        images.push((stamp, PathBuf::from(file)));
    }
    sort(&mut images, path, warnings);
    let images = images.into_iter().map(|(stamp, file)| ListedImage { stamp, file }).collect();
    Ok(without_repetitions(images, path, warnings))
}

/// The pairs of `associations.txt`: lines of `timestamp filename timestamp filename`, in the order of the columns, by rising
/// first stamp.
pub(super) fn parse_pairs(
    path: &Path,
    text: &str,
    warnings: &mut Warnings,
) -> Result<Vec<(ListedImage, ListedImage)>, IoError> {
    let lines = table_rows(text);
    let mut rows = Vec::with_capacity(lines.len());
    for (line, content) in &lines {
        rows.push(
            with_decimal_points(content)
                .and_then(two_images)
                .map_err(|problem| IoError::line(path, *line, problem))?,
        );
    }
    let unit = unit(rows.iter().map(|[stamp, ..]| *stamp), path, warnings);
    let mut pairs = Vec::with_capacity(rows.len());
    for ([first_stamp, first, second_stamp, second], (line, _)) in rows.into_iter().zip(lines) {
        let image = |stamp, file: &str| {
            let stamp =
                unit.parse(stamp).map_err(|invalid| IoError::line(path, line, invalid.to_string()))?;
            Ok(ListedImage { stamp, file: PathBuf::from(file) })
        };
        let first = image(first_stamp, first)?;
        pairs.push((first.stamp, (first, image(second_stamp, second)?)));
    }
    sort(&mut pairs, path, warnings);
    let pairs: Vec<_> = pairs.into_iter().map(|(_, pair)| pair).collect();
    if pairs.is_empty() {
        let expected = "no pair of images in it, expected lines of: timestamp filename timestamp filename";
        return Err(IoError::malformed(path, expected));
    }
    Ok(pairs)
}

fn unit<'a>(stamps: impl Iterator<Item = &'a str>, path: &Path, warnings: &mut Warnings) -> StampUnit {
    let stamps: Vec<&str> = stamps.collect();
    let unit = StampUnit::of(&stamps);
    if let Some(problem) = unit.warning(stamps.first().unwrap_or(&"")) {
        warnings.add(&problem, &path.display().to_string());
    }
    unit
}

fn without_repetitions(images: Vec<ListedImage>, path: &Path, warnings: &mut Warnings) -> Vec<ListedImage> {
    let mut kept: Vec<ListedImage> = Vec::with_capacity(images.len());
    for image in images {
        match kept.last() {
            Some(before) if before.stamp == image.stamp => {
                if before.file != image.file {
                    let place = format!("{} of {}", image.file.display(), path.display());
                    warnings.add("a further image of one timestamp is left out", &place);
                }
            }
            _ => kept.push(image),
        }
    }
    kept
}

/// A line, unless a number of it has a decimal comma, which would end the stamp.
fn with_decimal_points(content: &str) -> Result<&str, String> {
    let is_separator = |c: char| c.is_whitespace() || c == ';';
    let mut words = content.split(is_separator).filter(|word| !word.starts_with(','));
    let found = words.find(|word| is_decimal_comma(word) && *word != content);
    found.map_or(Ok(content), |word| {
        Err(format!("'{}' has a decimal comma, expected a decimal point", excerpt(word)))
    })
}

/// The text of a stamp and the name of a file, which may hold blanks.
fn one_image(content: &str) -> Result<(&str, &str), String> {
    let separators = |c: char| c.is_whitespace() || c == ',';
    let (stamp, file) = content
        .split_once(separators)
        .ok_or_else(|| format!("'{}', expected: timestamp filename", excerpt(content)))?;
    crate::stamp_text::parse_scaled_stamp(stamp, 9).map_err(|invalid| invalid.to_string())?;
    Ok((stamp, file.trim_start_matches([',', ' ', '\t'])))
}

fn two_images(content: &str) -> Result<[&str; 4], String> {
    let parts: Vec<&str> = crate::files::fields(content).collect();
    <[&str; 4]>::try_from(parts)
        .map_err(|parts| format!("{} fields, expected 4: timestamp filename timestamp filename", parts.len()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn parse(text: &str) -> Result<(Vec<ListedImage>, String), String> {
        let mut warnings = Warnings::default();
        let list =
            parse_list(Path::new("rgb.txt"), text, &mut warnings).map_err(|error| error.to_string())?;
        Ok((list, warnings.iter().map(|warning| format!("{warning}\n")).collect()))
    }

    #[test]
    fn reads_names_with_blanks() {
        let (list, warnings) = parse("# color images\n1.25 rgb/a b.png\n2 c.jpg\n").unwrap();
        assert_eq!(
            list[0],
            ListedImage { stamp: Stamp::from_nanos(1_250_000_000), file: "rgb/a b.png".into() }
        );
        assert_eq!((list.len(), warnings.as_str()), (2, ""));
        assert_eq!(parse("timestamp filename\n1 a.png\n").unwrap().0.len(), 1);
    }

    #[test]
    fn lines_out_of_order_are_sorted_and_one_image_is_taken_of_a_stamp() {
        let (list, warnings) = parse("2 a.png\n1.5 b.png\n3 c.png").unwrap();
        assert_eq!(list.iter().map(|image| image.stamp.as_secs()).collect::<Vec<_>>(), [1.5, 2.0, 3.0]);
        assert_eq!(
            warnings,
            "rows with an earlier timestamp than the row before: 1 of 3; the rows are sorted: rgb.txt\n"
        );
        let (list, warnings) = parse("2 a.png\n2.0 a.png\n3 b.png").unwrap();
        assert_eq!((list.len(), warnings.as_str()), (2, ""));
        let (list, warnings) = parse("2 a.png\n\n2.0 b.png").unwrap();
        assert_eq!(list[0].file, Path::new("a.png"));
        assert_eq!(warnings, "a further image of one timestamp is left out: b.png of rgb.txt\n");
    }

    #[test]
    fn errors_name_the_line() {
        let problem = |text: &str| parse(text).unwrap_err();
        assert_eq!(problem("1.5"), "rgb.txt, line 1: '1.5', expected: timestamp filename");
        assert!(problem("#\n").starts_with("rgb.txt: no image"));
        assert!(problem("one a.png").contains("timestamp is 'one'"));
    }

    #[test]
    fn decimal_commas_are_named_and_commas_between_columns_are_not() {
        let problem = "line 1: '1305031102,17' has a decimal comma, expected a decimal point";
        for row in ["1305031102,17 a.png", "1305031102,17\ta.png", "1305031102,17;a.png"] {
            assert_eq!(parse(row).unwrap_err(), format!("rgb.txt, {problem}"));
        }
        let pairs = |text: &str| {
            let pairs = parse_pairs(Path::new("associations.txt"), text, &mut Warnings::default());
            pairs.map(|pairs| pairs.len()).map_err(|error| error.to_string())
        };
        let row = "1305031102,17 a.png 1305031102,18 b.png";
        assert_eq!(pairs(row).unwrap_err(), format!("associations.txt, {problem}"));
        assert_eq!(pairs("1.5,a.png,1.5,b.png\n2, a.png, 2, b.png"), Ok(2));
        assert_eq!(parse("1.5,a.png\n2, b.png\n1403636579,1403636580.png").unwrap().0.len(), 3);
    }

    #[test]
    fn nanoseconds_are_taken_as_such_with_one_warning() {
        let (list, warnings) = parse("1700000000000000000 a.jpg\n1700000000100000000 b.jpg\n").unwrap();
        assert_eq!(list[1].stamp.to_string(), "1700000000.100000000");
        assert_eq!(
            warnings,
            "timestamps as 1700000000000000000 are taken as nanoseconds, expected seconds: rgb.txt\n"
        );
    }

    proptest! {
        #[test]
        fn any_text_does_not_panic(text in "[0-9 .,#ae/\n]{0,100}") {
            let _ = parse(&text);
            let _ = parse_pairs(Path::new("associations.txt"), &text, &mut Warnings::default());
        }
    }
}
