//! Tests of the report page: escaping, self-containment and determinism.

use super::*;
use crate::{BarChart, Chart, Color, LegendItem, Mark};

const EVIL: &str = "</title><script>alert(1)</script>\" onload='x' &";

fn page(text: &str) -> String {
    let chart =
        Chart::new(text, text, text).line(text, Color::BLUE, vec![(0.0, 1.0), (1.0, 2.0)]).limit(text, 1.5);
    Report::new(text)
        .subtitle(text)
        .link(text, text)
        .verdict(Verdict::Failed(text.to_owned()))
        .card(Card::new(text, text).unit(text).remark(text).good(false))
        .section(text, text)
        .figure(Figure::chart(&chart).caption(text).legend(vec![LegendItem::new(
            text,
            Color::BLUE,
            Mark::Line,
        )]))
        .figure(Figure::bars(&BarChart::new(text, text, text, text).row(text, 1.0, 2.0)))
        .figure(Figure::png(text, b"junk"))
        .table(Table::new(text, [text, text]).row([text, text]))
        .table(Table::new(text, [text, text]).row([text, text]).folded())
        .to_html()
}

#[test]
fn all_text_is_escaped() {
    let (evil, tame) = (page(EVIL), page("x"));
    assert!(!evil.contains("<script") && evil.contains("&lt;script&gt;"));
    for sign in ['<', '>', '"', '\''] {
        assert_eq!(evil.matches(sign).count(), tame.matches(sign).count(), "{sign} got through");
    }
}

#[test]
fn the_page_fetches_nothing_and_is_the_same_each_time() {
    let html = page("x");
    for outside in ["http://", "https://", "@import", "url(", "<script", "<link", "<iframe"] {
        assert!(!html.contains(outside), "{outside}");
    }
    assert!(html.contains("default-src 'none'"));
    assert_eq!(html, page("x"));
}

#[test]
fn blocks_without_a_section_are_kept() {
    let html = Report::new("r").table(Table::new("alone", ["a"])).to_html();
    assert!(html.contains("alone") && !html.contains("<h2>"));
}

#[test]
fn a_link_leads_to_a_file_beside_the_page() {
    let html = Report::new("r").link("Times", "timing.html").to_html();
    assert!(html.contains("<nav><a href=\"./timing.html\">Times</a></nav>"), "{html}");
    let script = Report::new("r").link("x", "javascript:alert(1)").to_html();
    assert!(script.contains("href=\"./javascript:alert(1)\""), "a path, not a scheme");
    assert!(!Report::new("r").to_html().contains("<nav>"));
}
