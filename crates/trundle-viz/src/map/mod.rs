//! Pictures of a map from above, with layers drawn over the grid.

mod arrow;
mod badge;
mod bounds;
mod cell_box;
mod cells;
mod draw;
mod frame;
mod layer;
mod shade;
mod style;
mod tiles;
mod view;

pub(crate) use badge::{draw_badge, radius_of};
pub use style::{DotStyle, LineStyle, PoseStyle};
pub use tiles::tiles;

use crate::canvas::Canvas;
use crate::color::Color;
use crate::legend::{LegendItem, Mark, paint_legend};
use bounds::Bounds;
use cell_box::CellBox;
use cells::paint_cells;
use frame::{paint_frame, paint_lattice};
use layer::{Layer, Shape};
use shade::{Paint, Shade};
use trundle_core::{Cell, Footprint, GridGeometry, OccupancyGrid, Pose2, Scan, Vector2};
use view::View;

/// A picture of a map from above, with the robot's estimates, plans and paths over it.
///
/// All coordinates are in the map frame, m: x to the right, y up. Layers are drawn in the order of their addition. A point with a number
/// that is not finite is left out. The picture contains the known cells, the lines and the poses; dots and scans never widen the picture.
/// Each cell is a whole number of pixels; a map with a side above 3000 cells is shrunk, with its walls preserved. Ticks, a scale bar and a
/// legend use the crate's typeface: no font file is needed.
///
/// ```
/// use trundle_core::{OccupancyGrid, Pose2, Vector2};
/// use trundle_viz::{Color, LineStyle, MapPicture, PoseStyle};
/// let grid = OccupancyGrid::from_ascii(0.1, "#####\n#...#\n#...#\n#####")?;
/// let path = [Vector2::new(0.15, 0.15), Vector2::new(0.35, 0.25)];
/// let png = MapPicture::over(&grid)
///     .polyline("path", &path, LineStyle::solid(Color::BLUE))
///     .pose("start", Pose2::new(0.15, 0.15, 0.0), PoseStyle::named(Color::GREEN))
///     .to_png();
/// assert_eq!(&png[1..4], b"PNG");
/// # Ok::<(), trundle_core::Invalid>(())
/// ```
#[derive(Debug, Clone)]
pub struct MapPicture<'a> {
    grid: Option<&'a OccupancyGrid>,
    layers: Vec<Layer>,
    window: Option<Bounds>,
    axes: [String; 2],
    cell_names: [String; 3],
    legend: bool,
    lettering: f64,
}

impl<'a> MapPicture<'a> {
    /// A picture over an occupancy grid.
    pub fn over(grid: &'a OccupancyGrid) -> Self {
        Self { grid: Some(grid), ..Self::blank() }
    }

    /// A picture without a map: overlays on squared paper.
    pub fn blank() -> Self {
        let axes = ["x, m".to_owned(), "y, m".to_owned()];
        let cell_names = ["free", "occupied", "unknown"].map(str::to_owned);
        Self { grid: None, layers: Vec::new(), window: None, axes, cell_names, legend: true, lettering: 1.0 }
    }

    /// Adds straight pieces between points.
    pub fn polyline(self, label: &str, points: &[Vector2], style: LineStyle) -> Self {
        self.layer(label, Shape::Line { points: points.to_vec(), style })
    }

    /// Adds straight pieces between points, with an arrow's head at the last.
    pub fn arrow(self, label: &str, points: &[Vector2], style: LineStyle) -> Self {
        self.layer(label, Shape::Arrow { points: points.to_vec(), style })
    }

    /// Adds short texts, for example numbers, in circles at their places; an overlapping one is moved aside, with a line to its place.
    pub fn badges(self, label: &str, badges: &[(String, Vector2)], color: Color) -> Self {
        self.layer(label, Shape::Badges { badges: badges.to_vec(), color })
    }

    /// Adds dots or circles.
    pub fn dots(self, label: &str, points: &[Vector2], style: DotStyle) -> Self {
        self.layer(label, Shape::Dots { points: points.to_vec(), style })
    }

    /// Adds the floor that a disc of `radius` m sweeps along `points`; give the colour some alpha.
    pub fn band(self, label: &str, points: &[Vector2], radius: f64, color: Color) -> Self {
        self.layer(label, Shape::Band { points: points.to_vec(), radius, color })
    }

    /// Adds a pose as a wedge along its heading.
    pub fn pose(self, label: &str, pose: Pose2, style: PoseStyle) -> Self {
        self.layer(label, Shape::Pose { pose, style })
    }

    /// Adds a filled polygon.
    pub fn area(self, label: &str, corners: &[Vector2], color: Color) -> Self {
        self.layer(label, Shape::Area { corners: corners.to_vec(), color })
    }

    /// Adds the floor that the robot covers at poses close together: the darker, the longer.
    pub fn swept(self, label: &str, poses: &[Pose2], footprint: &Footprint, color: Color) -> Self {
        self.layer(label, Shape::Swept { poses: poses.to_vec(), footprint: footprint.clone(), color })
    }

    /// Adds the robot's outline at each pose, with a stroke along the heading.
    pub fn outlines(self, label: &str, poses: &[Pose2], footprint: &Footprint, color: Color) -> Self {
        self.layer(label, Shape::Outlines { poses: poses.to_vec(), footprint: footprint.clone(), color })
    }

    /// Adds a scan taken at `map_from_base`: its hits as dots, the area it found free as a tint.
    pub fn scan(self, label: &str, map_from_base: Pose2, scan: &Scan, color: Color) -> Self {
        self.layer(label, Shape::scan(map_from_base, scan, color))
    }

    /// Adds a tint per cell: `values` row by row from the lowest y, from 0 (light) to `full` (dark). Values that are not finite are left
    /// out.
    pub fn shade(self, label: &str, geometry: GridGeometry, values: Vec<f32>, full: f32) -> Self {
        self.layer(label, Shape::Shade(Shade { geometry, values, paint: Paint::Scale(full) }))
    }

    /// Adds a tint of one colour: `shares` of its opacity, 0 to 1, row by row from the lowest y.
    pub fn tint(self, label: &str, geometry: GridGeometry, shares: Vec<f32>, color: Color) -> Self {
        self.layer(label, Shape::Shade(Shade { geometry, values: shares, paint: Paint::Tint(color) }))
    }

    /// Shows only the square of half side `half_side` m around `center`. Ignored for a window that is not finite or empty.
    pub fn window(self, center: Vector2, half_side: f64) -> Self {
        Self { window: Bounds::square(center, half_side), ..self }
    }

    /// Names the axes, unit included.
    pub fn axes(self, right: &str, up: &str) -> Self {
        Self { axes: [right.to_owned(), up.to_owned()], ..self }
    }

    /// Names free, occupied and unknown cells in the legend.
    pub fn cell_names(self, names: [&str; 3]) -> Self {
        Self { cell_names: names.map(str::to_owned), ..self }
    }

    /// Makes text and lines `factor` times as large as usual, for a picture that will be shown small.
    pub fn lettering(self, factor: f64) -> Self {
        Self { lettering: factor, ..self }
    }

    /// Leaves the legend out of the picture, for a page that shows [`MapPicture::legend`] itself.
    pub fn without_legend(self) -> Self {
        Self { legend: false, ..self }
    }

    /// Meanings of the colours: every visible layer once, then the kinds of cells.
    pub fn legend(&self) -> Vec<LegendItem> {
        let mut items: Vec<LegendItem> = Vec::new();
        for item in self.layers.iter().filter_map(Layer::legend) {
            if !items.iter().any(|known| known.label == item.label) {
                items.push(item);
            }
        }
        let [free, occupied, unknown] = &self.cell_names;
        let kinds = [
            (Cell::Free, free, Color::FREE),
            (Cell::Occupied, occupied, Color::OCCUPIED),
            (Cell::Unknown, unknown, Color::UNKNOWN),
        ];
        let cells = self.grid.map_or(&[][..], OccupancyGrid::cells);
        let present = kinds.into_iter().filter(|(kind, ..)| cells.contains(kind));
        items.extend(present.map(|(_, label, color)| LegendItem::new(label.as_str(), color, Mark::Cell)));
        items
    }

    /// The picture as an 8-bit RGB PNG, at most about 3000 px a side. Equal content gives equal bytes.
    pub fn to_png(&self) -> Vec<u8> {
        let view = self.view().with_lettering(self.lettering);
        let mut plot = self.ground(&view);
        self.draw_layers(&mut plot, &view);
        let legend = self.legend.then(|| paint_legend(&self.legend(), view.width, view.unit));
        paint_frame(&plot, &view, &self.axes, legend.as_ref()).to_png()
    }

    fn draw_layers(&self, canvas: &mut Canvas, view: &View) {
        let lines: Vec<_> = self.layers.iter().map(|layer| layer.line(view)).collect();
        self.layers.iter().for_each(|layer| layer.draw(canvas, view, &lines));
    }

    fn layer(mut self, label: &str, shape: Shape) -> Self {
        const LONGEST: usize = 60;
        self.layers.push(Layer { label: label.chars().take(LONGEST).collect(), shape });
        self
    }

    fn view(&self) -> View {
        let content = Bounds::around(self.layers.iter().flat_map(Layer::anchors));
        let content = content.or_else(|| Bounds::around(self.layers.iter().flat_map(Layer::strays)));
        let Some(grid) = self.grid else {
            let fallback = Bounds { min: Vector2::zeros(), max: Vector2::zeros() };
            return View::of_bounds(self.window.or(content).unwrap_or(fallback), self.window.is_some());
        };
        let geometry = grid.geometry();
        let content = content.map(|bounds| CellBox::touching(geometry, bounds));
        let block = match (self.window, CellBox::known(grid), content) {
            (Some(window), ..) => CellBox::touching(geometry, window),
            (None, Some(known), Some(content)) => known.widened_to(&content).with_margin(),
            (None, None, Some(content)) => content.with_margin(),
            (None, Some(known), None) => known.with_margin(),
            (None, None, None) => CellBox::whole(geometry),
        };
        View::of_cells(geometry, block)
    }

    fn ground(&self, view: &View) -> Canvas {
        match (self.grid, view.cells) {
            (Some(grid), Some((block, zoom))) => paint_cells(grid, block, zoom, view),
            _ => {
                let mut canvas = Canvas::new(view.width, view.height, Color::WHITE);
                paint_lattice(&mut canvas, view);
                canvas
            }
        }
    }
}

#[cfg(test)]
mod tests;
