//! Figures of a report: a picture or a chart with legend and caption.

use crate::chart::{BarChart, Chart};
use crate::color::Color;
use crate::html::escape;
use crate::legend::{LegendItem, Mark};
use base64::{Engine, engine::general_purpose::STANDARD};

/// A picture or a chart with a title, a legend and a caption.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    title: String,
    /// An element that is safe already.
    body: String,
    caption: String,
    legend: Vec<LegendItem>,
    wide: bool,
}

impl Figure {
    /// A figure from the bytes of a PNG, which the page carries within it.
    pub fn png(title: &str, bytes: &[u8]) -> Self {
        let size = match png_size(bytes) {
            Some((width, height)) => format!(" width=\"{width}\" height=\"{height}\""),
            None => String::new(),
        };
        let (alt, data) = (escape(title), STANDARD.encode(bytes));
        Self::new(title, format!("<img alt=\"{alt}\"{size} src=\"data:image/png;base64,{data}\">"))
    }

    /// A figure from a chart, whose title it takes.
    pub fn chart(chart: &Chart) -> Self {
        Self::new(&chart.title, chart.to_svg())
    }

    /// A figure from a bar chart, whose title it takes.
    pub fn bars(chart: &BarChart) -> Self {
        Self::new(&chart.title, chart.to_svg())
    }

    fn new(title: &str, body: String) -> Self {
        Self { title: title.to_owned(), body, caption: String::new(), legend: Vec::new(), wide: false }
    }

    /// Text below the figure.
    pub fn caption(self, caption: &str) -> Self {
        Self { caption: caption.to_owned(), ..self }
    }

    /// Meanings of the colours, for a picture without its own legend.
    pub fn legend(self, items: Vec<LegendItem>) -> Self {
        Self { legend: items, ..self }
    }

    /// Makes the figure as wide as the page instead of half as wide.
    pub fn wide(self) -> Self {
        Self { wide: true, ..self }
    }

    pub(super) fn to_html(&self) -> String {
        let title = escape(&self.title);
        let caption = match self.caption.as_str() {
            "" => String::new(),
            text => format!("<p>{}</p>", escape(text)),
        };
        let items: String = self.legend.iter().map(legend_line).collect();
        let legend = if items.is_empty() { items } else { format!("<ul class=\"legend\">{items}</ul>") };
        let wide = if self.wide { " class=\"wide\"" } else { "" };
        format!(
            "<figure{wide}><figcaption><h3>{title}</h3>{caption}</figcaption>{legend}\
             <label class=\"zoom\"><input type=\"checkbox\" aria-label=\"Enlarge: {title}\">\
             <span class=\"sheet\">{}</span></label></figure>\n",
            self.body,
        )
    }
}

/// Width and height from the head of a PNG.
fn png_size(bytes: &[u8]) -> Option<(u32, u32)> {
    let word = |at: usize| Some(u32::from_be_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
    bytes.starts_with(b"\x89PNG").then(|| Some((word(16)?, word(20)?)))?
}

fn legend_line(item: &LegendItem) -> String {
    let color = item.color.css();
    let solid = item.color.alpha(item.color.a.max(200)).css();
    let mark = match item.mark {
        Mark::Line => format!("<path d=\"M3 8h24\" stroke=\"{color}\" stroke-width=\"4\"/>"),
        Mark::Arrow => {
            format!(
                "<path d=\"M3 8h18\" stroke=\"{color}\" stroke-width=\"3\"/><path d=\"M19 2l10 6-10 6z\" fill=\"{color}\"/>"
            )
        }
        Mark::Badge => format!(
            "<circle cx=\"15\" cy=\"8\" r=\"7\" fill=\"#fff\" stroke=\"{color}\"/><text x=\"15\" y=\"12\" font-size=\"11\" text-anchor=\"middle\">1</text>"
        ),
        Mark::Outline => {
            format!("<path d=\"M2 2h26v12H2z\" fill=\"none\" stroke=\"{color}\" stroke-width=\"2\"/>")
        }
        Mark::Dashes => {
            format!("<path d=\"M3 8h24\" stroke=\"{color}\" stroke-width=\"4\" stroke-dasharray=\"6 3\"/>")
        }
        Mark::Dot => format!("<circle cx=\"15\" cy=\"8\" r=\"4\" fill=\"{solid}\"/>"),
        Mark::Ring => format!(
            "<circle cx=\"15\" cy=\"8\" r=\"5\" fill=\"none\" stroke=\"{color}\" stroke-width=\"2.5\"/>"
        ),
        Mark::Wedge => format!("<path d=\"M8 2l16 6-16 6 4-6z\" fill=\"{color}\"/>"),
        Mark::Band => format!("<path d=\"M0 0h30v16H0z\" fill=\"{color}\"/>"),
        Mark::Cell => format!(
            "<path d=\"M7.5 1.5h15v13h-15z\" fill=\"{color}\" stroke=\"{}\"/>",
            Color::FAINT_INK.css()
        ),
    };
    let label = escape(&item.label);
    format!("<li><svg viewBox=\"0 0 30 16\" aria-hidden=\"true\">{mark}</svg>{label}</li>")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_says_its_size_and_garbage_is_still_a_figure() {
        let png = crate::MapPicture::blank().to_png();
        let html = Figure::png("map", &png).to_html();
        assert!(
            html.contains("<img alt=\"map\" width=\"") && html.contains("data:image/png;base64,iVBORw0KGgo")
        );
        for garbage in [&b""[..], b"\x89PNG", b"junk"] {
            assert!(Figure::png("x", garbage).to_html().contains("<img alt=\"x\" src="));
        }
    }
}
