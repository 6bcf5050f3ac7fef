//! Likelihood field over the surface points of a map.

use crate::SurfacePoints;
use trundle_core::Vector2;

/// Likelihood field \[Thrun05\], sec. 6.4: exp(-d^2 / (2 sigma^2)) of the distance d to the nearest surface point, at the centres of
/// cells; 0 beyond three sigmas.
#[derive(Debug, Clone)]
pub struct LikelihoodField<'a> {
    sites: &'a SurfacePoints,
    corner: Vector2,
    cells_per_metre: f64,
    values: Vec<f32>,
}

impl<'a> LikelihoodField<'a> {
    /// Field of surface points; `sigma` in m.
    pub fn new(sites: &'a SurfacePoints, sigma: f64) -> Self {
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

    /// Likelihood at a point of the map frame (m), 0 to 1; 0 outside the part.
    pub fn at(&self, point: Vector2) -> f32 {
        let within = (point - self.corner) * self.cells_per_metre;
        // Truncation equals rounding down for all values inside the field.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{GridCell, LogOddsGrid};
    use proptest::prelude::*;

    /// Map with these occupied cells, each with a hit in its middle.
    fn map(cells: &[(i32, i32)]) -> LogOddsGrid {
        let mut map = LogOddsGrid::default();
        for &(x, y) in cells {
            let evidence = map.entry(GridCell { x, y });
            evidence.log_odds = 3.0;
            evidence.add_hit(Vector2::repeat(0.5));
        }
        map
    }

    /// The surface points of the cells whose log-odds are above 1.
    fn occupied(map: &LogOddsGrid) -> impl Fn(GridCell) -> Option<Vector2> {
        |cell| map.get(cell).filter(|evidence| evidence.log_odds > 1.0)?.hit()
    }

    proptest! {
        /// The likelihood at the centre of a cell equals that of the nearest surface point, found by exhaustive search.
        #[test]
        fn centres_agree_with_brute_force(cells in prop::collection::btree_set((0..20_i32, 0..20_i32), 1..20)) {
            let cells: Vec<_> = cells.into_iter().collect();
            let (resolution, sigma) = (0.1, 0.15);
            let corners = [Vector2::zeros(), Vector2::repeat(2.0)];
            let points = SurfacePoints::around(occupied(&map(&cells)), resolution, &corners, 0.0).unwrap();
            prop_assert_eq!(points.iter().count(), cells.len());
            let field = LikelihoodField::new(&points, sigma);
            for (x, y) in (0..20).flat_map(|x| (0..20).map(move |y| (x, y))) {
                let at = GridCell { x, y }.center_cells() * resolution;
                let distance = points.iter().map(|p| (p - at).norm()).fold(f64::INFINITY, f64::min);
                let expected = (-0.5 * (distance / sigma).powi(2)).exp();
                let found = f64::from(field.at(at));
                let beyond = distance > 3.0 * sigma - resolution;
                prop_assert!((found - expected).abs() < 1e-6 || (beyond && found <= expected + 1e-6), "{found} {expected}");
            }
        }

        /// Points near a point, by brute force.
        #[test]
        fn near_points_are_those_of_the_square(
            cells in prop::collection::btree_set((0..20_i32, 0..20_i32), 1..30), x in 0..20_i32, y in 0..20_i32, reach in 0..6_i32,
        ) {
            let cells: Vec<_> = cells.into_iter().collect();
            let corners = [Vector2::zeros(), Vector2::repeat(2.0)];
            let points = SurfacePoints::around(occupied(&map(&cells)), 0.1, &corners, 0.0).unwrap();
            let at = GridCell { x, y }.center_cells() * 0.1;
            let expected = cells.iter().filter(|c| (c.0 - x).abs() <= reach && (c.1 - y).abs() <= reach).count();
            prop_assert_eq!(points.near(at, reach).count(), expected);
        }
    }

    #[test]
    fn free_cells_and_cells_without_a_hit_have_no_surface_point() {
        let mut map = map(&[(1, 1), (2, 1)]);
        map.entry(GridCell { x: 1, y: 1 }).log_odds = 0.5;
        map.entry(GridCell { x: 5, y: 5 }).log_odds = 3.0;
        let corners = [Vector2::zeros(), Vector2::repeat(1.0)];
        let points = SurfacePoints::around(occupied(&map), 0.1, &corners, 0.2).unwrap();
        assert_eq!(points.iter().count(), 1);
        assert!((points.iter().next().unwrap() - Vector2::new(0.25, 0.15)).norm() < 1e-6);
        assert!(SurfacePoints::around(occupied(&map), 0.1, &[], 0.2).is_none());
        assert_eq!(LikelihoodField::new(&points, 0.1).at(Vector2::repeat(50.0)), 0.0);
    }
}
