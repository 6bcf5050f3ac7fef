//! The cells of zones: no-go zones as keep-out masks, slow zones as speed masks.

use super::speed_mask::SpeedMask;
use std::ops::Range;
use trundle_core::{Cell, CellIndex, GridGeometry, Invalid, OccupancyGrid, Vector2, Zone, ZoneKind};

/// Maximum number of cells of a speed mask. Larger zones get larger cells. Source: ours; 4 MB.
const MAX_SPEED_MASK_CELLS: f64 = 1e6;

/// Occupies every cell of a grid that a no-go zone touches.
pub fn forbid(grid: &mut OccupancyGrid, zone: &Zone) {
    if zone.kind == ZoneKind::NoGo {
        let geometry = *grid.geometry();
        touched_cells(&geometry, zone, |cell| grid.set(cell, Cell::Occupied));
    }
}

/// The keep-out mask of zones over a map's cells: a cell is occupied if a no-go zone touches it, else free.
#[must_use]
pub fn forbidden_cells<'z>(
    geometry: GridGeometry,
    zones: impl IntoIterator<Item = &'z Zone>,
) -> OccupancyGrid {
    let mut mask = OccupancyGrid::filled(geometry, Cell::Free);
    zones.into_iter().for_each(|zone| forbid(&mut mask, zone));
    mask
}

/// The speed limits of zones, with cells of `resolution` \[m\], or larger cells for a large zone; `None` without a slow zone. The lowest
/// limit applies where zones overlap.
#[must_use]
pub fn slow_speeds<'z>(
    resolution: f64,
    zones: impl IntoIterator<Item = &'z Zone> + Clone,
) -> Option<SpeedMask> {
    let slow = |zone: &'z Zone| match zone.kind {
        ZoneKind::Slow(speed) => Some((zone, speed)),
        ZoneKind::NoGo | ZoneKind::Area => None,
    };
    let bounds = zones.clone().into_iter().filter_map(slow).map(|(zone, _)| zone.bounds());
    let (low, high) = bounds.reduce(|a, b| (a.0.inf(&b.0), a.1.sup(&b.1)))?;
    let span = high - low;
    let resolution = resolution.max((span.x * span.y / MAX_SPEED_MASK_CELLS).sqrt()).max(span.max() / 1e5);
    let cells = (span / resolution).map(|cells| cells.floor() + 1.0);
    let geometry = GridGeometry::new(resolution, low, cells.x as usize, cells.y as usize).ok()?;
    let mut limits = vec![f32::INFINITY; geometry.len()];
    for (zone, speed) in zones.into_iter().filter_map(slow) {
        touched_cells(&geometry, zone, |cell| {
            let limit = &mut limits[geometry.linear(cell)];
            *limit = limit.min(speed as f32);
        });
    }
    SpeedMask::new(geometry, limits).ok()
}

/// Checks that a zone overlaps the map.
///
/// # Errors
/// When the zone is completely outside the map.
pub fn require_on_map(zone: &Zone, map: &GridGeometry) -> Result<(), Invalid> {
    let (low, high) = zone.bounds();
    let end = map.origin + Vector2::new(map.width as f64, map.height as f64) * map.resolution;
    let is_beside = (0..2).any(|axis| high[axis] <= map.origin[axis] || low[axis] >= end[axis]);
    if is_beside {
        let value = format!("x {:.2} to {:.2}, y {:.2} to {:.2}", low.x, high.x, low.y, high.y);
        let expected = format!(
            "a part of the map, x {:.2} to {:.2} m, y {:.2} to {:.2} m",
            map.origin.x, end.x, map.origin.y, end.y
        );
        return Err(Invalid::new(zone.label(), value, "m", expected));
    }
    Ok(())
}

/// Calls `visit` for every cell that the zone touches; for some more than once.
fn touched_cells(geometry: &GridGeometry, zone: &Zone, mut visit: impl FnMut(CellIndex)) {
    let corners = zone.corners();
    let (low, high) = zone.bounds();
    let rows =
        cells_between(low.y - geometry.origin.y, high.y - geometry.origin.y, geometry, geometry.height);
    for row in rows {
        let bottom = geometry.origin.y + row as f64 * geometry.resolution;
        for (left, right) in spans(&corners, bottom, geometry.resolution) {
            let (left, right) = (left - geometry.origin.x, right - geometry.origin.x);
            cells_between(left, right, geometry, geometry.width)
                .for_each(|col| visit(CellIndex { col, row }));
        }
    }
}

/// The cells that an interval touches, distances from the grid's origin \[m\].
fn cells_between(low: f64, high: f64, geometry: &GridGeometry, cells: usize) -> Range<usize> {
    let first = (low / geometry.resolution).floor().clamp(0.0, cells as f64) as usize;
    let last = (high / geometry.resolution).floor().clamp(-1.0, cells as f64 - 1.0);
    first..((last + 1.0) as usize).max(first)
}

/// The intervals of x \[m\] in which an outline or its inside touches a row of cells; the row starts at y = `bottom` \[m\] and has the
/// height of a cell.
fn spans(corners: &[Vector2], bottom: f64, height: f64) -> Vec<(f64, f64)> {
    let top = bottom + height;
    let sides = || corners.iter().zip(corners.iter().cycle().skip(1));
    let x_at =
        |a: &Vector2, b: &Vector2, y: f64| a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)).clamp(0.0, 1.0);
    let mut spans: Vec<(f64, f64)> = sides()
        .filter(|(a, b)| a.y.max(b.y) >= bottom && a.y.min(b.y) < top)
        .map(|(a, b)| match a.y == b.y {
            true => (a.x.min(b.x), a.x.max(b.x)),
            false => {
                let ends = [x_at(a, b, bottom.max(a.y.min(b.y))), x_at(a, b, top.min(a.y.max(b.y)))];
                (ends[0].min(ends[1]), ends[0].max(ends[1]))
            }
        })
        .collect();
    let middle = f64::midpoint(bottom, top);
    let mut crossings: Vec<f64> =
        sides().filter(|(a, b)| (a.y > middle) != (b.y > middle)).map(|(a, b)| x_at(a, b, middle)).collect();
    crossings.sort_by(f64::total_cmp);
    spans.extend(crossings.chunks_exact(2).map(|pair| (pair[0], pair[1])));
    spans
}

#[cfg(test)]
mod tests {
    use super::*;

    fn zone(kind: ZoneKind, outline: &[[f64; 2]]) -> Zone {
        Zone { id: 1, name: String::new(), kind, outline: outline.to_vec() }.validated().unwrap()
    }

    fn square(kind: ZoneKind, low: f64, high: f64) -> Zone {
        zone(kind, &[[low, low], [high, low], [high, high], [low, high]])
    }

    fn geometry() -> GridGeometry {
        GridGeometry::new(0.1, Vector2::new(-1.0, -1.0), 40, 30).unwrap()
    }

    #[test]
    fn every_cell_that_a_zone_touches_is_forbidden_and_no_other() {
        let l = [[0.01, 0.01], [1.63, 0.22], [1.41, 1.37], [0.97, 0.93], [0.52, 1.88]];
        let sliver = [[-0.8, -0.75], [2.4, -0.74], [2.4, -0.739]];
        for outline in [&l[..], &sliver[..]] {
            let zone = zone(ZoneKind::NoGo, outline);
            let mask = forbidden_cells(geometry(), [&zone]);
            // By many points: inside of the outline, or on a side.
            let corners = zone.corners();
            let mut expected = OccupancyGrid::filled(geometry(), Cell::Free);
            let mut note = |at: Vector2| {
                geometry().cell_at(at).into_iter().for_each(|cell| expected.set(cell, Cell::Occupied));
            };
            for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
                (0..=20_000).for_each(|k| note(a + (b - a) * f64::from(k) / 20_000.0));
            }
            for i in 0..400 {
                for j in 0..300 {
                    let at = Vector2::new(-0.995 + 0.01 * f64::from(i), -0.995 + 0.01 * f64::from(j));
                    let sides = corners.iter().zip(corners.iter().cycle().skip(1));
                    let crossings = sides.filter(|(a, b)| {
                        (a.y > at.y) != (b.y > at.y) && at.x < a.x + (b.x - a.x) * (at.y - a.y) / (b.y - a.y)
                    });
                    if crossings.count() % 2 == 1 {
                        note(at);
                    }
                }
            }
            let (mask, expected) = (mask.cells(), expected.cells());
            let missing =
                expected.iter().zip(mask).filter(|(e, m)| **e == Cell::Occupied && **m == Cell::Free);
            assert_eq!(missing.count(), 0);
            let extra = expected.iter().zip(mask).filter(|(e, m)| **e == Cell::Free && **m == Cell::Occupied);
            assert!(extra.count() <= 1, "a cell that is touched at a corner alone");
        }
    }

    #[test]
    fn zones_beyond_the_map_and_of_other_kinds_forbid_nothing() {
        let far = zone(ZoneKind::NoGo, &[[50.0, 50.0], [1e6, 50.0], [50.0, 1e6]]);
        let others = [square(ZoneKind::Slow(0.1), 0.0, 1.0), square(ZoneKind::Area, 0.0, 1.0), far.clone()];
        let mask = forbidden_cells(geometry(), &others);
        assert!(mask.cells().iter().all(|cell| *cell == Cell::Free));
        let all = zone(ZoneKind::NoGo, &[[-1e6, -1e6], [1e6, -1e6], [1e6, 1e6], [-1e6, 1e6]]);
        assert!(forbidden_cells(geometry(), [&all]).cells().iter().all(|cell| *cell == Cell::Occupied));
        assert!(require_on_map(&all, &geometry()).is_ok());
        let refusal = require_on_map(&far, &geometry()).unwrap_err().to_string();
        assert_eq!(
            refusal,
            "zone 1 is x 50.00 to 1000000.00, y 50.00 to 1000000.00 m, expected a part of the map, x -1.00 to 3.00 m, y -1.00 to 2.00 m"
        );
    }

    #[test]
    fn slow_zones_limit_the_speed_and_the_lowest_limit_counts() {
        assert_eq!(slow_speeds(0.05, &[square(ZoneKind::NoGo, 0.0, 1.0)]), None);
        let zones = [square(ZoneKind::Slow(0.3), 0.0, 2.0), square(ZoneKind::Slow(0.1), 1.0, 3.0)];
        let mask = slow_speeds(0.05, &zones).unwrap();
        let limit = |at: f64| mask.limit(Vector2::repeat(at));
        assert!(
            (limit(0.5) - 0.3).abs() < 1e-6
                && (limit(1.5) - 0.1).abs() < 1e-6
                && (limit(2.9) - 0.1).abs() < 1e-6
        );
        assert_eq!((limit(-0.01), limit(3.2)), (f64::INFINITY, f64::INFINITY));
        let huge = zone(ZoneKind::Slow(0.2), &[[-1e6, -1e6], [1e6, -1e6], [1e6, 1e6], [-1e6, 1e6]]);
        assert!((slow_speeds(0.05, [&huge]).unwrap().limit(Vector2::zeros()) - 0.2).abs() < 1e-6);
        let long = zone(ZoneKind::Slow(0.2), &[[-1e6, 0.0], [1e6, 0.0], [1e6, 0.1], [-1e6, 0.1]]);
        assert!(slow_speeds(0.05, [&long]).is_some());
    }
}
