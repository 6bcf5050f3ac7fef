//! A planar range scan: beams, free spans and kinds of obstacles, all in the base frame.

use crate::{Invalid, Stamp, Vector2};

/// Measurement of one bearing of a scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Beam {
    /// An obstacle at this range, m. Nearer floor is free, except in gaps between the scan's free spans.
    Hit {
        /// Metres.
        range: f64,
    },
    /// No obstacle up to this range, m, unless the scan's free spans leave gaps, and nothing known beyond.
    Free {
        /// Metres.
        range: f64,
    },
    /// Nothing is known along this bearing.
    Unseen,
}

/// A stretch of a beam that was seen to be free.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeSpan {
    /// Which beam.
    pub beam: u32,
    /// Where it begins, m from the sensor.
    pub from: f64,
    /// Where it ends, m from the sensor.
    pub to: f64,
}

/// Kind of the obstacle at a hit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ObstacleKind {
    /// It stands on the floor, or nothing is known of that.
    #[default]
    Standing,
    /// It hangs in the robot's way, and the floor goes on under it: a table top.
    Overhang,
    /// The floor ends: a hole, stairs that lead down.
    Drop,
}

/// Measurements of all beams of a scan.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ScanParts {
    /// The beams, by rising angle.
    pub beams: Vec<Beam>,
    /// Free spans by rising beam and range; `None`: all beams up to their ranges.
    pub free: Option<Vec<FreeSpan>>,
    /// One sigma of the range of each beam, m; empty if the sensor gives none.
    pub sigmas: Vec<f32>,
    /// The kind of each beam's obstacle; empty if all stand.
    pub obstacles: Vec<ObstacleKind>,
}

/// No sensor of a robot is farther from its base, m.
const MAX_SENSOR_OFFSET_M: f64 = 20.0;

/// A laser-like scan in a horizontal plane: beam i points along `angle_min + i * angle_increment` from the sensor.
///
/// Its frame is the base frame's plane with the origin at `origin`: bearings are about `origin`, angles from x.
#[derive(Debug, Clone, PartialEq)]
pub struct Scan {
    stamp: Stamp,
    origin: Vector2,
    angle_min: f64,
    angle_increment: f64,
    parts: ScanParts,
}

impl Scan {
    /// A scan whose beams start at `origin` (base frame, m).
    ///
    /// # Errors
    /// When an angle is not finite, the origin is not within 20 m of the base, the increment is not positive, or a range is not
    /// finite and >= 0.
    pub fn new(
        stamp: Stamp,
        origin: Vector2,
        angle_min: f64,
        angle_increment: f64,
        beams: Vec<Beam>,
    ) -> Result<Self, Invalid> {
        Self::from_parts(
            stamp,
            origin,
            (angle_min, angle_increment),
            ScanParts { beams, ..ScanParts::default() },
        )
    }

    /// A scan with all measurements of its beams, which start at `origin` (base frame, m). `angles`: of the first beam, and between
    /// neighbouring beams, rad.
    ///
    /// # Errors
    /// As [`Scan::new`]; and when free spans do not rise, sigmas are not finite and >= 0, or a list has another length than
    /// the beams.
    pub fn from_parts(
        stamp: Stamp,
        origin: Vector2,
        (angle_min, angle_increment): (f64, f64),
        parts: ScanParts,
    ) -> Result<Self, Invalid> {
        crate::require_in("scan origin x", origin.x, "m", -MAX_SENSOR_OFFSET_M, MAX_SENSOR_OFFSET_M)?;
        crate::require_in("scan origin y", origin.y, "m", -MAX_SENSOR_OFFSET_M, MAX_SENSOR_OFFSET_M)?;
        crate::require_finite("angle_min", angle_min, "rad")?;
        crate::require_positive("angle_increment", angle_increment, "rad")?;
        parts.check()?;
        Ok(Self { stamp, origin, angle_min, angle_increment, parts })
    }

    /// The measurements of its beams, for a new scan without an allocation.
    pub fn into_parts(self) -> ScanParts {
        self.parts
    }

    /// When it was taken.
    pub fn stamp(&self) -> Stamp {
        self.stamp
    }

    /// Where the beams start, base frame, m.
    pub fn origin(&self) -> Vector2 {
        self.origin
    }

    /// The beams, by rising angle.
    pub fn beams(&self) -> &[Beam] {
        &self.parts.beams
    }

    /// The bearing of beam `i`, rad, base frame.
    pub fn angle(&self, i: usize) -> f64 {
        self.angle_min + i as f64 * self.angle_increment
    }

    /// The bearing of the first beam, rad, base frame.
    pub fn angle_min(&self) -> f64 {
        self.angle_min
    }

    /// The angle between neighbouring beams, rad.
    pub fn angle_increment(&self) -> f64 {
        self.angle_increment
    }

    /// The point at `range` along beam `i`, base frame, m.
    pub fn point(&self, i: usize, range: f64) -> Vector2 {
        let angle = self.angle(i);
        self.origin + Vector2::new(angle.cos(), angle.sin()) * range
    }

    /// All free spans, by rising beam and range; `None` for a scan without free spans.
    pub fn all_free_spans(&self) -> Option<&[FreeSpan]> {
        self.parts.free.as_deref()
    }

    /// Free spans of beam `i`, m from the sensor, by rising range. For a scan without free spans: the whole beam up to its range.
    pub fn free_spans(&self, i: usize) -> impl Iterator<Item = (f64, f64)> + '_ {
        let whole = match (&self.parts.free, self.parts.beams.get(i)) {
            (None, Some(Beam::Hit { range } | Beam::Free { range })) => Some((0.0, *range)),
            _ => None,
        };
        let spans = self.parts.free.as_deref().unwrap_or_default();
        let first = spans.partition_point(|span| (span.beam as usize) < i);
        let own = spans[first..].iter().take_while(move |span| span.beam as usize == i);
        whole.into_iter().chain(own.map(|span| (span.from, span.to)))
    }

    /// One sigma of the range of beam `i`, m, if the sensor gives one.
    pub fn sigma(&self, i: usize) -> Option<f64> {
        self.parts.sigmas.get(i).map(|sigma| f64::from(*sigma))
    }

    /// The kind of obstacle that beam `i` met; `None` if it met none.
    pub fn obstacle(&self, i: usize) -> Option<ObstacleKind> {
        let hit = matches!(self.parts.beams.get(i), Some(Beam::Hit { .. }));
        hit.then(|| self.parts.obstacles.get(i).copied().unwrap_or_default())
    }

    /// The obstacle points, base frame, m, by rising angle.
    pub fn hits(&self) -> impl Iterator<Item = Vector2> + '_ {
        self.parts.beams.iter().enumerate().filter_map(|(i, beam)| match beam {
            Beam::Hit { range } => Some(self.point(i, *range)),
            _ => None,
        })
    }
}

impl ScanParts {
    fn check(&self) -> Result<(), Invalid> {
        let is_range = |range: f64| range.is_finite() && range >= 0.0;
        for (i, beam) in self.beams.iter().enumerate() {
            if let Beam::Hit { range } | Beam::Free { range } = beam
                && !is_range(*range)
            {
                let field = format!("range of beam {i}");
                return Err(Invalid::new(field, range, "m", "a finite number, 0 or more"));
            }
        }
        if let Some(i) = self.sigmas.iter().position(|sigma| !is_range(f64::from(*sigma))) {
            let field = format!("sigma of beam {i}");
            return Err(Invalid::new(field, self.sigmas[i], "m", "a finite number, 0 or more"));
        }
        let beams = self.beams.len();
        for (field, count) in [("sigmas", self.sigmas.len()), ("obstacles", self.obstacles.len())] {
            if count != 0 && count != beams {
                return Err(Invalid::new(format!("number of {field}"), count, "", format!("0 or {beams}")));
            }
        }
        self.check_free()
    }

    fn check_free(&self) -> Result<(), Invalid> {
        let mut before = (0, 0.0);
        for span in self.free.iter().flatten() {
            let rises = span.beam > before.0 || (span.beam == before.0 && span.from >= before.1);
            let is_span = span.from >= 0.0 && span.to >= span.from && span.to.is_finite();
            if !(rises && is_span && (span.beam as usize) < self.beams.len()) {
                let value = format!("{} to {}", span.from, span.to);
                let field = format!("free span of beam {}", span.beam);
                return Err(Invalid::new(field, value, "m", "finite numbers that rise, by rising beam"));
            }
            before = (span.beam, span.to);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hits_are_points_and_nan_is_refused() {
        let beams = vec![Beam::Hit { range: 2.0 }, Beam::Unseen, Beam::Free { range: 3.0 }];
        let scan = Scan::new(Stamp::default(), Vector2::new(0.1, 0.0), 0.0, 0.5, beams).unwrap();
        assert_eq!(scan.hits().collect::<Vec<_>>(), vec![Vector2::new(2.1, 0.0)]);
        let beams = vec![Beam::Hit { range: f64::NAN }];
        let error = Scan::new(Stamp::default(), Vector2::zeros(), 0.0, 0.5, beams).unwrap_err();
        assert_eq!(error.field, "range of beam 0");
    }

    fn two_beams(parts: ScanParts) -> Result<Scan, Invalid> {
        let beams = vec![Beam::Hit { range: 2.0 }, Beam::Unseen];
        Scan::from_parts(Stamp::default(), Vector2::zeros(), (0.0, 0.5), ScanParts { beams, ..parts })
    }

    #[test]
    fn without_more_all_is_free_up_to_the_range_and_everything_stands() {
        let scan = two_beams(ScanParts::default()).unwrap();
        assert_eq!(scan.free_spans(0).collect::<Vec<_>>(), [(0.0, 2.0)]);
        assert_eq!(scan.free_spans(1).count() + scan.free_spans(7).count(), 0);
        assert_eq!((scan.obstacle(0), scan.obstacle(1)), (Some(ObstacleKind::Standing), None));
        assert_eq!(scan.sigma(0), None);
    }

    #[test]
    fn free_spans_sigmas_and_kinds_are_each_beams_own() {
        let span = |beam, from, to| FreeSpan { beam, from, to };
        let free = Some(vec![span(0, 0.5, 1.0), span(0, 1.5, 2.0), span(1, 0.0, 0.25)]);
        let obstacles = vec![ObstacleKind::Drop, ObstacleKind::Standing];
        let parts = ScanParts { free, sigmas: vec![0.25, 0.0], obstacles, ..ScanParts::default() };
        let scan = two_beams(parts.clone()).unwrap();
        assert_eq!(scan.free_spans(0).collect::<Vec<_>>(), [(0.5, 1.0), (1.5, 2.0)]);
        assert_eq!(scan.free_spans(1).collect::<Vec<_>>(), [(0.0, 0.25)]);
        assert_eq!((scan.sigma(0), scan.obstacle(0)), (Some(0.25), Some(ObstacleKind::Drop)));
        let refused = |parts| two_beams(parts).unwrap_err().field;
        let free = |spans: &[FreeSpan]| ScanParts { free: Some(spans.to_vec()), ..ScanParts::default() };
        assert_eq!(refused(free(&[span(1, 0.0, 1.0), span(0, 0.0, 1.0)])), "free span of beam 0");
        assert_eq!(refused(free(&[span(0, 0.0, 1.0), span(0, 0.5, 2.0)])), "free span of beam 0");
        assert_eq!(refused(free(&[span(2, 0.0, 1.0)])), "free span of beam 2");
        assert_eq!(refused(free(&[span(0, 0.0, f64::NAN)])), "free span of beam 0");
        assert_eq!(refused(ScanParts { sigmas: vec![0.1, f32::NAN], ..parts.clone() }), "sigma of beam 1");
        assert_eq!(refused(ScanParts { sigmas: vec![0.1], ..parts }), "number of sigmas");
    }
}
