//! Regions that are one room: no neck is between them, or one is too small for a room.

use super::regions::Regions;
use std::collections::BTreeMap;
use trundle_grid::DistanceField;

/// Width by which a door is narrower than both rooms, below which it is no door \[cells\]. Source: ours.
const MIN_NECK_CELLS: f64 = 4.0;

/// Half of the width below which floor is no room, whatever its area \[m\]. Source: ours; no robot drives between the faces of a wall.
const MIN_HALF_WIDTH_M: f64 = 0.25;

/// The border between two regions.
#[derive(Debug, Clone, Copy, Default)]
struct Border {
    /// Largest clearance on it: half of the width of the widest opening \[m\].
    clearance: f64,
    /// Pairs of cells.
    length: usize,
}

/// Joins regions that no neck separates, then regions below `min_area` m^2 with the neighbour of the longest common border. A small region
/// without a neighbour is no room.
pub(super) fn joined(regions: &mut Regions, field: &DistanceField, min_area: f64) {
    while let Some(pair) = pair_without_neck(regions, field) {
        join(regions, pair);
    }
    for (label, half_width) in widest(regions, field).into_iter().enumerate() {
        if half_width < MIN_HALF_WIDTH_M {
            relabel(regions, label as u32, None);
        }
    }
    let resolution = regions.geometry().resolution;
    let min_cells = (min_area / (resolution * resolution)).ceil() as usize;
    while let Some((small, neighbour)) = smallest_below(regions, field, min_cells) {
        match neighbour {
            Some(neighbour) => join(regions, [neighbour, small]),
            None => relabel(regions, small, None),
        }
    }
}

/// Gives the cells of the second region to the first one.
fn join(regions: &mut Regions, [first, second]: [u32; 2]) {
    relabel(regions, second, Some(first));
}

fn relabel(regions: &mut Regions, label: u32, new: Option<u32>) {
    let mut labels: Vec<Option<u32>> = (0..regions.len() as u32).map(Some).collect();
    labels[label as usize] = new;
    regions.relabel(&labels);
}

/// The pair of regions with the widest opening, if the opening is hardly narrower than one of them.
fn pair_without_neck(regions: &Regions, field: &DistanceField) -> Option<[u32; 2]> {
    let widest = widest(regions, field);
    let min_neck = MIN_NECK_CELLS / 2.0 * regions.geometry().resolution;
    let pairs = borders(regions, field).into_iter().filter(|([a, b], border)| {
        widest[*a as usize].min(widest[*b as usize]) - border.clearance < min_neck
    });
    let best = pairs.reduce(|best, next| if next.1.clearance > best.1.clearance { next } else { best });
    best.map(|(pair, _)| pair)
}

/// Largest clearance in each region: half of its width \[m\].
fn widest(regions: &Regions, field: &DistanceField) -> Vec<f64> {
    let mut widest = vec![0.0_f64; regions.len()];
    for (i, label) in regions.cells().iter().enumerate() {
        if let Some(label) = label {
            let region = &mut widest[*label as usize];
            *region = region.max(field.at_linear(i));
        }
    }
    widest
}

/// The smallest region with fewer cells than `min_cells`, and the neighbour with which it has the longest border.
fn smallest_below(regions: &Regions, field: &DistanceField, min_cells: usize) -> Option<(u32, Option<u32>)> {
    let counts = regions.counts();
    let small = regions.labels().into_iter().filter(|label| counts[*label as usize] < min_cells);
    let small = small.min_by_key(|label| (counts[*label as usize], *label))?;
    let mut longest: Option<(usize, u32)> = None;
    for ([a, b], border) in borders(regions, field) {
        let other = if a == small { b } else { a };
        if (a == small || b == small) && longest.is_none_or(|(length, _)| border.length > length) {
            longest = Some((border.length, other));
        }
    }
    Some((small, longest.map(|(_, other)| other)))
}

fn borders(regions: &Regions, field: &DistanceField) -> BTreeMap<[u32; 2], Border> {
    let mut borders: BTreeMap<[u32; 2], Border> = BTreeMap::new();
    for (pair, [a, b]) in regions.borders() {
        let border = borders.entry(pair).or_default();
        border.clearance = border.clearance.max(field.at_linear(a).min(field.at_linear(b)));
        border.length += 1;
    }
    borders
}
