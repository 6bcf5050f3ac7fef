//! Scan in single precision for the scan log.

use trundle_core::{Beam, FreeSpan, Scan, ScanParts, Stamp, Vector2};

/// A scan packed to a third of its size for redrawing: ranges to seven digits, without sigmas and kinds.
///
/// An unpacked scan of a depth camera has 20 KB, and an hour of driving keeps thousands of scans.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PackedScan {
    stamp: Stamp,
    origin: Vector2,
    /// Angle of the first beam, and between neighbouring beams, rad.
    angles: (f64, f64),
    /// Range of each beam, m: with the sign bit for a free beam, NaN for an unseen one.
    ranges: Box<[f32]>,
    free: Option<Box<[PackedSpan]>>,
    /// Bearing of each beam, rad; empty for evenly spaced beams.
    bearings: Box<[f32]>,
}

/// A [`FreeSpan`].
#[derive(Debug, Clone, Copy, PartialEq)]
struct PackedSpan {
    beam: u32,
    from: f32,
    to: f32,
}

impl From<&Scan> for PackedScan {
    fn from(scan: &Scan) -> Self {
        Self {
            stamp: scan.stamp(),
            origin: scan.origin(),
            angles: (scan.angle_min(), scan.angle_increment()),
            ranges: scan.beams().iter().map(packed).collect(),
            free: scan.all_free_spans().map(|spans| spans.iter().map(PackedSpan::from).collect()),
            bearings: scan.bearings().into(),
        }
    }
}

impl PackedScan {
    /// Unpacks the scan.
    pub(crate) fn unpack(&self) -> Scan {
        let beams = self.ranges.iter().map(|range| unpacked(*range)).collect();
        let free = self.free.as_ref().map(|spans| spans.iter().map(|span| span.unpack()).collect());
        let parts = ScanParts { beams, free, bearings: self.bearings.to_vec(), ..ScanParts::default() };
        Scan::from_parts(self.stamp, self.origin, self.angles, parts)
            .expect("invariant: it was a scan, and rounding keeps the order of ranges")
    }
}

impl From<&FreeSpan> for PackedSpan {
    fn from(span: &FreeSpan) -> Self {
        Self { beam: span.beam, from: rounded(span.from), to: rounded(span.to) }
    }
}

impl PackedSpan {
    fn unpack(self) -> FreeSpan {
        FreeSpan { beam: self.beam, from: f64::from(self.from), to: f64::from(self.to) }
    }
}

fn packed(beam: &Beam) -> f32 {
    match *beam {
        Beam::Hit { range } => rounded(range).abs(),
        Beam::Free { range } => -rounded(range).abs(),
        Beam::Unseen => f32::NAN,
    }
}

fn unpacked(range: f32) -> Beam {
    match f64::from(range.abs()) {
        _ if range.is_nan() => Beam::Unseen,
        range_m if range.is_sign_negative() => Beam::Free { range: range_m },
        range_m => Beam::Hit { range: range_m },
    }
}

/// The nearest f32 that is not larger: a range within the map's limit stays within.
fn rounded(range: f64) -> f32 {
    let nearest = range as f32;
    if f64::from(nearest) > range { nearest.next_down() } else { nearest }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn scan(beams: Vec<Beam>, free: Option<Vec<FreeSpan>>) -> Scan {
        let parts = ScanParts { beams, free, ..ScanParts::default() };
        Scan::from_parts(Stamp::from_nanos(7), Vector2::new(0.1, -0.2), (-0.5, 0.01), parts).unwrap()
    }

    #[test]
    fn numbers_of_single_precision_come_back_unchanged() {
        let span = |beam, from, to| FreeSpan { beam, from, to };
        let beams =
            vec![Beam::Hit { range: 2.5 }, Beam::Unseen, Beam::Free { range: 0.0 }, Beam::Hit { range: 0.0 }];
        for free in [None, Some(vec![]), Some(vec![span(0, 0.0, 0.5), span(0, 0.5, 2.5), span(2, 0.0, 0.0)])]
        {
            let scan = scan(beams.clone(), free);
            assert_eq!(PackedScan::from(&scan).unpack(), scan);
        }
    }

    /// The largest range within `max_range` stays within: otherwise its wall would be erased.
    #[test]
    fn no_range_grows() {
        for range in [4.3, 12.1, 0.1, 1e300, f64::MAX] {
            let before = scan(vec![Beam::Hit { range }], None);
            let after = PackedScan::from(&before).unpack();
            let Beam::Hit { range: packed } = after.beams()[0] else { panic!("{after:?}") };
            assert!(packed <= range, "{range}");
            assert!(range - packed < 1e-6 * range || range > f64::from(f32::MAX), "{range}");
        }
    }

    /// A range: of a room, or any at all, such that neighbours are often next to each other.
    fn range() -> impl Strategy<Value = f64> {
        use prop::num::f64::{NORMAL, POSITIVE, SUBNORMAL, ZERO};
        prop_oneof![
            0.0..100.0,
            (0..50_u64).prop_map(|ulps| f64::from_bits(4.3_f64.to_bits() + ulps)),
            POSITIVE | NORMAL | SUBNORMAL | ZERO,
        ]
    }

    fn is_near(a: f64, b: f64) -> bool {
        b <= a && (a - b <= 1.2e-7 * a + 1e-37 || a > f64::from(f32::MAX))
    }

    fn is_same(a: &Beam, b: &Beam) -> bool {
        match (a, b) {
            (Beam::Hit { range: a }, Beam::Hit { range: b })
            | (Beam::Free { range: a }, Beam::Free { range: b }) => is_near(*a, *b),
            (a, b) => a == b,
        }
    }

    proptest! {
        #[test]
        fn any_scan_comes_back_to_seven_digits(
            ranges in prop::collection::vec((range(), 0..3), 0..20),
            ends in prop::collection::vec(prop::collection::vec(range(), 0..6), 20),
        ) {
            let beam = |&(range, kind): &(f64, i32)| match kind {
                0 => Beam::Hit { range },
                1 => Beam::Free { range },
                _ => Beam::Unseen,
            };
            let mut spans = Vec::new();
            for (beam, mut ends) in ends.into_iter().take(ranges.len()).enumerate() {
                ends.sort_by(f64::total_cmp);
                let span = |pair: &[f64]| FreeSpan { beam: beam as u32, from: pair[0], to: pair[1] };
                spans.extend(ends.windows(2).map(span));
            }
            let before = scan(ranges.iter().map(beam).collect(), Some(spans));
            let after = PackedScan::from(&before).unpack();
            let beams = before.beams().iter().zip(after.beams());
            prop_assert!(beams.into_iter().all(|(a, b)| is_same(a, b)), "{:?} {:?}", before, after);
            let (a, b) = (before.all_free_spans().unwrap(), after.all_free_spans().unwrap());
            let is_same = |(a, b): (&FreeSpan, &FreeSpan)| {
                a.beam == b.beam && is_near(a.from, b.from) && is_near(a.to, b.to)
            };
            prop_assert!(a.len() == b.len() && a.iter().zip(b).all(is_same), "{:?} {:?}", a, b);
        }
    }
}
