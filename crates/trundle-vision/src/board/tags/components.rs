//! Connected dark regions, and their convex outlines.

use std::collections::BTreeMap;

/// A dark region.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Component {
    /// Convex outline, px: column and row, clockwise in the image.
    pub(super) hull: Vec<(i64, i64)>,
    /// Number of pixels.
    pub(super) pixels: usize,
}

/// Smallest number of pixels of a region: the border of a marker of 12 px. Source: ours.
const MIN_PIXELS: usize = 40;

/// Regions of pixels that share an edge, in the order of their first pixels. Pixels that share a corner only are apart.
pub(super) fn dark_components(mut mask: Vec<bool>, width: usize) -> Vec<Component> {
    let mut components = Vec::new();
    let mut open = Vec::new();
    for start in 0..mask.len() {
        if !mask[start] {
            continue;
        }
        mask[start] = false;
        open.push(start);
        let (mut rows, mut pixels) = (BTreeMap::new(), 0);
        while let Some(at) = open.pop() {
            pixels += 1;
            let x = at % width;
            let extent = rows.entry(at / width).or_insert((x, x));
            *extent = (extent.0.min(x), extent.1.max(x));
            let neighbours = [
                (x > 0).then(|| at - 1),
                (x + 1 < width).then_some(at + 1),
                at.checked_sub(width),
                Some(at + width),
            ];
            for next in neighbours.into_iter().flatten() {
                if mask.get(next) == Some(&true) {
                    mask[next] = false;
                    open.push(next);
                }
            }
        }
        if pixels >= MIN_PIXELS {
            components.push(Component { hull: hull(&rows), pixels });
        }
    }
    components
}

/// Convex hull of rows with their first and last columns.
fn hull(rows: &BTreeMap<usize, (usize, usize)>) -> Vec<(i64, i64)> {
    let right = rows.iter().map(|(y, extent)| (extent.1 as i64, *y as i64));
    let left = rows.iter().rev().map(|(y, extent)| (extent.0 as i64, *y as i64));
    let (mut outline, back) = (chain(right), chain(left));
    outline.extend(back);
    outline.dedup();
    if outline.len() > 1 && outline.first() == outline.last() {
        outline.pop();
    }
    outline
}

/// The points at which a chain turns clockwise.
fn chain(points: impl Iterator<Item = (i64, i64)>) -> Vec<(i64, i64)> {
    let mut kept: Vec<(i64, i64)> = Vec::new();
    for point in points {
        while let [.., a, b] = kept[..] {
            if (b.0 - a.0) * (point.1 - b.1) - (b.1 - a.1) * (point.0 - b.0) > 0 {
                break;
            }
            kept.pop();
        }
        kept.push(point);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_that_touch_at_a_corner_are_two_regions_with_four_corners_each() {
        let inside = |x: usize, y: usize| (2..10).contains(&x) && (1..9).contains(&y);
        let touching = |x: usize, y: usize| (10..18).contains(&x) && (9..17).contains(&y);
        let mask = (0..20 * 20).map(|i| inside(i % 20, i / 20) || touching(i % 20, i / 20)).collect();
        let found = dark_components(mask, 20);
        assert_eq!(found.len(), 2);
        assert_eq!(found[0], Component { hull: vec![(9, 1), (9, 8), (2, 8), (2, 1)], pixels: 64 });
    }
}
