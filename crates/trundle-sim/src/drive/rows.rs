//! Parser of text files with a fixed number of columns.

use trundle_core::Invalid;

/// Lines of `N` finite numbers between blanks, each with its line number from 1; `#` starts a comment, empty lines do not
/// count.
///
/// # Errors
/// When a line has a wrong number of columns or a column is not a finite number; the error names the line and the column.
pub(super) fn rows<const N: usize>(
    text: &str,
    columns: [&str; N],
) -> Result<Vec<(usize, [f64; N])>, Invalid> {
    let mut rows = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default();
        let words: Vec<&str> = line.split_whitespace().collect();
        if words.is_empty() {
            continue;
        }
        if words.len() != N {
            let expected = format!("{N} numbers: {}", columns.join(" "));
            return Err(Invalid::new(format!("line {}", i + 1), format!("'{}'", line.trim()), "", expected));
        }
        let mut row = [0.0; N];
        for ((number, word), name) in row.iter_mut().zip(words).zip(columns) {
            let refused = || Invalid::new(format!("{name} in line {}", i + 1), word, "", "a finite number");
            *number = word.parse::<f64>().ok().filter(|x| x.is_finite()).ok_or_else(refused)?;
        }
        rows.push((i + 1, row));
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_empty_lines_do_not_count_but_lines_keep_their_number() {
        let text = "# t v\n\n 1 2.5 # fast\n3\t-4e-1\r\n";
        assert_eq!(rows(text, ["t", "v"]).unwrap(), vec![(3, [1.0, 2.5]), (4, [3.0, -0.4])]);
    }

    #[test]
    fn a_field_that_is_not_a_number_is_named() {
        let error = |text: &str| rows(text, ["t", "v"]).unwrap_err().to_string();
        assert_eq!(error("1 2\n3 fast"), "v in line 2 is fast, expected a finite number");
        assert_eq!(error("1 NaN"), "v in line 1 is NaN, expected a finite number");
        assert_eq!(error("\n1 2 3"), "line 2 is '1 2 3', expected 2 numbers: t v");
    }
}
