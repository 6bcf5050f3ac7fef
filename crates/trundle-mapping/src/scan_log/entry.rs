use crate::grid_mapper::{GridMapper, Insertion};
use crate::scan_log::packed_scan::PackedScan;
use std::{collections::HashMap, sync::Arc};
use trundle_core::{Pose2, Stamp, Vector2};

/// Something drawn that can be drawn again.
#[derive(Debug, Clone)]
pub(crate) struct Kept {
    pub(crate) stamp: Stamp,
    pub(crate) map_from_base: Pose2,
    /// Where the first was taken in whose place this one is kept.
    pub(crate) anchor: Pose2,
    pub(crate) what: What,
}

#[derive(Debug, Clone)]
pub(crate) enum What {
    Scan(Arc<PackedScan>),
    FreeDisc { radius: f64 },
    Touched { points: Arc<[Vector2]> },
}

/// What something drawn is, without what it bears.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Scan,
    FreeDisc,
    Touched,
}

impl What {
    fn kind(&self) -> Kind {
        match self {
            Self::Scan(_) => Kind::Scan,
            Self::FreeDisc { .. } => Kind::FreeDisc,
            Self::Touched { .. } => Kind::Touched,
        }
    }
}

/// One is kept when the robot has come so far from the last one of its kind, m and rad: others add to the map, but not to its
/// redrawing.
const STEP: (f64, f64) = (0.1, 0.1);
/// Scans of one place and direction, m and rad, of which the newest are kept: as many as one drive through it takes.
const SCANS: (f64, f64, u32) = (0.5, std::f64::consts::FRAC_PI_6, 5);
/// Discs and touches are small: one for each of these.
const SMALL: (f64, f64, u32) = (0.1, std::f64::consts::FRAC_PI_6, 1);
/// What beginning a scan costs, cells.
const SCAN_COST: usize = 200;

impl Kept {
    /// Which of `kept` is from so near `map_from_base` that one of `kind` need not be kept beside it: the last of its kind; a touch is
    /// always kept.
    pub(crate) fn repeated(kept: &[Self], map_from_base: Pose2, kind: Kind) -> Option<usize> {
        let last = kept.iter().rposition(|kept| kept.what.kind() == kind)?;
        (kind != Kind::Touched && is_near(kept[last].anchor, map_from_base)).then_some(last)
    }

    /// Takes it to where it was taken by now.
    pub(crate) fn shift(&mut self, now: Pose2) {
        self.anchor = now * (self.map_from_base.inverse() * self.anchor);
        self.map_from_base = now;
    }

    /// Draws it; what that cost, cells.
    pub(crate) fn draw(&self, mapper: &mut GridMapper) -> usize {
        match &self.what {
            What::Scan(scan) => {
                let Insertion { hits, free, .. } = mapper.insert(self.map_from_base, &scan.unpack());
                return hits + free + SCAN_COST;
            }
            What::FreeDisc { radius } => mapper.mark_free_disc(self.map_from_base, *radius),
            What::Touched { points } => mapper.mark_occupied(self.map_from_base, points),
        }
        SCAN_COST
    }

    /// Its kind, place and direction, and how many of these are enough.
    fn place(&self) -> (Place, u32) {
        let (kind, (side, turn, enough)) = match self.what {
            What::Scan(_) => (0, SCANS),
            What::FreeDisc { .. } => (1, SMALL),
            What::Touched { .. } => (2, SMALL),
        };
        let pose = self.map_from_base;
        let cell = |value: f64, side: f64| (value / side).floor() as i64;
        ((kind, cell(pose.x, side), cell(pose.y, side), cell(pose.theta, turn)), enough)
    }
}

/// Kind, column, row and direction.
type Place = (u8, i64, i64, i64);

/// Lets go what was drawn again often enough since, in the same place and direction: what is left grows with the floor, not with the
/// time.
pub(crate) fn thin(kept: &mut Vec<Kept>) {
    let mut newer: HashMap<Place, u32> = HashMap::new();
    let mut stays: Vec<bool> = kept
        .iter()
        .rev()
        .map(|one| {
            let (place, enough) = one.place();
            let there = newer.entry(place).or_default();
            *there += 1;
            *there <= enough
        })
        .collect();
    kept.retain(|_| stays.pop().expect("invariant: one word for each thing kept"));
}

/// Lets every second scan and disc of the older half go; whether there was one.
pub(crate) fn halve_the_older_half(kept: &mut Vec<Kept>) -> bool {
    let (before, half) = (kept.len(), kept.len() / 2);
    let (mut i, mut scans, mut discs) = (0, 0, 0);
    kept.retain(|one| {
        i += 1;
        let nth = match one.what {
            What::Scan(_) => &mut scans,
            What::FreeDisc { .. } => &mut discs,
            What::Touched { .. } => return true,
        };
        *nth += 1;
        i > half || *nth % 2 == 1
    });
    kept.len() < before
}

fn is_near(a: Pose2, b: Pose2) -> bool {
    let step = a.inverse() * b;
    step.position().norm() < STEP.0 && step.theta.abs() < STEP.1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_the_older_half_every_second_of_each_kind_goes_and_no_touch() {
        let kinds = |i: usize| match i % 3 {
            0 => What::FreeDisc { radius: i as f64 },
            1 => What::FreeDisc { radius: -(i as f64) },
            _ => What::Touched { points: Arc::new([]) },
        };
        let one = |i| Kept {
            stamp: Stamp::default(),
            map_from_base: Pose2::IDENTITY,
            anchor: Pose2::IDENTITY,
            what: kinds(i),
        };
        let mut kept: Vec<_> = (0..12).map(one).collect();
        halve_the_older_half(&mut kept);
        let discs = |range: std::ops::Range<usize>| {
            kept[range].iter().filter(|one| matches!(one.what, What::FreeDisc { .. })).count()
        };
        assert_eq!((kept.len(), discs(0..4), discs(4..10)), (10, 2, 4));
    }
}
