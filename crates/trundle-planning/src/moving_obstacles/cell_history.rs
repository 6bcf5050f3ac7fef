//! Recent observations per cell, in a window of cells that moves with the robot.

use trundle_core::Vector2;

/// Side of a cell, m. Source: ours.
pub(super) const CELL_SIDE_M: f64 = 0.05;
/// Time of free observations after which a hit cell counts as left, s: measurements of walls flicker. Source: ours.
const MAX_FLICKER_S: f64 = 0.5;
/// Distance from static objects within which no arrival is detected, cells: pose and range are not exact. Source: ours.
const STATIC_MARGIN_CELLS: i32 = 2;
/// Distance within which a hit belongs to an object that was put down, cells. Source: ours.
const SAME_OBJECT_CELLS: i32 = 4;
/// Time of an event that has not occurred.
const NEVER_S: f64 = f64::NEG_INFINITY;

/// A cell's column and row; cell (0, 0) begins at the map's origin.
type CellKey = (i32, i32);

/// Observations of a cell.
#[derive(Debug, Clone, Copy)]
struct Observed {
    key: CellKey,
    /// Time last seen free, s.
    free_at: f64,
    /// Time last hit, s.
    hit_at: f64,
    /// Start of the present sequence of hits, s.
    since: f64,
    /// Whether the cell was seen free shortly before that start.
    arrived: bool,
    /// Position of the last hit.
    hit: Vector2,
}

impl Observed {
    /// No observation.
    fn of(key: CellKey) -> Self {
        Self { key, free_at: NEVER_S, hit_at: NEVER_S, since: NEVER_S, arrived: false, hit: Vector2::zeros() }
    }

    /// Whether the newest observation is a hit.
    fn is_hit_last(&self) -> bool {
        self.hit_at > self.free_at
    }
}

/// Cells around the robot in a ring buffer: each cell has a slot, shared with the cells a window away.
#[derive(Debug)]
pub(super) struct CellHistory {
    slots: Vec<Observed>,
    /// Slots along a side, a power of two.
    width: i32,
    memory: f64,
}

impl CellHistory {
    /// A window of this radius, m. `memory`: time for which a cell counts as newly occupied, s.
    pub(super) fn new(reach: f64, memory: f64) -> Self {
        let width = ((2.0 * reach / CELL_SIDE_M).ceil() as usize + 2).next_power_of_two();
        let nothing = Observed::of((i32::MAX, i32::MAX));
        Self { slots: vec![nothing; width * width], width: width as i32, memory }
    }

    /// Adds a free observation.
    pub(super) fn free(&mut self, point: Vector2, time: f64) {
        let seen = self.slot_mut(key_of(point));
        // A beam next to a hit may pass through the same cell.
        if seen.hit_at < time {
            seen.free_at = time;
        }
    }

    /// Adds a hit.
    pub(super) fn hit(&mut self, point: Vector2, time: f64) {
        let memory = self.memory;
        let seen = self.slot_mut(key_of(point));
        let is_new =
            seen.hit_at == NEVER_S || (seen.free_at > seen.hit_at && time - seen.hit_at > MAX_FLICKER_S);
        if is_new {
            (seen.since, seen.arrived) = (time, time - seen.free_at <= memory);
        }
        (seen.hit_at, seen.hit) = (time, point);
    }

    /// Whether the object hit at a point arrived recently, without a static object next to the point.
    pub(super) fn has_arrived(&self, point: Vector2, time: f64) -> bool {
        let key = key_of(point);
        self.observed(key).is_some_and(|seen| seen.arrived && time - seen.since <= self.memory)
            && !around(key, STATIC_MARGIN_CELLS).any(|near| self.is_static(near, time))
    }

    /// Whether a point belongs to an object that arrived and stayed.
    pub(super) fn is_part_of_static(&self, point: Vector2, time: f64) -> bool {
        around(key_of(point), SAME_OBJECT_CELLS)
            .any(|near| self.observed(near).is_some_and(|seen| seen.arrived) && self.is_static(near, time))
    }

    /// Whether a point was hit a moment ago.
    pub(super) fn is_hit(&self, point: Vector2, time: f64) -> bool {
        self.observed(key_of(point)).is_some_and(|seen| time - seen.hit_at <= MAX_FLICKER_S)
    }

    /// Whether a point was observed free recently, without a static object at the point.
    pub(super) fn is_open(&self, point: Vector2, time: f64) -> bool {
        let key = key_of(point);
        self.observed(key).is_some_and(|seen| time - seen.free_at <= 2.0 * self.memory)
            && !self.is_static(key, time)
    }

    /// Whether a point was seen free after a time.
    pub(super) fn is_free_since(&self, point: Vector2, time: f64) -> bool {
        self.observed(key_of(point)).is_some_and(|seen| seen.free_at > time)
    }

    /// Hits within `reach` m of a point since a time, from objects that arrived. Hits next to a static object, hits observed free since
    /// then and single hits (noise) are left out.
    pub(super) fn unconfirmed_hits(&self, point: Vector2, reach: f64, since: f64) -> Vec<Vector2> {
        let is_there = |seen: &&Observed| seen.arrived && seen.is_hit_last() && seen.hit_at >= since;
        let there = |key: CellKey| self.observed(key).filter(is_there);
        let is_static =
            |key: CellKey| self.observed(key).is_some_and(|seen| seen.is_hit_last() && !seen.arrived);
        around(key_of(point), (reach / CELL_SIDE_M).ceil() as i32)
            .filter_map(there)
            .filter(|seen| (seen.hit - point).norm() <= reach)
            .filter(|seen| !around(seen.key, STATIC_MARGIN_CELLS).any(is_static))
            .filter(|seen| around(seen.key, STATIC_MARGIN_CELLS).filter_map(there).count() > 1)
            .map(|seen| seen.hit)
            .collect()
    }

    /// Whether a point was hit after a time.
    pub(super) fn is_hit_since(&self, point: Vector2, time: f64) -> bool {
        self.observed(key_of(point)).is_some_and(|seen| seen.hit_at > time)
    }

    /// Whether a static object, one that did not arrive during observation, is at or next to a point.
    pub(super) fn is_wall(&self, point: Vector2) -> bool {
        let stays = |seen: &Observed| seen.is_hit_last() && !seen.arrived;
        around(key_of(point), 1).any(|key| self.observed(key).is_some_and(stays))
    }

    /// Whether the newest observation of a point is free.
    pub(super) fn is_left(&self, point: Vector2) -> bool {
        self.observed(key_of(point)).is_some_and(|seen| seen.free_at > seen.hit_at)
    }

    fn is_static(&self, key: CellKey, time: f64) -> bool {
        self.observed(key).is_some_and(|seen| {
            let is_there = seen.hit_at > seen.free_at || time - seen.hit_at <= MAX_FLICKER_S;
            seen.hit_at > NEVER_S && is_there && (!seen.arrived || time - seen.since > self.memory)
        })
    }

    fn observed(&self, key: CellKey) -> Option<&Observed> {
        let seen = &self.slots[self.slot(key)];
        (seen.key == key).then_some(seen)
    }

    /// The slot of a cell, cleared if it held another cell.
    fn slot_mut(&mut self, key: CellKey) -> &mut Observed {
        let slot = self.slot(key);
        let seen = &mut self.slots[slot];
        if seen.key != key {
            *seen = Observed::of(key);
        }
        seen
    }

    fn slot(&self, (col, row): CellKey) -> usize {
        let mask = self.width - 1;
        ((row & mask) * self.width + (col & mask)) as usize
    }
}

/// The cells at most `reach` cells off along either axis.
fn around((col, row): CellKey, reach: i32) -> impl Iterator<Item = CellKey> {
    (-reach..=reach).flat_map(move |dy| (-reach..=reach).map(move |dx| (col + dx, row + dy)))
}

fn key_of(point: Vector2) -> CellKey {
    ((point.x / CELL_SIDE_M).floor() as i32, (point.y / CELL_SIDE_M).floor() as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrivals_are_separated_from_static_objects() {
        let mut cells = CellHistory::new(1.0, 3.0);
        let (here, wall) = (Vector2::new(0.52, 0.52), Vector2::new(-0.52, 0.52));
        cells.hit(wall, 0.0);
        cells.free(here, 0.0);
        cells.hit(here, 0.1);
        cells.hit(wall, 0.1);
        assert!(cells.has_arrived(here, 0.1) && !cells.has_arrived(wall, 0.1));
        // Next to a wall no arrival is detected, even if measurements of the wall flicker.
        let beside = wall + Vector2::new(0.05, 0.0);
        cells.free(beside, 0.1);
        cells.hit(beside, 0.2);
        cells.free(wall, 0.2);
        assert!(!cells.has_arrived(beside, 0.2) && !cells.has_arrived(wall, 0.2));
        cells.hit(here, 3.2);
        assert!(!cells.has_arrived(here, 3.2), "static after the memory time");
        // A window farther on, the slots belong to other cells.
        let far = here + Vector2::new(f64::from(cells.width) * CELL_SIDE_M, 0.0);
        cells.free(far, 4.0);
        assert!(cells.is_left(far) && !cells.is_left(here) && !cells.has_arrived(here, 4.0));
    }
}
