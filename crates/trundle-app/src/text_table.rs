//! Tables as lines of text.

/// Width above which a column counts as text, not numbers \[characters\]. Source: ours.
const MIN_TEXT_WIDTH: usize = 60;

/// The lines of a table of two columns or more, columns aligned: the first one and texts to the left, numbers to the right.
#[must_use]
pub fn aligned_table(rows: &[Vec<String>]) -> Vec<String> {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |c: usize| {
        rows.iter().filter_map(|row| row.get(c)).map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let cell = |(c, (cell, &w)): (usize, (&String, &usize))| {
        if c == 0 || w >= MIN_TEXT_WIDTH { format!("{cell:<w$}") } else { format!("{cell:>w$}") }
    };
    let line =
        |row: &Vec<String>| row.iter().zip(&widths).enumerate().map(cell).collect::<Vec<_>>().join("  ");
    rows.iter().map(|row| format!("  {}", line(row)).trim_end().to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_to_the_right_and_texts_to_the_left() {
        let table = |rows: &[[&str; 2]]| {
            aligned_table(&rows.iter().map(|row| row.map(str::to_owned).to_vec()).collect::<Vec<_>>())
        };
        assert_eq!(
            table(&[["time", "9.5 s"], ["contacts", "0"]]),
            ["  time      9.5 s", "  contacts      0"]
        );
        let long = "x".repeat(60);
        assert_eq!(table(&[["base", "none"], ["camera", &long]])[0], "  base    none");
    }
}
