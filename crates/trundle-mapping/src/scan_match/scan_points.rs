//! Scan prepared for matching: thinned points with normals, and rays.

use crate::particle_config::ParticleConfig;
use crate::scan_match::point_spread::{PointSpread, thinned};
use std::collections::BTreeSet;
use trundle_core::{Beam, Hypotenuse, Pose2, Scan, Vector2, tanh_f32};
use trundle_grid::tiles::{RaySpan, ScanRay, ScanRays};

/// A scan prepared for many particles: in cells, base frame, with surfaces and their normals.
#[derive(Debug, Clone, Default)]
pub(crate) struct ScanPoints {
    /// Origin, rays and free spans of the scan, for the update of a map.
    pub(crate) rays: ScanRays,
    /// The hits, thinned, for matching.
    pub(crate) points: Vec<ScanPoint>,
    /// The thinned hits in groups for vector code; the last group is padded.
    pub(crate) groups: Vec<PointGroup>,
    /// Spread of the points, cells.
    pub(crate) spread: PointSpread,
    /// Beam number, end point, and one sigma of the range (0 if unknown) of each hit.
    hits: Vec<(usize, Vector2, f64)>,
    /// The numbers of the rays' beams.
    pub(crate) beams: Vec<usize>,
    /// Standard deviation of each ray's range, m; empty if the sensor gives none.
    pub(crate) sigmas: Vec<f32>,
}

/// A hit to be matched.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ScanPoint {
    pub(crate) x: f32,
    pub(crate) y: f32,
    /// Normal of the point's surface; zero without one.
    pub(crate) normal: (f32, f32),
    /// 1 / sigma^2, 1 / cells^2.
    pub(crate) information: f32,
}

/// A hit of a scan.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ScanHit {
    /// Number of its beam.
    pub(crate) beam: usize,
    /// End point, base frame, m.
    pub(crate) end: Vector2,
    /// One sigma of its range, m.
    pub(crate) sigma: f64,
}

/// Number of points of a vector group.
pub(crate) const LANES: usize = 8;

/// Eight points of a scan.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PointGroup {
    pub(crate) x: [f32; LANES],
    pub(crate) y: [f32; LANES],
    pub(crate) normal_x: [f32; LANES],
    pub(crate) normal_y: [f32; LANES],
    /// 1 for a point with a normal, else 0.
    pub(crate) wall: [f32; LANES],
    pub(crate) information: [f32; LANES],
    /// Number of lanes with points.
    pub(crate) count: usize,
}

impl PointGroup {
    fn new(points: &[ScanPoint]) -> Self {
        // Padding repeats the last point.
        let at = |k: usize| points[k.min(points.len() - 1)];
        let lanes = |f: fn(ScanPoint) -> f32| std::array::from_fn(|k| f(at(k)));
        Self {
            x: lanes(|p| p.x),
            y: lanes(|p| p.y),
            normal_x: lanes(|p| p.normal.0),
            normal_y: lanes(|p| p.normal.1),
            wall: lanes(|p| if p.normal == (0.0, 0.0) { 0.0 } else { 1.0 }),
            information: lanes(|p| p.information),
            count: points.len(),
        }
    }
}

/// Distance to each side over which a surface normal is fitted \[m\]. A shorter baseline gives the normal of the noise.
/// Source: ours.
const NORMAL_BASELINE_M: f64 = 0.2;
/// Minimum distance of two points of a scan \[cells\]. A nearer point is dropped. Source: ours.
const POINT_SPACING_CELLS: f64 = 1.5;
/// Minimum lever of the points \[cells\]. Points nearer to each other do not determine the heading. Source: ours.
const MIN_LEVER_CELLS: f64 = 2.0;
/// Maximum RMS distance from a fitted line \[sigmas\]. Points with a larger distance have no normal. Source: ours.
const MAX_LINE_RESIDUAL_SIGMAS: f64 = 3.0;

impl ScanPoints {
    /// Sets the scan.
    pub(crate) fn set(&mut self, config: &ParticleConfig, scan: &Scan) {
        let cells = 1.0 / config.map.resolution;
        self.clear();
        self.rays.origin = ((scan.origin().x * cells) as f32, (scan.origin().y * cells) as f32);
        let mut last: Option<(usize, Vector2)> = None;
        for (i, beam) in scan.beams().iter().enumerate() {
            let (range, hit) = match *beam {
                Beam::Hit { range } => (range.min(config.map.max_range), range <= config.map.max_range),
                Beam::Free { range } => (range.min(config.map.max_range), false),
                Beam::Unseen => continue,
            };
            let end = scan.point(i, range);
            let joined =
                hit && last.is_some_and(|(j, p)| j + 1 == i && (p - end).norm() <= config.map.surface_gap);
            let whole = self.take_spans(scan, i, range);
            let ends = ((end.x * cells) as f32, (end.y * cells) as f32);
            let sigma = scan.sigma(i).map(|sigma| sigma as f32);
            let hit_weight = hit_weight(sigma.unwrap_or(0.0) * cells as f32);
            self.rays.rays.push(ScanRay { x: ends.0, y: ends.1, hit, joined, whole, hit_weight });
            self.sigmas.extend(sigma);
            self.beams.push(i);
            last = hit.then_some((i, end));
            if hit {
                self.hits.push((i, end, scan.sigma(i).unwrap_or(0.0)));
            }
        }
        self.find_points(config, scan.origin());
    }

    /// Sets the scan to rays with their beam numbers and range sigmas (m, 0: unknown), to free spans, and to an origin in cells.
    pub(crate) fn set_rays(
        &mut self,
        config: &ParticleConfig,
        origin: (f32, f32),
        rays: impl Iterator<Item = (ScanRay, usize, f32)>,
        spans: impl Iterator<Item = RaySpan>,
    ) {
        self.clear();
        self.rays.origin = origin;
        let metres = config.map.resolution;
        let cells = (1.0 / metres) as f32;
        let origin = self.origin(config);
        for (ray, beam, sigma) in rays {
            if ray.hit {
                let end = Vector2::new(f64::from(ray.x), f64::from(ray.y)) * metres;
                self.hits.push((beam, end, f64::from(sigma)));
            }
            self.rays.rays.push(ScanRay { hit_weight: hit_weight(sigma * cells), ..ray });
        }
        self.rays.spans.extend(spans);
        self.find_points(config, origin);
    }

    /// Adds the free spans of beam `i`, the next ray, up to `range`. Returns whether the spans cover the whole range.
    fn take_spans(&mut self, scan: &Scan, i: usize, range: f64) -> bool {
        let (ray, first) = (self.rays.rays.len() as u32, self.rays.spans.len());
        for (from, to) in scan.free_spans(i).filter(|(from, _)| *from < range) {
            self.rays.spans.push(RaySpan {
                ray,
                from: (from / range) as f32,
                to: (to / range).min(1.0) as f32,
            });
        }
        let whole = matches!(self.rays.spans[first..], [RaySpan { from: 0.0, to: 1.0, .. }]);
        if whole {
            self.rays.spans.truncate(first);
        }
        whole
    }

    /// Gathers the hits of several scans, each moved by its pose (cells); at most one per square of `spacing` cells.
    pub(crate) fn gather<'a>(
        &mut self,
        parts: impl Iterator<Item = (&'a Self, Pose2)>,
        spacing: f64,
        taken: &mut BTreeSet<(i32, i32)>,
    ) {
        for (part, pose) in parts {
            let (s, c) = pose.theta.sin_cos();
            let turn = |x: f64, y: f64| (c * x - s * y, s * x + c * y);
            for point in &part.points {
                let (x, y) = turn(f64::from(point.x), f64::from(point.y));
                let (x, y) = (x + pose.x, y + pose.y);
                if taken.insert(((x / spacing).floor() as i32, (y / spacing).floor() as i32)) {
                    let (nx, ny) = turn(f64::from(point.normal.0), f64::from(point.normal.1));
                    let normal = (nx as f32, ny as f32);
                    self.points.push(ScanPoint { x: x as f32, y: y as f32, normal, ..*point });
                }
            }
        }
    }

    /// Origin of the rays, base frame, m.
    pub(crate) fn origin(&self, config: &ParticleConfig) -> Vector2 {
        let (x, y) = self.rays.origin;
        Vector2::new(f64::from(x), f64::from(y)) * config.map.resolution
    }

    /// All hits, in the order of their beams.
    pub(crate) fn hits(&self, config: &ParticleConfig) -> Vec<ScanHit> {
        let origin = self.origin(config);
        let sigma = |end: &Vector2, own: f64| range_sigma(config, (end - origin).norm(), own);
        self.hits
            .iter()
            .map(|(beam, end, own)| ScanHit { beam: *beam, end: *end, sigma: sigma(end, *own) })
            .collect()
    }

    /// Removes all points.
    pub(crate) fn clear(&mut self) {
        self.rays.clear();
        self.beams.clear();
        self.sigmas.clear();
        self.points.clear();
        self.groups.clear();
        self.hits.clear();
    }

    /// Prepares gathered points for matching.
    pub(crate) fn finish(&mut self) {
        let points = self.points.iter().map(|p| Vector2::new(f64::from(p.x), f64::from(p.y)));
        self.spread = PointSpread::new(points, MIN_LEVER_CELLS);
        self.groups.clear();
        self.groups.extend(self.points.chunks(LANES).map(PointGroup::new));
    }

    fn find_points(&mut self, config: &ParticleConfig, origin: Vector2) {
        let cells = 1.0 / config.map.resolution;
        let spacing = POINT_SPACING_CELLS * config.map.resolution;
        let kept: Vec<usize> = thinned(self.hits.iter().map(|hit| hit.1), spacing).collect();
        for k in kept {
            let hit = self.hits[k].1;
            let range = (hit - origin).norm();
            let range_sigma = range_sigma(config, range, self.hits[k].2);
            // A cell's obstacle is known to about a fifth of the cell.
            let sigma = range_sigma.hypotenuse(0.3 * config.map.resolution);
            let normal = self.normal(k, sigma).map_or((0.0, 0.0), |n| (n.x as f32, n.y as f32));
            self.points.push(ScanPoint {
                x: (hit.x * cells) as f32,
                y: (hit.y * cells) as f32,
                normal,
                information: (1.0 / (sigma * cells).powi(2)) as f32,
            });
        }
        self.finish();
    }

    /// The normal of the straight surface around hit `k`; `None` without one.
    fn normal(&self, k: usize, sigma: f64) -> Option<Vector2> {
        let (_, here, _) = self.hits[k];
        let reach = |step: isize| {
            let mut at = k;
            loop {
                let next = at.checked_add_signed(step).filter(|&next| next < self.hits.len())?;
                let gap = (self.hits[next].1 - self.hits[at].1).norm();
                let neighbours = self.hits[next].0.abs_diff(self.hits[at].0) <= 2;
                let span = (self.hits[next].1 - here).norm();
                if !neighbours || gap > 1.5 {
                    return None;
                }
                at = next;
                if span >= NORMAL_BASELINE_M {
                    return Some(at);
                }
            }
        };
        // At the end of a surface, its remaining side determines the direction.
        let (first, last) = match (reach(-1), reach(1)) {
            (None, None) => return None,
            (first, last) => (first.unwrap_or(k), last.unwrap_or(k)),
        };
        let points = self.hits[first..=last].iter().map(|(_, p, _)| *p);
        let count = (last - first + 1) as f64;
        let mean = points.clone().sum::<Vector2>() / count;
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        for d in points.map(|p| p - mean) {
            xx += d.x * d.x;
            xy += d.x * d.y;
            yy += d.y * d.y;
        }
        // Direction of the larger eigenvector of the 2 x 2 scatter.
        let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
        let across = Vector2::new(-angle.sin(), angle.cos());
        let off =
            (across.x * across.x * xx + 2.0 * across.x * across.y * xy + across.y * across.y * yy) / count;
        (off.sqrt() <= MAX_LINE_RESIDUAL_SIGMAS * sigma).then_some(across)
    }
}

/// One sigma of a range (m): the scan's `own` if it is positive, else that of the settings.
fn range_sigma(config: &ParticleConfig, range: f64, own: f64) -> f64 {
    if own > 0.0 { own } else { config.range_noise + config.range_noise_growth * range * range }
}

/// Fraction of a Gaussian of `sigma` cells within half a cell of its mean, relative to that for a sigma of half a cell. A hit that may
/// belong to a neighbouring cell gets less weight.
fn hit_weight(sigma: f32) -> f32 {
    // Within h sigmas: tanh(0.8 h) to 0.02.
    let within = |sigma: f32| tanh_f32(0.4 / sigma);
    if sigma <= 0.5 { 1.0 } else { within(sigma) / within(0.5) }
}
