//! Line charts as SVG.

use super::axes::{Axis, HEIGHT, PLOT_RECTANGLE, WIDTH};
use super::standalone;
use super::thin::pieces;
use crate::color::Color;
use crate::html::{escape, ink};
use std::fmt::Write;

/// A chart of series over a common axis, most often time; becomes inline SVG that follows the page's light or dark scheme.
///
/// ```
/// use trundle_viz::{Chart, Color};
/// let svg = Chart::new("Distance to the goal", "time, s", "distance, m")
///     .line("distance", Color::BLUE, vec![(0.0, 5.2), (1.0, 4.9), (2.0, f64::NAN), (3.0, 4.1)])
///     .limit("tolerance", 0.05)
///     .to_svg();
/// assert!(svg.starts_with("<svg"));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    pub(crate) title: String,
    x_name: String,
    y_name: String,
    series: Vec<Series>,
    limits: Vec<(String, f64)>,
    log_y: bool,
    from_zero: bool,
}

#[derive(Debug, Clone, PartialEq)]
struct Series {
    label: String,
    color: Color,
    dashed: bool,
    /// Whether each point has a mark.
    marked: bool,
    points: Vec<(f64, f64)>,
}

impl Chart {
    /// An empty chart; the names of the axes include their units.
    pub fn new(title: &str, x_name: &str, y_name: &str) -> Self {
        let [title, x_name, y_name] = [title, x_name, y_name].map(str::to_owned);
        Self { title, x_name, y_name, series: Vec::new(), limits: Vec::new(), log_y: false, from_zero: false }
    }

    /// Adds a series of (x, y). A point that is not finite leaves a gap; long series are thinned without losing peaks.
    pub fn line(self, label: &str, color: Color, points: Vec<(f64, f64)>) -> Self {
        self.series(Series { label: label.to_owned(), color, dashed: false, marked: false, points })
    }

    /// Adds a series of few (x, y), each with a mark: measurements with straight lines between them.
    pub fn marked(self, label: &str, color: Color, points: Vec<(f64, f64)>) -> Self {
        self.series(Series { label: label.to_owned(), color, dashed: false, marked: true, points })
    }

    /// Adds a dashed series, for references.
    pub fn dashed(self, label: &str, color: Color, points: Vec<(f64, f64)>) -> Self {
        self.series(Series { label: label.to_owned(), color, dashed: true, marked: false, points })
    }

    /// Adds a line at a limit. A limit that is not finite is left out.
    pub fn limit(mut self, label: &str, y: f64) -> Self {
        if y.is_finite() {
            self.limits.push((label.to_owned(), y));
        }
        self
    }

    /// A logarithmic y axis; values that are not positive are left out.
    pub fn log_y(self) -> Self {
        Self { log_y: true, ..self }
    }

    /// A y axis that begins at 0.
    pub fn from_zero(self) -> Self {
        Self { from_zero: true, ..self }
    }

    fn series(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// The chart as the content of an `.svg` file.
    pub fn to_svg_file(&self) -> String {
        standalone::document(&self.to_svg())
    }

    /// The chart as an `<svg>` element, all text escaped. Equal content gives equal bytes.
    pub fn to_svg(&self) -> String {
        let finite =
            || self.series.iter().flat_map(|s| &s.points).filter(|p| p.0.is_finite() && p.1.is_finite());
        let heights = finite()
            .map(|p| p.1)
            .chain(self.limits.iter().map(|limit| limit.1))
            .chain(self.from_zero.then_some(0.0));
        let x = Axis::over(finite().map(|p| p.0), false, 0.0, (PLOT_RECTANGLE[0], PLOT_RECTANGLE[2]));
        let y = Axis::over(heights, self.log_y, 0.06, (PLOT_RECTANGLE[3], PLOT_RECTANGLE[1]));
        let mut svg = open_svg(&self.title, WIDTH, HEIGHT);
        draw_axes(&mut svg, &x, &y, &self.x_name, &self.y_name);
        self.limits.iter().for_each(|(label, level)| draw_limit(&mut svg, &y, label, *level));
        self.series.iter().for_each(|series| draw_series(&mut svg, series, &x, &y));
        self.draw_legend(&mut svg);
        svg + "</svg>"
    }

    /// Names and short strokes, from the right end of the line above the plot.
    fn draw_legend(&self, svg: &mut String) {
        let mut right = PLOT_RECTANGLE[2];
        for series in self.series.iter().rev() {
            let start = right - text_width(&series.label);
            let style = stroke(series.color, series.dashed);
            put(
                svg,
                format_args!(
                    "<path d=\"M{:.1} 20h22\" style=\"{style}\"/><text x=\"{start:.1}\" y=\"24\">{}</text>",
                    start - 28.0,
                    escape(&series.label),
                ),
            );
            right = start - 46.0;
        }
    }
}

/// The opening tag of a chart.
pub(super) fn open_svg(title: &str, width: f64, height: f64) -> String {
    let title = escape(title);
    format!(
        "<svg class=\"chart\" viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{title}\" font-size=\"13\">"
    )
}

/// Writes into a string, which cannot fail.
pub(super) fn put(svg: &mut String, what: std::fmt::Arguments) {
    svg.write_fmt(what).expect("invariant: a string takes any text");
}

/// About the width of a text in the page's own typeface, generously.
pub(super) fn text_width(text: &str) -> f64 {
    7.8 * text.chars().count() as f64
}

fn stroke(color: Color, dashed: bool) -> String {
    let dash = if dashed { ";stroke-dasharray:6 5" } else { "" };
    format!("fill:none;stroke:{};stroke-width:2;stroke-linejoin:round{dash}", ink(color))
}

fn draw_axes(svg: &mut String, x: &Axis, y: &Axis, x_name: &str, y_name: &str) {
    let [left, _, right, bottom] = PLOT_RECTANGLE;
    for (at, label) in y.ticks(5) {
        put(
            svg,
            format_args!(
                "<path class=\"rule\" d=\"M{left} {at:.1}H{right}\"/>\
             <text class=\"tick\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>",
                left - 8.0,
                at + 4.5,
            ),
        );
    }
    for (at, label) in x.ticks(7) {
        put(
            svg,
            format_args!(
                "<path class=\"axis\" d=\"M{at:.1} {bottom}v5\"/>\
             <text class=\"tick\" x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{label}</text>",
                bottom + 20.0,
            ),
        );
    }
    put(
        svg,
        format_args!(
            "<path class=\"axis\" d=\"M{left} {bottom}H{right}\"/>\
         <text class=\"tick\" x=\"{:.1}\" y=\"24\">{}</text>\
         <text class=\"tick\" x=\"{right}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            6.0,
            escape(y_name),
            HEIGHT - 6.0,
            escape(x_name),
        ),
    );
}

fn draw_limit(svg: &mut String, y: &Axis, label: &str, level: f64) {
    let Some(at) = y.place(level) else { return };
    put(
        svg,
        format_args!(
            "<path d=\"M{} {at:.1}H{}\" style=\"fill:none;stroke:{};stroke-width:1.5;stroke-dasharray:2 4\"/>\
         <text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\" style=\"fill:{}\">{}</text>",
            PLOT_RECTANGLE[0],
            PLOT_RECTANGLE[2],
            ink(Color::VERMILLION),
            PLOT_RECTANGLE[2] - 4.0,
            at - 6.0,
            ink(Color::VERMILLION),
            escape(label),
        ),
    );
}

fn draw_series(svg: &mut String, series: &Series, x: &Axis, y: &Axis) {
    let mut path = String::new();
    for piece in pieces(&series.points) {
        let mut pen = 'M';
        let mut count = 0;
        for point in piece {
            let (Some(px), Some(py)) = (x.place(point.0), y.place(point.1)) else {
                pen = 'M';
                continue;
            };
            put(&mut path, format_args!("{pen}{px:.1} {py:.1}"));
            (pen, count) = ('L', count + 1);
        }
        if count == 1 {
            path.push_str("h0.1");
        }
    }
    let style = stroke(series.color, series.dashed);
    put(svg, format_args!("<path d=\"{path}\" stroke-linecap=\"round\" style=\"{style}\"/>"));
    for point in series.points.iter().filter(|_| series.marked) {
        if let (Some(px), Some(py)) = (x.place(point.0), y.place(point.1)) {
            let fill = ink(series.color);
            put(svg, format_args!("<circle cx=\"{px:.1}\" cy=\"{py:.1}\" r=\"3.5\" style=\"fill:{fill}\"/>"));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_escaped_and_gaps_stay_open() {
        let chart = Chart::new("<b>", "t & s", "\"y\"").line(
            "<script>",
            Color::BLUE,
            vec![(0.0, 1.0), (1.0, 2.0), (2.0, f64::NAN), (3.0, 1.0), (4.0, 0.0)],
        );
        let svg = chart.to_svg();
        assert!(!svg.contains("<script>") && !svg.contains("<b>") && svg.contains("&lt;script&gt;"));
        let path = svg.split("d=\"").find(|part| part.contains('L')).unwrap();
        assert_eq!(path.split('"').next().unwrap().matches('M').count(), 2);
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
    }

    #[test]
    fn a_marked_series_has_a_mark_for_each_finite_point() {
        let points = vec![(0.0, 1.0), (1.0, f64::NAN), (2.0, 3.0)];
        let file = Chart::new("", "x", "y").marked("m", Color::BLUE, points).to_svg_file();
        assert_eq!(file.matches("<circle").count(), 2, "{file}");
        let high = || Chart::new("", "x", "y").line("m", Color::BLUE, vec![(0.0, 8.0), (1.0, 9.0)]);
        assert!(!high().to_svg().contains(">0<") && high().from_zero().to_svg().matches(">0<").count() == 1);
        assert!(
            file.starts_with("<svg ")
                && file.contains("xmlns=\"http://www.w3.org/2000/svg\"")
                && !file.contains("NaN")
        );
    }

    #[test]
    fn nothing_to_show_is_still_a_chart() {
        for chart in
            [Chart::new("", "", ""), Chart::new("a", "b", "c").line("d", Color::BLUE, vec![]).log_y()]
        {
            let svg = chart.limit("no", f64::NAN).to_svg();
            assert!(svg.ends_with("</svg>") && !svg.contains("NaN"));
        }
    }
}
