//! Sections of a report.

use crate::html::escape;

/// A part of a report: a title, an introduction, and blocks of HTML that is safe already.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Section {
    title: String,
    intro: String,
    pub blocks: Vec<String>,
    /// Whether blocks of different heights fill two columns one after the other, instead of pairing up row by row.
    pub columns: bool,
}

impl Section {
    pub(super) fn new(title: &str, intro: &str) -> Self {
        Self { title: title.to_owned(), intro: intro.to_owned(), blocks: Vec::new(), columns: false }
    }

    pub(super) fn to_html(&self) -> String {
        let part = |tag: &str, end: &str, text: &str| {
            if text.is_empty() { String::new() } else { format!("{tag}{}{end}\n", escape(text)) }
        };
        format!(
            "<section>\n{}{}<div class=\"{}\">\n{}</div>\n</section>\n",
            part("<h2>", "</h2>", &self.title),
            part("<p class=\"intro\">", "</p>", &self.intro),
            if self.columns { "columns" } else { "blocks" },
            self.blocks.concat(),
        )
    }
}
