//! A chart as a separate file.

/// Rules of the report's style sheet for charts, in its light colours.
const STYLE: &str = "svg{font-family:system-ui,sans-serif;fill:#1f242b}.rule{stroke:#dfe3e8;fill:none}.axis{stroke:#5c6570;fill:none}\
                     .whisker{stroke:#1f242b;stroke-width:1.5;fill:none}.tick{fill:#5c6570}";

/// An SVG document from the `<svg>` element of a chart: with name space, colours and a white ground.
pub(super) fn document(element: &str) -> String {
    let (head, body) = element.split_once('>').unwrap_or((element, ""));
    let body = body.replace("/><", "/>\n<").replace("</text><", "</text>\n<");
    format!(
        "{head} xmlns=\"http://www.w3.org/2000/svg\">\n<style>{STYLE}</style>\n\
         <rect width=\"100%\" height=\"100%\" style=\"fill:#fff\"/>\n{body}\n"
    )
}
