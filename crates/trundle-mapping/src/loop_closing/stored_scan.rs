//! Packed scan for redrawing a map after a loop closure.

use crate::particle_config::ParticleConfig;
use crate::scan_match::scan_points::ScanPoints;
use trundle_grid::tiles::{RaySpan, ScanRay};

/// A processed scan, packed: 5 bytes per beam, 6 with the sigma of its range, and 8 for each free span of a beam with gaps.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct StoredScan {
    /// Origin of the beams, base frame, cells.
    pub(crate) origin: (f32, f32),
    pub(crate) rays: Box<[PackedRay]>,
    /// One sigma of each ray's range, mm; empty if the sensor gives none.
    pub(crate) sigmas: Box<[u8]>,
    pub(crate) spans: Box<[PackedSpan]>,
}

/// The end of a beam in units of at most 1/16 cell at 5 cm, and its relation to the previous ray.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C, packed)]
pub(crate) struct PackedRay {
    pub(crate) x: i16,
    pub(crate) y: i16,
    /// Bits: 1 for a hit; 2 if on one surface with the previous ray; 4 if free over its whole length; 8 and up hold the number of beams
    /// since the previous ray.
    pub(crate) what: u8,
}

/// A stretch of a ray, its ends in parts of 65,535.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PackedSpan {
    pub(crate) ray: u32,
    pub(crate) from: u16,
    pub(crate) to: u16,
}

/// A ray with the number of its beam, counted from the first ray's.
pub(crate) struct StoredRay {
    pub(crate) ray: ScanRay,
    pub(crate) beam: usize,
    /// One sigma of its range, m; 0 if the sensor gives none.
    pub(crate) sigma: f32,
}

/// Maximum number of units of a stored coordinate per cell. Source: ours.
const MAX_UNITS_PER_CELL: f64 = 16.0;
/// Smallest unit of a stored coordinate \[m\]. With it 16 bits reach 102 m, the range of the longest indoor lasers. Source: ours.
const MIN_UNIT_M: f64 = 0.05 / 16.0;
/// Bit of a ray that ends at an obstacle.
const HIT_BIT: u8 = 1;
/// Bit of a ray whose end is on one surface with the previous ray's.
const JOINED_BIT: u8 = 2;
/// Bit of a ray that is free over its whole length.
const WHOLE_BIT: u8 = 4;
/// Bits below the number of skipped beams.
const SKIPPED_SHIFT: u32 = 3;
/// Maximum number of skipped beams that five bits hold. Larger gaps are stored as this number. Source: the five bits above `SKIPPED_SHIFT`.
const MAX_SKIPPED_BEAMS: usize = 31;
/// Unit of a stored sigma \[m\]. Source: ours.
const SIGMA_UNIT_M: f32 = 0.001;

/// Units of a stored coordinate per cell.
fn units_per_cell(config: &ParticleConfig) -> f32 {
    MAX_UNITS_PER_CELL.min(config.map.resolution / MIN_UNIT_M) as f32
}

impl StoredScan {
    /// Packs a scan. Ends farther than 102 m, or 2047 cells if that is more, are left out.
    pub(crate) fn new(config: &ParticleConfig, shape: &ScanPoints) -> Self {
        let units = units_per_cell(config);
        let pack = |v: f32| {
            let scaled = (v * units).round();
            (scaled.abs() <= f32::from(i16::MAX)).then_some(scaled as i16)
        };
        let (mut rays, mut sigmas, mut spans) = (Vec::new(), Vec::new(), Vec::new());
        let (mut last, mut next_span) = (None, 0);
        for (k, (ray, &beam)) in shape.rays.rays.iter().zip(&shape.beams).enumerate() {
            let first =
                next_span + shape.rays.spans[next_span..].iter().take_while(|s| (s.ray as usize) < k).count();
            next_span = first + shape.rays.spans[first..].iter().take_while(|s| s.ray as usize == k).count();
            let (Some(x), Some(y)) = (pack(ray.x), pack(ray.y)) else { continue };
            let skipped = last.map_or(0, |last| beam - last).min(MAX_SKIPPED_BEAMS) as u8;
            last = Some(beam);
            let what = (skipped << SKIPPED_SHIFT)
                | if ray.hit { HIT_BIT } else { 0 }
                | if ray.joined && skipped == 1 { JOINED_BIT } else { 0 }
                | if ray.whole { WHOLE_BIT } else { 0 };
            let part = |v: f32| (v * f32::from(u16::MAX)).round() as u16;
            let number = rays.len() as u32;
            spans.extend(shape.rays.spans[first..next_span].iter().map(|span| PackedSpan {
                ray: number,
                from: part(span.from),
                to: part(span.to),
            }));
            sigmas.extend(shape.sigmas.get(k).map(|sigma| (sigma / SIGMA_UNIT_M).round().min(255.0) as u8));
            rays.push(PackedRay { x, y, what });
        }
        Self { origin: shape.rays.origin, rays: rays.into(), sigmas: sigmas.into(), spans: spans.into() }
    }

    /// Unpacks the scan into `points`.
    pub(crate) fn unpack_into(&self, config: &ParticleConfig, points: &mut ScanPoints) {
        let rays = self.rays(config).map(|StoredRay { ray, beam, sigma }| (ray, beam, sigma));
        points.set_rays(config, self.origin, rays, self.spans());
    }

    /// The rays, in order.
    fn rays(&self, config: &ParticleConfig) -> impl Iterator<Item = StoredRay> {
        let (mut beam, units) = (0, units_per_cell(config));
        self.rays.iter().enumerate().map(move |(k, packed)| {
            beam += usize::from(packed.what >> SKIPPED_SHIFT);
            let ray = ScanRay {
                x: f32::from(packed.x) / units,
                y: f32::from(packed.y) / units,
                hit: packed.what & HIT_BIT != 0,
                joined: packed.what & JOINED_BIT != 0,
                whole: packed.what & WHOLE_BIT != 0,
                hit_weight: 1.0,
            };
            let sigma = self.sigmas.get(k).map_or(0.0, |sigma| f32::from(*sigma) * SIGMA_UNIT_M);
            StoredRay { ray, beam, sigma }
        })
    }

    /// Free spans of the rays that have gaps.
    pub(crate) fn spans(&self) -> impl Iterator<Item = RaySpan> {
        let part = |v: u16| f32::from(v) / f32::from(u16::MAX);
        self.spans.iter().map(move |span| RaySpan { ray: span.ray, from: part(span.from), to: part(span.to) })
    }

    /// Bytes in use.
    pub(crate) fn bytes(&self) -> usize {
        size_of::<Self>() + size_of_val(&*self.rays) + self.sigmas.len() + size_of_val(&*self.spans)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{Beam, FreeSpan, Hypotenuse, Scan, ScanParts, Stamp, Vector2};

    #[test]
    fn packing_keeps_all_data_of_the_beams() {
        let beams =
            vec![Beam::Hit { range: 2.0 }, Beam::Unseen, Beam::Free { range: 3.0 }, Beam::Hit { range: 1.0 }];
        let span = |beam, from, to| FreeSpan { beam, from, to };
        let free = Some(vec![span(0, 0.0, 2.0), span(2, 0.5, 1.0), span(2, 1.5, 3.0)]);
        let parts = ScanParts { beams, free, sigmas: vec![0.01, 0.0, 0.0, 0.3], ..ScanParts::default() };
        let scan = Scan::from_parts(Stamp::default(), Vector2::zeros(), (0.0, 0.1), parts).unwrap();
        let (config, mut shape, mut again) =
            (ParticleConfig::default(), ScanPoints::default(), ScanPoints::default());
        shape.set(&config, &scan);
        StoredScan::new(&config, &shape).unpack_into(&config, &mut again);
        let whole = |shape: &ScanPoints| shape.rays.rays.iter().map(|ray| ray.whole).collect::<Vec<_>>();
        assert_eq!(whole(&shape), [true, false, false]);
        assert_eq!(whole(&again), whole(&shape));
        assert_eq!(again.rays.spans.len(), 2);
        for (a, b) in again.rays.spans.iter().zip(&shape.rays.spans) {
            assert!(a.ray == 1 && b.ray == 1 && (a.from - b.from).abs() < 1e-4 && (a.to - b.to).abs() < 1e-4);
        }
        let sigma = |shape: &ScanPoints| shape.points.iter().map(|p| p.information).collect::<Vec<_>>();
        let (given, kept) = (sigma(&shape), sigma(&again));
        assert!((given[0] - kept[0]).abs() < 1e-3 * given[0], "{given:?} {kept:?}");
        assert!(
            (0.05 / 0.255_f32.hypotenuse(0.015)).powi(2) - kept[1] < 1e-4,
            "a sigma is kept up to 255 mm"
        );
    }
}
