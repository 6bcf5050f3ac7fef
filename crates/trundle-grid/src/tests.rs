//! Laws of the grids that several modules make together.

use crate::{GridCell, LogOddsGrid, MapperConfig, PublishedGrid, ScanCells, Thresholds, ray_cells};
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::f64::consts::FRAC_PI_2;
use trundle_core::{Beam, Cell, Pose2, Scan, Stamp, Vector2};

/// Settings whose cells of 1/16 m are exact in binary.
fn exact() -> MapperConfig {
    MapperConfig { resolution: 0.0625, max_range: 4.0, blind_range: 0.0, ..MapperConfig::default() }
}

fn any_scan() -> impl Strategy<Value = Scan> {
    let beam = prop_oneof![
        (0.3..5.0_f64).prop_map(|range| Beam::Hit { range }),
        (0.3..5.0_f64).prop_map(|range| Beam::Free { range }),
        Just(Beam::Unseen),
    ];
    prop::collection::vec(beam, 1..60)
        .prop_map(|beams| Scan::new(Stamp::default(), Vector2::zeros(), -0.71, 0.023, beams).unwrap())
}

fn rasterised(config: &MapperConfig, pose: Pose2, scan: &Scan) -> ScanCells {
    let mut cells = ScanCells::default();
    cells.rasterise(config, pose, scan, |_| false);
    cells
}

type CellSet = BTreeSet<(i32, i32)>;

/// Hit cells and free cells, each moved.
fn sets(cells: &ScanCells, by: impl Fn(GridCell) -> (i32, i32)) -> (CellSet, CellSet) {
    let hits = cells.hits.iter().map(|hit| by(hit.cell)).collect();
    (hits, cells.free.iter().map(|cell| by(*cell)).collect())
}

proptest! {
    /// A scan from a pose moved by whole cells gives the cells moved by as much.
    #[test]
    fn cells_of_a_scan_move_with_the_robot(
        scan in any_scan(), x in -64..64_i32, y in -64..64_i32, theta in -3.0..3.0_f64,
    ) {
        let config = exact();
        let here = rasterised(&config, Pose2::new(0.53125, 0.28125, theta), &scan);
        let by = |v: i32| f64::from(v) * config.resolution;
        let there = rasterised(&config, Pose2::new(0.53125 + by(x), 0.28125 + by(y), theta), &scan);
        // Rounding may move a point on a border: at most one cell per scan.
        let (moved, found) = (sets(&here, |c| (c.x + x, c.y + y)), sets(&there, |c| (c.x, c.y)));
        prop_assert!(moved.0.symmetric_difference(&found.0).count() <= 2);
        prop_assert!(moved.1.symmetric_difference(&found.1).count() <= 2);
    }

    /// No cell is both hit and free, and the free cells are on rays of the scan.
    #[test]
    fn hits_and_free_cells_are_apart_and_within_range(scan in any_scan(), theta in -3.0..3.0_f64) {
        let config = exact();
        let cells = rasterised(&config, Pose2::new(0.5, 0.3, theta), &scan);
        let (hits, free) = sets(&cells, |c| (c.x, c.y));
        prop_assert!(hits.is_disjoint(&free));
        prop_assert_eq!((hits.len(), free.len()), (cells.hits.len(), cells.free.len()), "each cell once");
        let reach = config.max_range / config.resolution + 1.5;
        let all = cells.free.iter().copied().chain(cells.hits.iter().map(|hit| hit.cell));
        for cell in all {
            prop_assert!((cell.center_cells() - cells.origin).norm() <= reach);
        }
        for hit in &cells.hits {
            let mean = hit.mean_within();
            prop_assert!(mean.min() >= -1e-9 && mean.max() <= 1.0 + 1e-9);
        }
        if let Some((low, high)) = cells.reach() {
            let inside = |c: &(i32, i32)| c.0 >= low.x && c.1 >= low.y && c.0 <= high.x && c.1 <= high.y;
            prop_assert!(hits.iter().chain(&free).all(inside));
        } else {
            prop_assert!(hits.is_empty() && free.is_empty());
        }
    }

    /// A line and the line turned by a right angle visit cells turned by a right angle.
    #[test]
    fn rays_turn_with_the_grid(x in -20.0..20.0, y in -20.0..20.0, u in -20.0..20.0, v in -20.0..20.0) {
        let (from, to) = (Vector2::new(x, y), Vector2::new(u, v));
        let turned = |p: Vector2| Vector2::new(-p.y, p.x);
        let plain: CellSet = ray_cells(from, to).map(|c| (-c.y - 1, c.x)).collect();
        let other: CellSet = ray_cells(turned(from), turned(to)).map(|c| (c.x, c.y)).collect();
        prop_assert_eq!(plain, other);
        let pose = Pose2::new(0.0, 0.0, FRAC_PI_2);
        prop_assert!((pose.transform(from) - turned(from)).norm() < 1e-9);
    }

    #[test]
    fn a_line_backwards_visits_the_same_cells(x in -20.0..20.0, y in -20.0..20.0, u in -20.0..20.0, v in -20.0..20.0) {
        let (from, to) = (Vector2::new(x, y), Vector2::new(u, v));
        let cells = |a, b| ray_cells(a, b).map(|c| (c.x, c.y)).collect::<CellSet>();
        prop_assert!(cells(from, to).symmetric_difference(&cells(to, from)).count() <= 2, "but for corners");
    }

    /// Writing a tile as a whole and cell by cell gives the same grid.
    #[test]
    fn a_published_tile_is_its_cells(values in prop::collection::vec(0..3_u8, 64), tile in (-3..3_i32, -3..3_i32)) {
        let class = |v: u8| [Cell::Free, Cell::Occupied, Cell::Unknown][usize::from(v)];
        let mut whole = PublishedGrid::new(0.1, 8, (-3, -3), (6, 6));
        let mut single = whole.clone();
        whole.begin_revision();
        single.begin_revision();
        whole.set_tile(tile, |x, y| class(values[8 * y + x]));
        for (i, value) in values.iter().enumerate() {
            let cell = GridCell { x: 8 * tile.0 + i as i32 % 8, y: 8 * tile.1 + i as i32 / 8 };
            single.set(cell, class(*value));
        }
        prop_assert_eq!(whole.grid(), single.grid());
        prop_assert_eq!(whole.changes_since(0).count(), 1);
        let changed = values.iter().any(|v| class(*v) != Cell::Unknown);
        prop_assert_eq!(single.changes_since(0).count(), usize::from(changed));
    }

    /// A published grid keeps its cells when it grows in any direction.
    #[test]
    fn growth_moves_no_published_cell(
        writes in prop::collection::vec((0..32_i32, 0..32_i32), 1..20), low in -5..1_i32, high in 3..9_i32,
    ) {
        let mut grid = PublishedGrid::new(0.25, 8, (0, 0), (4, 4));
        grid.begin_revision();
        writes.iter().for_each(|(x, y)| grid.set(GridCell { x: *x, y: *y }, Cell::Occupied));
        let before = grid.clone();
        let changes = grid.changes_since(0).count();
        grid.reach((low, low), (high, high));
        prop_assert_eq!(grid.changes_since(0).count(), changes);
        for (x, y) in (-40..72).flat_map(|x| (-40..72).map(move |y| (x, y))) {
            let at = GridCell { x, y }.center_cells() * 0.25;
            prop_assert_eq!(grid.grid().at(at), before.grid().at(at));
        }
    }

    /// Clones of a grid, written alternately, never share cells.
    #[test]
    fn clones_of_a_log_odds_grid_are_independent(
        writes in prop::collection::vec((0..3_usize, -200..200_i32, -200..200_i32, -3.0..3.0_f32), 1..60),
    ) {
        let mut grids = vec![LogOddsGrid::default()];
        let mut models = vec![std::collections::BTreeMap::new()];
        for (i, x, y, value) in writes {
            if i == 2 && grids.len() < 4 {
                grids.push(grids[0].clone());
                models.push(models[0].clone());
            }
            let k = i % grids.len();
            grids[k].entry(GridCell { x, y }).log_odds = value;
            models[k].insert((x, y), value);
        }
        for (grid, model) in grids.iter().zip(&models) {
            let tiles: BTreeSet<_> = model.keys().map(|(x, y)| (x >> 6, y >> 6)).collect();
            prop_assert_eq!(grid.tile_count(), tiles.len());
            for (&(x, y), value) in model {
                prop_assert_eq!(grid.log_odds(GridCell { x, y }), *value);
            }
        }
    }
}

#[test]
fn every_setting_out_of_its_range_is_refused_by_name() {
    let base = MapperConfig::default;
    let cases = [
        ("resolution", MapperConfig { resolution: 0.001, ..base() }),
        ("resolution", MapperConfig { resolution: f64::NAN, ..base() }),
        ("hit", MapperConfig { hit: 0.0, ..base() }),
        ("free", MapperConfig { free: 11.0, ..base() }),
        ("clamp_high", MapperConfig { clamp_high: 101.0, ..base() }),
        ("clamp_low", MapperConfig { clamp_low: 0.0, ..base() }),
        ("occupied_above", MapperConfig { occupied_above: 0.4, ..base() }),
        ("free_below", MapperConfig { free_below: 0.6, ..base() }),
        ("max_range", MapperConfig { max_range: 500.0, ..base() }),
        ("blind_range", MapperConfig { blind_range: -0.1, ..base() }),
        ("surface_gap", MapperConfig { surface_gap: 3.0, ..base() }),
        ("half_extent", MapperConfig { half_extent: 0.5, ..base() }),
    ];
    for (field, config) in cases {
        assert_eq!(config.validated().unwrap_err().field, field);
    }
}

#[test]
fn a_threshold_itself_is_unknown_in_every_number_type() {
    let bytes = Thresholds { occupied_above: 20_i8, free_below: -45 };
    assert_eq!([-46, -45, 0, 20, 21].map(|l| bytes.classify(l)), {
        [Cell::Free, Cell::Unknown, Cell::Unknown, Cell::Unknown, Cell::Occupied]
    });
    let real = Thresholds { occupied_above: 0.6_f64, free_below: -1.4 };
    assert_eq!(real.classify(f64::NAN), Cell::Unknown);
}
