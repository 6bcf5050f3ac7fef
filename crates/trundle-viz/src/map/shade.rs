//! Translucent tints by cell: distances, masks and shares.

use super::view::View;
use crate::canvas::Canvas;
use crate::color::Color;
use crate::colormap::color_at;
use trundle_core::{GridGeometry, Vector2};

/// One value per cell, drawn over the map as a translucent tint.
#[derive(Debug, Clone)]
pub(crate) struct Shade {
    pub geometry: GridGeometry,
    /// Row by row from the lowest y; a value that is not finite leaves the cell unchanged.
    pub values: Vec<f32>,
    pub paint: Paint,
}

/// Paint of a value.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Paint {
    /// A scale from light (0) to dark (this value).
    Scale(f32),
    /// This colour, with opacity equal to the value.
    Tint(Color),
}

impl Paint {
    fn color(self, value: f32) -> Color {
        match self {
            Self::Scale(full) => tint(f64::from(value / full)),
            Self::Tint(color) => color.alpha((f32::from(color.a) * value.clamp(0.0, 1.0)) as u8),
        }
    }
}

/// Opacity of the tint. Source: ours.
const TINT_ALPHA: u8 = 150;

impl Shade {
    /// The tint for the legend.
    pub(crate) fn color(&self) -> Color {
        match self.paint {
            Paint::Scale(_) => tint(0.35),
            Paint::Tint(color) => color,
        }
    }

    /// Whether any cell is visible.
    pub(crate) fn is_visible(&self) -> bool {
        match self.paint {
            Paint::Scale(_) => !self.values.is_empty(),
            Paint::Tint(_) => self.values.iter().any(|value| *value > 0.0),
        }
    }

    /// Walls remain visible: no tint is drawn over them.
    pub(crate) fn draw(&self, canvas: &mut Canvas, view: &View) {
        let (low, high) = view.extent();
        let wall = Color::OCCUPIED.over([0; 3]);
        for y in 0..canvas.height() {
            for x in 0..canvas.width() {
                let right = low.x + view.metres(x as f64 + 0.5);
                let up = high.y - view.metres(y as f64 + 0.5);
                let cell = self.geometry.cell_at(Vector2::new(right, up));
                let value = cell.and_then(|cell| self.values.get(self.geometry.linear(cell)));
                let value = value.filter(|value| value.is_finite() && canvas.at(x, y) != wall);
                if let Some(value) = value {
                    canvas.blend(x, y, self.paint.color(*value));
                }
            }
        }
    }
}

fn tint(share: f64) -> Color {
    let [r, g, b] = color_at(share);
    Color { r, g, b, a: TINT_ALPHA }
}
