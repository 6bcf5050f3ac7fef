//! A planar range scan: beams, free spans and kinds of obstacles, all in the base frame.

use crate::{Invalid, Pose2, Stamp, Vector2};

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

/// A stretch of a beam that was observed to be free.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeSpan {
    /// Index of the beam.
    pub beam: u32,
    /// Range at which the stretch begins, m from the sensor.
    pub from: f64,
    /// Range at which the stretch ends, m from the sensor.
    pub to: f64,
}

/// Kind of the obstacle at a hit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ObstacleKind {
    /// The obstacle stands on the floor, or its lower side is unknown.
    #[default]
    Standing,
    /// The obstacle hangs in the robot's way above free floor, as a table top.
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
    /// The bearing of each beam, rad, base frame; empty if they are evenly spaced.
    pub bearings: Vec<f32>,
}

/// The times of a scan's beams: beam i is measured at the scan's stamp plus `first_s + i * step_s`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BeamTimes {
    /// Time of the first beam after the stamp, s.
    pub first_s: f64,
    /// Time between neighbouring beams, s; negative if the last one is measured first.
    pub step_s: f64,
}

impl BeamTimes {
    /// Time of beam `i` after the stamp, s.
    pub fn of(&self, i: usize) -> f64 {
        self.first_s + i as f64 * self.step_s
    }
}

/// Time between a scan's stamp and one of its beams \[s\]. Beyond it the times are refused. Source: ours, ten turns of the slowest
/// laser.
const MAX_BEAM_TIME_S: f64 = 10.0;

/// Largest distance of a sensor from its base \[m\]. Source: ours.
const MAX_SENSOR_OFFSET_M: f64 = 20.0;

/// A laser-like scan in a horizontal plane: beam i points along `angle_min + i * angle_increment` from the sensor, or along its own
/// bearing.
///
/// Its frame is the base frame's plane with the origin at `origin`: bearings are about `origin`, angles from x.
#[derive(Debug, Clone, PartialEq)]
pub struct Scan {
    stamp: Stamp,
    origin: Vector2,
    angle_min: f64,
    angle_increment: f64,
    parts: ScanParts,
    beam_times: Option<BeamTimes>,
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
        Ok(Self { stamp, origin, angle_min, angle_increment, parts, beam_times: None })
    }

    /// The same scan with the times of its beams.
    ///
    /// # Errors
    /// When a beam is measured more than 10 s from the stamp, or a number is not finite.
    pub fn with_beam_times(self, times: BeamTimes) -> Result<Self, Invalid> {
        let last = times.of(self.parts.beams.len().saturating_sub(1));
        for (field, time) in [("time of the first beam", times.first_s), ("time of the last beam", last)] {
            crate::require_in(field, time, "s", -MAX_BEAM_TIME_S, MAX_BEAM_TIME_S)?;
        }
        Ok(Self { beam_times: Some(times), ..self })
    }

    /// The times of the beams; `None` if all are measured at the stamp, or nothing is known of them.
    pub fn beam_times(&self) -> Option<BeamTimes> {
        self.beam_times
    }

    /// The scan as if all beams were measured at the stamp, by the motion of the base.
    ///
    /// `base_from_base_at(t)` is the base's pose `t` s after the stamp in the base frame at the stamp. Each end of a beam stays where it
    /// was measured; beams then begin at the common origin, each at its own bearing. A scan without beam times is returned as it is.
    #[must_use]
    pub fn deskewed(self, base_from_base_at: impl Fn(f64) -> Pose2) -> Self {
        let Some(times) = self.beam_times else { return self };
        let (mut beams, mut bearings) = (Vec::new(), Vec::new());
        for (i, beam) in self.parts.beams.iter().enumerate() {
            let moved = base_from_base_at(times.of(i));
            let range = match *beam {
                Beam::Hit { range } | Beam::Free { range } => range,
                Beam::Unseen => 1.0,
            };
            let arm = moved.transform(self.point(i, range)) - self.origin;
            let range = arm.norm();
            bearings.push(arm.y.atan2(arm.x) as f32);
            beams.push(match beam {
                Beam::Hit { .. } => Beam::Hit { range },
                Beam::Free { .. } => Beam::Free { range },
                Beam::Unseen => Beam::Unseen,
            });
        }
        let parts = ScanParts { beams, bearings, ..self.parts };
        Self { parts, beam_times: None, ..self }
    }

    /// The measurements of its beams, for a new scan without an allocation.
    pub fn into_parts(self) -> ScanParts {
        self.parts
    }

    /// When it was taken.
    pub fn stamp(&self) -> Stamp {
        self.stamp
    }

    /// The origin of the beams, base frame, m.
    pub fn origin(&self) -> Vector2 {
        self.origin
    }

    /// The beams, by rising angle.
    pub fn beams(&self) -> &[Beam] {
        &self.parts.beams
    }

    /// The bearing of beam `i`, rad, base frame.
    pub fn angle(&self, i: usize) -> f64 {
        self.parts.bearings.get(i).map_or_else(|| self.even_angle(i), |bearing| f64::from(*bearing))
    }

    fn even_angle(&self, i: usize) -> f64 {
        self.angle_min + i as f64 * self.angle_increment
    }

    /// The bearings of the beams, rad, base frame; empty if they are evenly spaced.
    pub fn bearings(&self) -> &[f32] {
        &self.parts.bearings
    }

    /// The bearing of the first of evenly spaced beams, rad, base frame.
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
        if let Some(i) = self.bearings.iter().position(|bearing| !bearing.is_finite()) {
            let field = format!("bearing of beam {i}");
            return Err(Invalid::new(field, self.bearings[i], "rad", "a finite number"));
        }
        let counts = [
            ("sigmas", self.sigmas.len()),
            ("obstacles", self.obstacles.len()),
            ("bearings", self.bearings.len()),
        ];
        for (field, count) in counts {
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

    #[test]
    fn deskewing_puts_each_end_where_it_was_when_its_beam_was_measured() {
        // A robot drives 1 m/s ahead and turns by 0.5 rad/s past two posts; the last beam is measured at the stamp.
        let world_from_base = |t: f64| Pose2::new(3.0 + t, -1.0, 0.4 + 0.5 * t);
        let (stamp_pose, origin) = (world_from_base(0.0), Vector2::new(0.1, 0.05));
        let posts = [Vector2::new(5.0, 0.0), Vector2::new(4.0, 1.5)];
        let times = BeamTimes { first_s: -0.2, step_s: 0.2 };
        let beam = |i: usize| {
            let arm = world_from_base(times.of(i)).inverse().transform(posts[i]) - origin;
            (arm.y.atan2(arm.x), arm.norm())
        };
        let ((first, near), (second, far)) = (beam(0), beam(1));
        let beams = vec![Beam::Hit { range: near }, Beam::Hit { range: far }];
        let scan = Scan::new(Stamp::default(), origin, first, second - first, beams).unwrap();
        let off = |scan: &Scan| {
            let ends = scan.hits().zip(posts);
            ends.map(|(hit, post)| (stamp_pose.transform(hit) - post).norm()).fold(0.0, f64::max)
        };
        assert!(off(&scan) > 0.2, "{}", off(&scan));
        let even = scan.clone().deskewed(|_| panic!("all beams were measured at once"));
        assert_eq!(even, scan);
        let swept = scan.with_beam_times(times).unwrap();
        let still = swept.deskewed(|t| stamp_pose.inverse() * world_from_base(t));
        assert!(off(&still) < 1e-6, "{}", off(&still));
        assert_eq!((still.beam_times(), still.bearings().len()), (None, 2));
    }

    #[test]
    fn beam_times_far_from_the_stamp_are_refused() {
        let scan = two_beams(ScanParts::default()).unwrap();
        let refused =
            |first_s, step_s| scan.clone().with_beam_times(BeamTimes { first_s, step_s }).unwrap_err().field;
        assert_eq!(refused(-11.0, 0.0), "time of the first beam");
        assert_eq!(refused(0.0, f64::NAN), "time of the last beam");
        let bearings = two_beams(ScanParts { bearings: vec![0.0, f32::NAN], ..ScanParts::default() });
        assert_eq!(bearings.unwrap_err().field, "bearing of beam 1");
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
