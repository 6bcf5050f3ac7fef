//! Bar charts with whiskers as SVG.

use super::axes::Axis;
use super::line::{open_svg, put, text_width};
use crate::color::Color;
use crate::html::{escape, ink};
use crate::ticks::number;

/// Bars with a whisker: the median and the 99th percentile of each stage's time, or the like. Inline SVG as [`crate::Chart`].
#[derive(Debug, Clone, PartialEq)]
pub struct BarChart {
    pub(crate) title: String,
    unit: String,
    names: [String; 2],
    rows: Vec<(String, f64, f64)>,
}

/// Width of the chart, in its own units. Source: ours.
pub(super) const CHART_WIDTH: f64 = 540.0;
/// Distance of neighbouring bars, in the chart's units. Source: ours.
const BAR_PITCH: f64 = 28.0;
/// Distance of the first bar from the upper edge, in the chart's units. Source: ours.
pub(super) const PLOT_TOP: f64 = 40.0;

impl BarChart {
    /// An empty chart of values in `unit`; `bar` and `whisker` name the meaning of the two ends.
    pub fn new(title: &str, unit: &str, bar: &str, whisker: &str) -> Self {
        let [title, unit, bar, whisker] = [title, unit, bar, whisker].map(str::to_owned);
        Self { title, unit, names: [bar, whisker], rows: Vec::new() }
    }

    /// Adds a row. Values that are not finite or negative count as 0.
    pub fn row(mut self, label: &str, bar: f64, whisker: f64) -> Self {
        let sane = |value: f64| if value.is_finite() && value > 0.0 { value } else { 0.0 };
        self.rows.push((label.to_owned(), sane(bar), sane(whisker)));
        self
    }

    /// The chart as an `<svg>` element, all text escaped. Equal content gives equal bytes.
    pub fn to_svg(&self) -> String {
        let height = PLOT_TOP + BAR_PITCH * self.rows.len() as f64 + 34.0;
        let widest =
            self.rows.iter().map(|row| text_width(&row.0)).fold(40.0, f64::max).min(CHART_WIDTH / 3.0);
        let (left, right) = (widest + 12.0, CHART_WIDTH - 104.0);
        let values = self.rows.iter().flat_map(|row| [row.1, row.2]).chain([0.0]);
        let axis = Axis::over(values, false, 0.0, (left, right));
        let mut svg = open_svg(&self.title, CHART_WIDTH, height);
        self.draw_ground(&mut svg, &axis, left, height);
        for (i, row) in self.rows.iter().enumerate() {
            draw_row(&mut svg, &axis, left, PLOT_TOP + BAR_PITCH * i as f64, row);
        }
        svg + "</svg>"
    }

    fn draw_ground(&self, svg: &mut String, axis: &Axis, left: f64, height: f64) {
        let bottom = height - 30.0;
        draw_rules(svg, axis, bottom);
        let bar = ink(Color::BLUE);
        put(
            svg,
            format_args!(
                "<rect x=\"{left:.1}\" y=\"14\" width=\"22\" height=\"11\" rx=\"2\" style=\"fill:{bar}\"/>\
             <text x=\"{:.1}\" y=\"24\">{}</text><path class=\"whisker\" d=\"M{:.1} 19.5h22m0 -5v10\"/>\
             <text x=\"{:.1}\" y=\"24\">{}</text><text class=\"tick\" x=\"{CHART_WIDTH}\" y=\"24\" text-anchor=\"end\">{}</text>",
                left + 28.0,
                escape(&self.names[0]),
                left + 48.0 + text_width(&self.names[0]),
                left + 76.0 + text_width(&self.names[0]),
                escape(&self.names[1]),
                escape(&self.unit),
            ),
        );
    }
}

/// Upright rules at the ticks of `axis`, from [`PLOT_TOP`] to `bottom` px, with their values below.
pub(super) fn draw_rules(svg: &mut String, axis: &Axis, bottom: f64) {
    for (at, label) in axis.ticks(6) {
        put(
            svg,
            format_args!(
                "<path class=\"rule\" d=\"M{at:.1} {PLOT_TOP}V{bottom:.1}\"/>\
                 <text class=\"tick\" x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{label}</text>",
                bottom + 17.0,
            ),
        );
    }
}

fn draw_row(svg: &mut String, axis: &Axis, left: f64, top: f64, (label, bar, whisker): &(String, f64, f64)) {
    let place = |value: f64| axis.place(value).unwrap_or(left);
    let (middle, bar_end, end) = (top + BAR_PITCH / 2.0, place(*bar), place(*whisker));
    let text = |value: f64| number(value, if value < 1.0 { 0.01 } else { 0.1 });
    put(
        svg,
        format_args!(
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>\
         <rect x=\"{left:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"14\" rx=\"2\" style=\"fill:{}\"/>\
         <path class=\"whisker\" d=\"M{bar_end:.1} {middle:.1}H{end:.1}m0 -5v10\"/>\
         <text class=\"tick\" x=\"{CHART_WIDTH}\" y=\"{:.1}\" text-anchor=\"end\">{} / {}</text>",
            left - 8.0,
            middle + 4.5,
            escape(label),
            middle - 7.0,
            (bar_end - left).max(1.0),
            ink(Color::BLUE),
            middle + 4.5,
            text(*bar),
            text(*whisker),
        ),
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_shown_and_nonsense_is_zero() {
        let svg = BarChart::new("Stage times", "ms", "median", "99th percentile")
            .row("track", 12.0, 30.5)
            .row("<map>", f64::NAN, -1.0)
            .to_svg();
        assert!(
            svg.contains(">track<") && svg.contains("&lt;map&gt;") && svg.contains("12.0 / 30.5"),
            "{svg}"
        );
        assert!(!svg.contains("NaN"));
        assert!(BarChart::new("", "", "", "").to_svg().ends_with("</svg>"));
    }
}
