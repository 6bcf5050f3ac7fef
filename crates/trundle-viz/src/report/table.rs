//! Tables of a report.

use crate::html::escape;

/// A table of texts. A column whose cells all begin as numbers do is set flush right.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Table {
    title: String,
    header: Vec<String>,
    rows: Vec<Vec<String>>,
    wide: bool,
    is_folded: bool,
}

/// Number of rows up to which a folded table is open when the page is loaded. Source: ours, about a third of a screen.
const MAX_OPEN_ROWS: usize = 12;

impl Table {
    /// A table without rows. A table of up to four columns has half the page's width.
    pub fn new<T: Into<String>>(title: &str, header: impl IntoIterator<Item = T>) -> Self {
        let header: Vec<String> = header.into_iter().map(Into::into).collect();
        let wide = header.len() > 4;
        Self { title: title.to_owned(), header, rows: Vec::new(), wide, is_folded: false }
    }

    /// Adds a row. Cells beyond the header are preserved, missing ones remain empty.
    pub fn row<T: Into<String>>(mut self, cells: impl IntoIterator<Item = T>) -> Self {
        self.rows.push(cells.into_iter().map(Into::into).collect());
        self
    }

    /// Makes the table as wide as the page.
    pub fn wide(self) -> Self {
        Self { wide: true, ..self }
    }

    /// Makes the table fold up below its title, and scroll within a box: for tables of hundreds of rows. A short one is open at first.
    pub fn folded(self) -> Self {
        Self { is_folded: true, ..self }
    }

    pub(super) fn to_html(&self) -> String {
        let wide = if self.wide { " wide" } else { "" };
        let (title, table) = (escape(&self.title), self.table());
        if self.is_folded {
            let open = if self.rows.len() <= MAX_OPEN_ROWS { " open" } else { "" };
            return format!(
                "<details class=\"table{wide}\"{open}><summary><h3>{title}</h3></summary>\
                 <div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{title}\">{table}</div></details>\n"
            );
        }
        format!("<div class=\"table{wide}\"><h3>{title}</h3>{table}</div>\n")
    }

    /// The `<table>` element.
    fn table(&self) -> String {
        let columns = self.rows.iter().map(Vec::len).chain([self.header.len()]).max().unwrap_or(0);
        let numeric: Vec<bool> = (0..columns).map(|column| self.is_numeric(column)).collect();
        let line = |cells: &[String], tag: &str| {
            let cell = |(column, right): (usize, &bool)| {
                let class = if *right { " class=\"num\"" } else { "" };
                format!("<{tag}{class}>{}</{tag}>", escape(cells.get(column).map_or("", String::as_str)))
            };
            format!("<tr>{}</tr>", numeric.iter().enumerate().map(cell).collect::<String>())
        };
        let body: String = self.rows.iter().map(|row| line(row, "td")).collect();
        format!("<table><thead>{}</thead><tbody>{body}</tbody></table>", line(&self.header, "th"))
    }

    fn is_numeric(&self, column: usize) -> bool {
        let mut cells =
            self.rows.iter().filter_map(|row| row.get(column)).filter(|cell| !cell.is_empty()).peekable();
        let number =
            |cell: &String| cell.split_whitespace().next().is_some_and(|word| word.parse::<f64>().is_ok());
        cells.peek().is_some() && cells.all(number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_right_and_ragged_rows_are_filled() {
        let html =
            Table::new("t", ["name", "value"]).row(["a", "1.5 cm"]).row(["b", "-2"]).row(["c"]).to_html();
        assert!(html.contains("<td>a</td><td class=\"num\">1.5 cm</td>"), "{html}");
        assert!(html.contains("<td>c</td><td class=\"num\"></td>"));
        assert!(Table::new::<String>("", []).to_html().contains("<tr></tr>"));
    }

    #[test]
    fn a_long_table_is_folded_and_a_short_one_is_open() {
        let table = |rows| {
            let table = Table::new("a & b", ["name"]).folded().wide();
            (0..rows).fold(table, |table, row| table.row([row.to_string()])).to_html()
        };
        assert!(
            table(MAX_OPEN_ROWS).starts_with("<details class=\"table wide\" open><summary><h3>a &amp; b")
        );
        let long = table(300);
        assert!(long.starts_with("<details class=\"table wide\"><summary>"), "{long}");
        assert_eq!((long.matches("<tr>").count(), long.matches("tabindex=\"0\"").count()), (301, 1));
        assert!(long.ends_with("</table></div></details>\n"));
    }
}
