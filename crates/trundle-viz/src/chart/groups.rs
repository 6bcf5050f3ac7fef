//! Bar charts that compare several series row by row, as SVG.

use super::axes::Axis;
use super::bars::{CHART_WIDTH, PLOT_TOP, draw_rules};
use super::line::{open_svg, put, text_width};
use super::standalone;
use crate::color::Color;
use crate::html::{escape, ink};
use crate::ticks::number;

/// Horizontal bars: for each row one bar of each series, with its value. Inline SVG as [`crate::Chart`].
///
/// ```
/// use trundle_viz::{Color, GroupChart};
/// let svg = GroupChart::new("Time of a manoeuvre", "s")
///     .series("trundle", Color::BLUE)
///     .series("peer", Color::ORANGE)
///     .row("scenario a", &[5.7, 6.4])
///     .to_svg();
/// assert!(svg.contains("scenario a"));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct GroupChart {
    title: String,
    unit: String,
    series: Vec<(String, Color)>,
    rows: Vec<(String, Vec<f64>)>,
}

/// Height of a bar, px. Source: ours.
const BAR_HEIGHT: f64 = 13.0;
/// Distance from a bar to the next of the same row, px. Source: ours.
const BAR_PITCH: f64 = 16.0;
/// Gap between the bars of two rows, px. Source: ours.
const ROW_GAP: f64 = 11.0;

impl GroupChart {
    /// An empty chart of values in `unit`.
    pub fn new(title: &str, unit: &str) -> Self {
        Self { title: title.to_owned(), unit: unit.to_owned(), series: Vec::new(), rows: Vec::new() }
    }

    /// Adds a series.
    pub fn series(mut self, label: &str, color: Color) -> Self {
        self.series.push((label.to_owned(), color));
        self
    }

    /// Adds a row: a value for each series, in their order. A value that is not finite has no bar; a negative one counts as 0.
    pub fn row(mut self, label: &str, values: &[f64]) -> Self {
        self.rows.push((label.to_owned(), values.to_vec()));
        self
    }

    /// The chart as an `<svg>` element, all text escaped. Equal content gives equal bytes.
    pub fn to_svg(&self) -> String {
        let bottom = PLOT_TOP + self.row_pitch() * self.rows.len() as f64;
        let widest = self.rows.iter().map(|row| text_width(&row.0)).fold(40.0, f64::max);
        let (left, right) = (widest.min(CHART_WIDTH / 2.5) + 12.0, CHART_WIDTH - 60.0);
        let values = self.rows.iter().flat_map(|row| row.1.iter().copied()).filter(|v| v.is_finite());
        let longest = values.fold(0.0, f64::max);
        // Without a bar longer than 0 the axis ends at 1.
        let longest = if longest > 0.0 { longest } else { 1.0 };
        let axis = Axis::over([0.0, longest].into_iter(), false, 0.0, (left, right));
        let mut svg = open_svg(&self.title, CHART_WIDTH, bottom + 34.0);
        draw_rules(&mut svg, &axis, bottom + 4.0);
        self.draw_legend(&mut svg, left);
        for (i, row) in self.rows.iter().enumerate() {
            self.draw_row(&mut svg, &axis, left, PLOT_TOP + self.row_pitch() * i as f64, row);
        }
        svg + "</svg>"
    }

    /// The chart as the content of an `.svg` file.
    pub fn to_svg_file(&self) -> String {
        standalone::document(&self.to_svg())
    }

    fn row_pitch(&self) -> f64 {
        BAR_PITCH * self.series.len().max(1) as f64 + ROW_GAP
    }

    fn draw_legend(&self, svg: &mut String, left: f64) {
        let mut x = left;
        for (label, color) in self.series.iter().filter(|_| self.series.len() > 1) {
            let (text, fill) = (escape(label), ink(*color));
            put(
                svg,
                format_args!(
                    "<rect x=\"{x:.1}\" y=\"14\" width=\"22\" height=\"11\" rx=\"2\" style=\"fill:{fill}\"/>\
                     <text x=\"{:.1}\" y=\"24\">{text}</text>",
                    x + 28.0
                ),
            );
            x += 48.0 + text_width(label);
        }
        let unit = escape(&self.unit);
        put(
            svg,
            format_args!(
                "<text class=\"tick\" x=\"{:.1}\" y=\"24\" text-anchor=\"end\">{unit}</text>",
                CHART_WIDTH - 8.0
            ),
        );
    }

    fn draw_row(
        &self,
        svg: &mut String,
        axis: &Axis,
        left: f64,
        top: f64,
        (label, values): &(String, Vec<f64>),
    ) {
        let middle = top + (self.row_pitch() - ROW_GAP + ROW_GAP / 2.0) / 2.0;
        let text = escape(label);
        put(
            svg,
            format_args!(
                "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{text}</text>",
                left - 8.0,
                middle + 4.5
            ),
        );
        for (i, ((_, color), value)) in self.series.iter().zip(values).enumerate() {
            draw_bar(svg, axis, left, top + ROW_GAP / 4.0 + BAR_PITCH * i as f64, *color, *value);
        }
    }
}

/// A bar with its value; a value that is not finite is a dash.
fn draw_bar(svg: &mut String, axis: &Axis, left: f64, top: f64, color: Color, value: f64) {
    let end = if value.is_finite() { axis.place(value.max(0.0)).unwrap_or(left) } else { left };
    let text = if value.is_finite() { short(value) } else { "–".to_owned() };
    let fill = ink(color);
    put(
        svg,
        format_args!(
            "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{BAR_HEIGHT}\" rx=\"2\" style=\"fill:{fill}\"/>\
             <text class=\"tick\" x=\"{:.1}\" y=\"{:.1}\">{text}</text>",
            (end - left).max(1.0),
            end + 6.0,
            top + BAR_HEIGHT - 2.0,
        ),
    );
}

/// A value with three digits; a whole number without decimals.
fn short(value: f64) -> String {
    if value.fract() == 0.0 {
        return number(value, 1.0);
    }
    let text = number(value, 10_f64.powf(value.abs().log10().floor() - 2.0).min(1.0));
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_value_has_a_bar_and_a_missing_one_a_dash() {
        let chart = GroupChart::new("<t>", "cm")
            .series("trundle", Color::BLUE)
            .series("peer", Color::ORANGE)
            .row("a & b", &[0.15, 4.25])
            .row("lost", &[f64::NAN, -1.0]);
        let svg = chart.to_svg();
        assert_eq!(svg.matches("height=\"13\"").count(), 4, "{svg}");
        assert!(
            svg.contains("a &amp; b")
                && svg.contains(">0.15<")
                && svg.contains(">4.25<")
                && svg.contains(">–<")
        );
        assert!(!svg.contains("NaN") && !svg.contains("<t>"));
    }

    #[test]
    fn the_longest_bar_is_the_largest_value() {
        let svg = GroupChart::new("", "").series("s", Color::BLUE).row("a", &[1.0]).row("b", &[2.0]).to_svg();
        let widths: Vec<f64> =
            svg.split("width=\"").skip(1).filter_map(|w| w.split('"').next()?.parse().ok()).collect();
        assert!((widths[1] / widths[0] - 2.0).abs() < 0.01, "{widths:?}");
    }

    #[test]
    fn nothing_to_show_is_still_a_chart() {
        let zero = GroupChart::new("", "").series("s", Color::BLUE).row("a", &[0.0]).to_svg();
        assert!(zero.contains("width=\"1.0\"") && !zero.contains(">-"), "{zero}");
        assert!(GroupChart::new("", "").to_svg_file().trim_end().ends_with("</svg>"));
    }
}
