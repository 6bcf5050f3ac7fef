//! Pairs of scans that observe the same place.

use std::collections::BTreeMap;
use trundle_core::Vector2;

/// Numbers of scans back to the neighbours with which a scan is matched. Source: ours: growing distances bridge a bad scan, and each
/// is within 4 m of path at a gate of 0.3 m.
const NEIGHBOUR_STEPS: [usize; 4] = [1, 2, 4, 8];
/// Largest distance of the centres of two views that count as one place \[m\]. Source: ours, a doorway and the room behind it.
const PLACE_DISTANCE_M: f64 = 2.0;
/// Largest number of scans of another pass with which a scan is matched. Source: ours.
const MAX_SCANS_PER_PASS: usize = 2;
/// Largest number of passes with which a scan is matched, the newest ones. Older ones would couple all passes with the first, and the factor
/// of the graph would grow with the square of the time in one place. Source: ours.
const MAX_PASSES: usize = 2;
/// Number of scans between two passes of a place. Source: ours, 6 m at a gate of 0.3 m: more than two place distances and a turn.
const MIN_PASS_STEP: usize = 20;

/// Pairs (later scan, earlier scan) by the centres of the views (map frame, m): at most eight for a scan.
///
/// A scan is paired with its neighbours, and with the nearest scans of the newest earlier passes.
pub(super) fn pairs(centres: &[Vector2]) -> Vec<(usize, usize)> {
    let mut places = Places::default();
    let mut found = Vec::new();
    for (k, centre) in centres.iter().enumerate() {
        found.extend(NEIGHBOUR_STEPS.iter().filter_map(|step| Some((k, k.checked_sub(*step)?))));
        let near = places.near(centres, k);
        let passes: Vec<&[usize]> = near.chunk_by(|a, b| b - a < MIN_PASS_STEP).collect();
        for pass in passes.iter().rev().take(MAX_PASSES) {
            found.extend(nearest(centres, *centre, pass).into_iter().map(|j| (k, j)));
        }
        places.add(k, *centre);
    }
    found
}

/// The scans of a pass with the nearest centres.
fn nearest(centres: &[Vector2], centre: Vector2, pass: &[usize]) -> Vec<usize> {
    let distance = |j: usize| (centres[j] - centre).norm();
    let mut sorted = pass.to_vec();
    sorted.sort_by(|&a, &b| distance(a).total_cmp(&distance(b)).then(a.cmp(&b)));
    sorted.truncate(MAX_SCANS_PER_PASS);
    sorted
}

/// Scans by squares of the map.
#[derive(Debug, Default)]
struct Places {
    scans: BTreeMap<(i64, i64), Vec<usize>>,
}

/// Largest number of scans remembered in a square, the newest ones. Source: ours: it bounds the time of a robot that stays.
const MAX_SCANS_PER_SQUARE: usize = 64;

impl Places {
    fn square(centre: Vector2) -> (i64, i64) {
        let side = |v: f64| (v / PLACE_DISTANCE_M).floor() as i64;
        (side(centre.x), side(centre.y))
    }

    fn add(&mut self, k: usize, centre: Vector2) {
        let scans = self.scans.entry(Self::square(centre)).or_default();
        if scans.len() == MAX_SCANS_PER_SQUARE {
            scans.remove(0);
        }
        scans.push(k);
    }

    /// Scans of other passes at the place of scan `k`, in their order.
    fn near(&self, centres: &[Vector2], k: usize) -> Vec<usize> {
        let (x, y) = Self::square(centres[k]);
        let squares = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (x + dx, y + dy)));
        let is_near =
            |&j: &usize| j + MIN_PASS_STEP <= k && (centres[j] - centres[k]).norm() < PLACE_DISTANCE_M;
        let mut near: Vec<usize> =
            squares.filter_map(|square| self.scans.get(&square)).flatten().copied().filter(is_near).collect();
        near.sort_unstable();
        near
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_and_other_passes_are_paired_and_other_places_are_not() {
        // Along a corridor of 30 m and back.
        let along = |k: usize| 0.3 * if k < 100 { k } else { 199 - k } as f64;
        let centres: Vec<Vector2> = (0..200).map(|k| Vector2::new(along(k), 0.1)).collect();
        let pairs = pairs(&centres);
        assert!(pairs.contains(&(8, 0)) && pairs.contains(&(51, 50)));
        assert!(pairs.contains(&(199, 0)) && pairs.contains(&(150, 49)));
        let apart = |&&(k, j): &&(usize, usize)| k - j > 8;
        assert!(pairs.iter().filter(apart).all(|&(k, j)| (centres[k] - centres[j]).norm() < 2.0));
        assert!(pairs.iter().filter(apart).count() <= 2 * 100);
    }

    #[test]
    fn the_number_of_pairs_of_a_scan_is_bounded_even_if_the_robot_stays_or_laps() {
        let stays = vec![Vector2::new(1.0, 1.0); 3000];
        let laps: Vec<Vector2> = (0..3000)
            .map(|k| {
                let (s, c) = (0.05 * f64::from(k)).sin_cos();
                Vector2::new(6.0 * c, 6.0 * s)
            })
            .collect();
        for centres in [stays, laps] {
            let mut counts = vec![0; 3000];
            pairs(&centres).iter().for_each(|pair| counts[pair.0] += 1);
            assert!(counts.iter().all(|count| *count <= 8), "{:?}", counts.iter().max());
        }
    }
}
