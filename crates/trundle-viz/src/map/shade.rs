use super::view::View;
use crate::canvas::Canvas;
use crate::color::Color;
use crate::colormap::color_at;
use trundle_core::{GridGeometry, Vector2};

/// A value a cell, laid over the map as a translucent tint.
#[derive(Debug, Clone)]
pub(crate) struct Shade {
    pub geometry: GridGeometry,
    /// Row by row from the lowest y; not finite: nothing is laid there.
    pub values: Vec<f32>,
    /// The value of the darkest tint; 0 is the lightest.
    pub full: f32,
}

/// Opacity of the tint.
const ALPHA: u8 = 150;

impl Shade {
    /// The tint that stands for it in a legend.
    pub(crate) fn color() -> Color {
        tint(0.35)
    }

    pub(crate) fn draw(&self, canvas: &mut Canvas, view: &View) {
        let (low, high) = view.extent();
        for y in 0..canvas.height() {
            for x in 0..canvas.width() {
                let right = low.x + view.metres(x as f64 + 0.5);
                let up = high.y - view.metres(y as f64 + 0.5);
                let cell = self.geometry.cell_at(Vector2::new(right, up));
                let value = cell.and_then(|cell| self.values.get(self.geometry.linear(cell)));
                if let Some(value) = value.filter(|value| value.is_finite()) {
                    canvas.blend(x, y, tint(f64::from(value / self.full)));
                }
            }
        }
    }
}

fn tint(share: f64) -> Color {
    let [r, g, b] = color_at(share);
    Color { r, g, b, a: ALPHA }
}
