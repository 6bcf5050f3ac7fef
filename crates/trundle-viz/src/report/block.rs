use crate::html::escape;

/// A part of a report: a title, an introduction, and blocks of HTML that is safe already.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Section {
    title: String,
    intro: String,
    pub blocks: Vec<String>,
}

impl Section {
    pub(super) fn new(title: &str, intro: &str) -> Self {
        Self { title: title.to_owned(), intro: intro.to_owned(), blocks: Vec::new() }
    }

    pub(super) fn to_html(&self) -> String {
        let part = |tag: &str, end: &str, text: &str| {
            if text.is_empty() { String::new() } else { format!("{tag}{}{end}\n", escape(text)) }
        };
        format!(
            "<section>\n{}{}<div class=\"blocks\">\n{}</div>\n</section>\n",
            part("<h2>", "</h2>", &self.title),
            part("<p class=\"intro\">", "</p>", &self.intro),
            self.blocks.concat(),
        )
    }
}
