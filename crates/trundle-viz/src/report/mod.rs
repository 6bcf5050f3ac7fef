//! Reports: one HTML page with its figures and tables, without scripts or external files.

mod block;
mod card;
mod figure;
mod table;

pub use card::{Card, Verdict};
pub use figure::Figure;
pub use table::Table;

use crate::html::escape;
use block::Section;

/// A report: one self-contained HTML page. The page fetches nothing and runs no script; its content security policy forbids both. It
/// follows the reader's light or dark scheme, prints, and enlarges a figure on a click.
///
/// All text is escaped. Equal content gives equal bytes: the page has no date and no random name.
///
/// ```
/// use trundle_viz::{Card, Report, Table, Verdict};
/// let html = Report::new("A drive")
///     .verdict(Verdict::Ok("The robot reached its goal and touched nothing.".into()))
///     .card(Card::new("goal error", "1.8").unit("cm").remark("limit 5 cm").good(true))
///     .section("Numbers", "")
///     .table(Table::new("Goal", ["what", "value"]).row(["error", "1.8 cm"]))
///     .to_html();
/// assert!(html.starts_with("<!DOCTYPE html>"));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    title: String,
    subtitle: String,
    links: Vec<(String, String)>,
    verdict: Option<Verdict>,
    cards: Vec<Card>,
    sections: Vec<Section>,
}

impl Report {
    /// An empty report.
    pub fn new(title: &str) -> Self {
        let (title, subtitle) = (title.to_owned(), String::new());
        Self { title, subtitle, links: Vec::new(), verdict: None, cards: Vec::new(), sections: Vec::new() }
    }

    /// One or two sentences below the title: the command and its input.
    pub fn subtitle(self, subtitle: &str) -> Self {
        Self { subtitle: subtitle.to_owned(), ..self }
    }

    /// Adds a link to another file of the page's folder, below the subtitle.
    pub fn link(mut self, text: &str, file: &str) -> Self {
        self.links.push((text.to_owned(), file.to_owned()));
        self
    }

    /// The banner with the outcome.
    pub fn verdict(self, verdict: Verdict) -> Self {
        Self { verdict: Some(verdict), ..self }
    }

    /// Adds a key number to the row below the banner.
    pub fn card(mut self, card: Card) -> Self {
        self.cards.push(card);
        self
    }

    /// Opens a section; later additions belong to it. The introduction may be empty.
    pub fn section(mut self, title: &str, intro: &str) -> Self {
        self.sections.push(Section::new(title, intro));
        self
    }

    /// Adds a figure to the open section.
    pub fn figure(self, figure: Figure) -> Self {
        self.block(figure.to_html(), false)
    }

    /// Adds a table to the open section, whose blocks then fill two columns one after the other.
    pub fn table(self, table: Table) -> Self {
        self.block(table.to_html(), true)
    }

    /// Adds a block to the open section, or to one without a title.
    fn block(mut self, html: String, table: bool) -> Self {
        if self.sections.is_empty() {
            self.sections.push(Section::new("", ""));
        }
        if let Some(section) = self.sections.last_mut() {
            section.blocks.push(html);
            section.columns |= table;
        }
        self
    }

    /// The page.
    pub fn to_html(&self) -> String {
        const POLICY: &str = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'";
        let title = escape(&self.title);
        let subtitle = if self.subtitle.is_empty() {
            String::new()
        } else {
            format!("<p class=\"subtitle\">{}</p>", escape(&self.subtitle))
        };
        let link =
            |(text, file): &(String, String)| format!("<a href=\"./{}\">{}</a>", escape(file), escape(text));
        let links: String = self.links.iter().map(link).collect();
        let links = if links.is_empty() { links } else { format!("<nav>{links}</nav>") };
        let verdict = self.verdict.as_ref().map(Verdict::to_html).unwrap_or_default();
        let cards: String = self.cards.iter().map(Card::to_html).collect();
        let cards = if cards.is_empty() { cards } else { format!("<div class=\"cards\">{cards}</div>") };
        let sections: String = self.sections.iter().map(Section::to_html).collect();
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
             <title>{title}</title>\n<style>\n{style}</style>\n</head>\n<body>\n\
             <header><h1>{title}</h1>{subtitle}{links}{verdict}{cards}</header>\n<main>\n{sections}</main>\n\
             <footer>Made by trundle. Lengths in metres unless said otherwise; click a figure to enlarge it.</footer>\n\
             </body>\n</html>\n",
            style = include_str!("style.css"),
        )
    }
}

#[cfg(test)]
mod tests;
