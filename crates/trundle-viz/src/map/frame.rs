//! The frame of a plot: ticks, axis names, scale bar and legend.

use super::view::View;
use crate::canvas::Canvas;
use crate::color::Color;
use crate::text::{TextStyle, cap_height, line_height, text_width};
use crate::ticks::{Ticks, round_step};

/// Faint lines at the ticks, for a plot without a map.
pub(crate) fn paint_lattice(canvas: &mut Canvas, view: &View) {
    let (x_ticks, y_ticks) = axis_ticks(view);
    let (corner, _) = view.extent();
    let line = (view.unit / 2).max(1);
    for &x in &x_ticks.values {
        let at = view.length_px(x - corner.x).round() as i64;
        canvas.fill_rect(at, 0, line, view.height, Color::HAIRLINE);
    }
    for &y in &y_ticks.values {
        let at = view.height - view.length_px(y - corner.y).round() as i64;
        canvas.fill_rect(0, at, view.width, line, Color::HAIRLINE);
    }
}

/// The plot in its frame: ticks and axis names around it, a scale bar at the top, a legend at the bottom.
pub(crate) fn paint_frame(plot: &Canvas, view: &View, axes: &[String; 2], legend: Option<&Canvas>) -> Canvas {
    let unit = view.unit;
    let (x_ticks, y_ticks) = axis_ticks(view);
    let widest = y_ticks.values.iter().map(|&v| text_width(&y_ticks.label(v), unit)).max().unwrap_or(0);
    let (left, top) = (widest + 8 * unit, line_height(unit) + 8 * unit);
    let (right, bottom) = (8 * unit, cap_height(unit) + 9 * unit);
    let width = plot.width().max(legend.map_or(0, Canvas::width));
    let under = top + plot.height() + bottom;
    let legend_height = legend.map_or(0, |l| l.height() + 4 * unit);
    let mut canvas = Canvas::new(left + width + right, under + legend_height, Color::WHITE);
    canvas.paste(plot, left, top);
    canvas.frame_rect(left, top, plot.width(), plot.height(), (unit / 2).max(1), Color::FAINT_INK);
    let ink = TextStyle::new(unit, Color::FAINT_INK);
    let name_left = left + plot.width() - text_width(&axes[0], unit);
    canvas.text(name_left, top + plot.height() + 5 * unit, &axes[0], ink);
    canvas.text(left, 4 * unit, &axes[1], ink);
    label_x(&mut canvas, view, &x_ticks, (left, top), name_left);
    label_y(&mut canvas, view, &y_ticks, (left, top));
    paint_scale_bar(&mut canvas, view, left + plot.width(), 4 * unit, text_width(&axes[1], unit));
    if let Some(legend) = legend {
        canvas.paste(legend, left, under + 2 * unit);
    }
    canvas
}

fn axis_ticks(view: &View) -> (Ticks, Ticks) {
    let (low, high) = view.extent();
    let count = |side: i64, room: i64| (side / (room * view.unit)).clamp(2, 12) as usize;
    (Ticks::new(low.x, high.x, count(view.width, 60)), Ticks::new(low.y, high.y, count(view.height, 40)))
}

fn label_x(canvas: &mut Canvas, view: &View, ticks: &Ticks, (left, top): (i64, i64), end: i64) {
    let (unit, (corner, _)) = (view.unit, view.extent());
    for &value in &ticks.values {
        let x = left + view.length_px(value - corner.x).round() as i64;
        let y = top + view.height;
        let (label, line) = (ticks.label(value), (unit / 2).max(1));
        let width = text_width(&label, unit);
        canvas.fill_rect(x, y, line, 3 * unit, Color::FAINT_INK);
        if x + width / 2 + 4 * unit < end {
            canvas.text(x - width / 2, y + 5 * unit, &label, TextStyle::new(unit, Color::FAINT_INK));
        }
    }
}

fn label_y(canvas: &mut Canvas, view: &View, ticks: &Ticks, (left, top): (i64, i64)) {
    let (unit, (corner, _)) = (view.unit, view.extent());
    for &value in &ticks.values {
        let y = top + view.height - view.length_px(value - corner.y).round() as i64;
        let label = ticks.label(value);
        canvas.fill_rect(left - 3 * unit, y, 3 * unit, (unit / 2).max(1), Color::FAINT_INK);
        let x = left - 5 * unit - text_width(&label, unit);
        canvas.text(x, y - cap_height(unit) / 2, &label, TextStyle::new(unit, Color::FAINT_INK));
    }
}

/// A bar of a round length, its right end at `right`. The bar is left out if it would overlap the axis name, `taken` px wide.
fn paint_scale_bar(canvas: &mut Canvas, view: &View, right: i64, top: i64, taken: i64) {
    let metres = round_step(view.metres(view.width as f64 / 5.0) / 2.5);
    let (unit, label) = (view.unit, length_label(metres));
    let length = view.length_px(metres).round() as i64;
    let text = text_width(&label, unit);
    if !metres.is_finite() || length + text + taken + 12 * unit > view.width {
        return;
    }
    let (x, middle) = (right - length, top + cap_height(unit) / 2);
    canvas.fill_rect(x, middle - unit / 2, length, unit.max(1), Color::INK);
    for end in [x, right - unit] {
        canvas.fill_rect(end, top, unit, cap_height(unit), Color::INK);
    }
    canvas.text(x - text - 4 * unit, top, &label, TextStyle::new(unit, Color::INK));
}

/// A round length in its usual unit.
fn length_label(metres: f64) -> String {
    match metres {
        m if m >= 0.9e6 => format!("{m:.0e} m"),
        m if m >= 0.9e3 => format!("{:.0} km", m / 1e3),
        m if m >= 0.9 => format!("{m:.0} m"),
        m if m >= 0.9e-2 => format!("{:.0} cm", m * 1e2),
        m if m >= 0.9e-3 => format!("{:.0} mm", m * 1e3),
        m => format!("{m:.0e} m"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_readable_units() {
        let labels = [2000.0, 50.0, 1.0, 0.5, 0.02, 0.005].map(length_label);
        assert_eq!(labels, ["2 km", "50 m", "1 m", "50 cm", "2 cm", "5 mm"]);
    }
}
