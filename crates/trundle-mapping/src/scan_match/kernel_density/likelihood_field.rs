//! Likelihood field over the surface points of a map.

use super::surface_points::SurfacePoints;
use trundle_core::Vector2;

/// A likelihood field (Thrun, Probabilistic Robotics, sec. 6.4): exp(-d^2 / (2 sigma^2)) of the distance d to the nearest
/// obstacle, at the middles of cells; 0 beyond three sigmas.
#[derive(Debug, Clone)]
pub(crate) struct LikelihoodField<'a> {
    sites: &'a SurfacePoints,
    corner: Vector2,
    cells_per_metre: f64,
    values: Vec<f32>,
}

impl<'a> LikelihoodField<'a> {
    pub(crate) fn new(sites: &'a SurfacePoints, sigma: f64) -> Self {
        let mut field = Self {
            sites,
            corner: sites.center(0, 0) - Vector2::repeat(sites.resolution / 2.0),
            cells_per_metre: 1.0 / sites.resolution,
            values: vec![0.0; sites.width * sites.height],
        };
        let reach = (3.0 * sigma / sites.resolution).ceil() as i32;
        for site in sites.iter() {
            field.splat(site, sigma, reach);
        }
        field
    }

    /// The value at a point of the map frame (m).
    pub(crate) fn at(&self, point: Vector2) -> f32 {
        let within = (point - self.corner) * self.cells_per_metre;
        // Cutting off the fraction is rounding down where it matters: in the field.
        let inside = within.x >= 0.0 && within.y >= 0.0;
        let index = if inside { self.index(within.x as i32, within.y as i32) } else { None };
        index.map_or(0.0, |i| self.values[i])
    }

    fn splat(&mut self, site: Vector2, sigma: f64, reach: i32) {
        let (col, row) = self.sites.column_and_row(site);
        let scale = -0.5 / (sigma * sigma);
        for r in row - reach..=row + reach {
            let y = self.sites.center(col, r).y - site.y;
            let of_row = (scale * y * y).exp();
            for c in col - reach..=col + reach {
                let Some(i) = self.index(c, r) else { continue };
                let x = self.sites.center(c, r).x - site.x;
                let value = (of_row * (scale * x * x).exp()) as f32;
                self.values[i] = self.values[i].max(value);
            }
        }
    }

    fn index(&self, col: i32, row: i32) -> Option<usize> {
        let inside =
            col >= 0 && row >= 0 && (col as usize) < self.sites.width && (row as usize) < self.sites.height;
        inside.then(|| row as usize * self.sites.width + col as usize)
    }
}
