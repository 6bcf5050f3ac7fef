//! What scans saw lately: a window of cells that goes along with the robot.

use trundle_core::Vector2;

/// Side of a cell, m.
pub(super) const SIDE: f64 = 0.05;
/// A place that was hit is not left before it has been seen free for so long, s: walls flicker.
const FLICKER: f64 = 0.5;
/// No mover is seen so near to what stands, cells: pose and range are not exact.
const BESIDE: i32 = 2;
/// What is so near to something that was put down is a part of it, cells.
const PART: i32 = 4;
const NEVER: f64 = f64::NEG_INFINITY;

/// A cell's column and row; cell (0, 0) begins at the map's origin.
type Place = (i32, i32);

/// What is known of a cell.
#[derive(Debug, Clone, Copy)]
struct Seen {
    place: Place,
    /// Last seen free, s.
    free_at: f64,
    /// Last hit, s.
    hit_at: f64,
    /// Since when it has been hit, s.
    since: f64,
    /// Whether it had been seen free shortly before.
    came: bool,
    /// Where it was hit last.
    hit: Vector2,
}

impl Seen {
    /// Nothing.
    fn of(place: Place) -> Self {
        Self { place, free_at: NEVER, hit_at: NEVER, since: NEVER, came: false, hit: Vector2::zeros() }
    }

    /// Whether it was hit, and not seen free since.
    fn is_taken(&self) -> bool {
        self.hit_at > self.free_at
    }
}

/// Cells around the robot: each place has its slot, which it takes over from the one a window away.
#[derive(Debug)]
pub(super) struct SeenCells {
    slots: Vec<Seen>,
    /// Slots along a side, a power of two.
    width: i32,
    memory: f64,
}

impl SeenCells {
    /// A window that reaches so far from its middle, m. `memory`: how long a place counts as newly occupied, s.
    pub(super) fn new(reach: f64, memory: f64) -> Self {
        let width = ((2.0 * reach / SIDE).ceil() as usize + 2).next_power_of_two();
        let nothing = Seen::of((i32::MAX, i32::MAX));
        Self { slots: vec![nothing; width * width], width: width as i32, memory }
    }

    /// Notes that a point was seen free.
    pub(super) fn free(&mut self, point: Vector2, time: f64) {
        let seen = self.taken(place_of(point));
        // What one beam hits another may pass by.
        if seen.hit_at < time {
            seen.free_at = time;
        }
    }

    /// Notes that a point was hit.
    pub(super) fn hit(&mut self, point: Vector2, time: f64) {
        let memory = self.memory;
        let seen = self.taken(place_of(point));
        let is_new = seen.hit_at == NEVER || (seen.free_at > seen.hit_at && time - seen.hit_at > FLICKER);
        if is_new {
            (seen.since, seen.came) = (time, time - seen.free_at <= memory);
        }
        (seen.hit_at, seen.hit) = (time, point);
    }

    /// Whether what was hit at a point came there lately, and nothing stands beside it.
    pub(super) fn has_come(&self, point: Vector2, time: f64) -> bool {
        let place = place_of(point);
        self.known(place).is_some_and(|seen| seen.came && time - seen.since <= self.memory)
            && !around(place, BESIDE).any(|near| self.stands(near, time))
    }

    /// Whether a point is part of something that came and stayed.
    pub(super) fn has_settled(&self, point: Vector2, time: f64) -> bool {
        around(place_of(point), PART)
            .any(|near| self.known(near).is_some_and(|seen| seen.came) && self.stands(near, time))
    }

    /// Whether a point has been hit a moment ago.
    pub(super) fn is_hit(&self, point: Vector2, time: f64) -> bool {
        self.known(place_of(point)).is_some_and(|seen| time - seen.hit_at <= FLICKER)
    }

    /// Whether a point was seen free not long ago, and nothing stands there.
    pub(super) fn is_open(&self, point: Vector2, time: f64) -> bool {
        let place = place_of(point);
        self.known(place).is_some_and(|seen| time - seen.free_at <= 2.0 * self.memory)
            && !self.stands(place, time)
    }

    /// Whether a point was seen free after a time.
    pub(super) fn is_free_since(&self, point: Vector2, time: f64) -> bool {
        self.known(place_of(point)).is_some_and(|seen| seen.free_at > time)
    }

    /// Hits within `reach` m of a point since a time, of what came where nothing else stands and whose places have not been seen free
    /// since. One alone is noise.
    pub(super) fn not_gone(&self, point: Vector2, reach: f64, since: f64) -> Vec<Vector2> {
        let is_there = |seen: &&Seen| seen.came && seen.is_taken() && seen.hit_at >= since;
        let there = |place: Place| self.known(place).filter(is_there);
        let stands = |place: Place| self.known(place).is_some_and(|seen| seen.is_taken() && !seen.came);
        around(place_of(point), (reach / SIDE).ceil() as i32)
            .filter_map(there)
            .filter(|seen| (seen.hit - point).norm() <= reach)
            .filter(|seen| !around(seen.place, BESIDE).any(stands))
            .filter(|seen| around(seen.place, BESIDE).filter_map(there).count() > 1)
            .map(|seen| seen.hit)
            .collect()
    }

    /// Whether a point was hit after a time.
    pub(super) fn is_hit_since(&self, point: Vector2, time: f64) -> bool {
        self.known(place_of(point)).is_some_and(|seen| seen.hit_at > time)
    }

    /// Whether something stands at a point, or beside it, that did not come while it was watched.
    pub(super) fn is_wall(&self, point: Vector2) -> bool {
        let stays = |seen: &Seen| seen.is_taken() && !seen.came;
        around(place_of(point), 1).any(|place| self.known(place).is_some_and(stays))
    }

    /// Whether the newest that was seen of a point is that it is free.
    pub(super) fn is_left(&self, point: Vector2) -> bool {
        self.known(place_of(point)).is_some_and(|seen| seen.free_at > seen.hit_at)
    }

    fn stands(&self, place: Place, time: f64) -> bool {
        self.known(place).is_some_and(|seen| {
            let is_there = seen.hit_at > seen.free_at || time - seen.hit_at <= FLICKER;
            seen.hit_at > NEVER && is_there && (!seen.came || time - seen.since > self.memory)
        })
    }

    fn known(&self, place: Place) -> Option<&Seen> {
        let seen = &self.slots[self.slot(place)];
        (seen.place == place).then_some(seen)
    }

    /// The slot of a place, which forgets what it held of another.
    fn taken(&mut self, place: Place) -> &mut Seen {
        let slot = self.slot(place);
        let seen = &mut self.slots[slot];
        if seen.place != place {
            *seen = Seen::of(place);
        }
        seen
    }

    fn slot(&self, (col, row): Place) -> usize {
        let mask = self.width - 1;
        ((row & mask) * self.width + (col & mask)) as usize
    }
}

/// The places at most `reach` cells off along either axis.
fn around((col, row): Place, reach: i32) -> impl Iterator<Item = Place> {
    (-reach..=reach).flat_map(move |dy| (-reach..=reach).map(move |dx| (col + dx, row + dy)))
}

fn place_of(point: Vector2) -> Place {
    ((point.x / SIDE).floor() as i32, (point.y / SIDE).floor() as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_comes_is_told_from_what_stands() {
        let mut cells = SeenCells::new(1.0, 3.0);
        let (here, wall) = (Vector2::new(0.52, 0.52), Vector2::new(-0.52, 0.52));
        cells.hit(wall, 0.0);
        cells.free(here, 0.0);
        cells.hit(here, 0.1);
        cells.hit(wall, 0.1);
        assert!(cells.has_come(here, 0.1) && !cells.has_come(wall, 0.1));
        // Beside a wall nothing comes, not even where the wall flickers.
        let beside = wall + Vector2::new(0.05, 0.0);
        cells.free(beside, 0.1);
        cells.hit(beside, 0.2);
        cells.free(wall, 0.2);
        assert!(!cells.has_come(beside, 0.2) && !cells.has_come(wall, 0.2));
        cells.hit(here, 3.2);
        assert!(!cells.has_come(here, 3.2), "it stands by now");
        // A window further on the slots are others'.
        let far = here + Vector2::new(f64::from(cells.width) * SIDE, 0.0);
        cells.free(far, 4.0);
        assert!(cells.is_left(far) && !cells.is_left(here) && !cells.has_come(here, 4.0));
    }
}
