//! Fusion of the scans of several sensors into one scan.

use super::range_bins::{BELOW, BIN_COUNT, SpanBits, bins, bridged, spans};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};
use trundle_core::{
    Beam, FreeSpan, Invalid, ObstacleKind, Pose2, Scan, ScanParts, Stamp, Vector2, require_in, wrap_angle,
};

/// Settings of the fusion of scans.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct ScanFusionConfig {
    /// Number of beams of the full circle, 16 to 7200. Default 720: half a degree, some columns of a Kinect.
    pub beams: usize,
    /// Largest range, m, 0.5 to 100. Default 6, as in [`crate::DepthScanConfig`].
    pub max_range: f64,
    /// Largest distance of hits of one surface behind the nearest hit of a beam, m, 0 to 1. Default 0.1.
    pub surface: f64,
}

impl Default for ScanFusionConfig {
    fn default() -> Self {
        Self { beams: 720, max_range: 6.0, surface: 0.1 }
    }
}

impl ScanFusionConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside the range of its field.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("beams", self.beams as f64, "", 16.0, 7200.0)?;
        require_in("max_range", self.max_range, "m", 0.5, 100.0)?;
        require_in("surface", self.surface, "m", 0.0, 1.0)?;
        Ok(self)
    }
}

/// Fuses the scans of several sensors into one of the full circle around the base's origin.
///
/// Each bearing gets the nearest obstacle of any sensor. A range is free if a sensor observed it free and no sensor has a nearer obstacle.
/// Beams of sensors at other positions cross the fused beams, so their free spans are converted point by point. Cost: the number of beams
/// times bins of range.
#[derive(Debug, Clone)]
pub struct ScanFusion {
    config: ScanFusionConfig,
    nearest: Vec<Nearest>,
    free: Vec<SpanBits>,
}

#[derive(Debug, Clone, Copy)]
struct Nearest {
    range: f64,
    sum: f64,
    count: u32,
    sigma: f32,
    kind: ObstacleKind,
}

const NOTHING: Nearest =
    Nearest { range: f64::INFINITY, sum: 0.0, count: 0, sigma: 0.0, kind: ObstacleKind::Standing };

impl ScanFusion {
    /// A fusion of any number of sensors.
    ///
    /// # Errors
    /// When the configuration is out of range.
    pub fn new(config: ScanFusionConfig) -> Result<Self, Invalid> {
        Ok(Self { config: config.validated()?, nearest: Vec::new(), free: Vec::new() })
    }

    /// The fusion of several scans, with the stamp of the newest one. Each scan comes with the pose of the base at the scan's stamp,
    /// relative to the base at the newest stamp: the identity for simultaneous scans. A scan whose pose is not finite is left out.
    pub fn fuse<'a>(&mut self, scans: impl IntoIterator<Item = (Pose2, &'a Scan)>) -> Scan {
        let beams = self.config.beams;
        self.nearest.clear();
        self.nearest.resize(beams, NOTHING);
        self.free.clear();
        self.free.resize(beams, 0);
        let mut stamp: Option<Stamp> = None;
        let usable: Vec<(Pose2, &Scan)> = scans.into_iter().filter(|(pose, _)| pose.is_finite()).collect();
        for (pose, scan) in &usable {
            stamp = stamp.max(Some(scan.stamp()));
            self.note_hits(*pose, scan);
            self.note_free(*pose, scan);
        }
        for (pose, scan) in &usable {
            self.average(*pose, scan);
        }
        let step = TAU / beams as f64;
        let parts = self.scan_parts();
        Scan::from_parts(stamp.unwrap_or_default(), Vector2::zeros(), (-PI + step / 2.0, step), parts)
            .expect("invariant: ranges are norms of finite points, spans come from rising bins")
    }

    fn beam(&self, point: Vector2) -> usize {
        let turn = (wrap_angle(point.y.atan2(point.x)) + PI) / TAU;
        ((turn * self.config.beams as f64) as usize).min(self.config.beams - 1)
    }

    fn note_hits(&mut self, pose: Pose2, scan: &Scan) {
        for (i, point) in hits(pose, scan) {
            let range = point.norm();
            let at = self.beam(point);
            if range < self.nearest[at].range && range <= self.config.max_range {
                let sigma = scan.sigma(i).unwrap_or(0.0) as f32;
                let kind = scan.obstacle(i).unwrap_or_default();
                self.nearest[at] = Nearest { range, sigma, kind, ..NOTHING };
            }
        }
    }

    fn average(&mut self, pose: Pose2, scan: &Scan) {
        for (_, point) in hits(pose, scan) {
            let (range, at) = (point.norm(), self.beam(point));
            let nearest = &mut self.nearest[at];
            if range <= nearest.range + self.config.surface {
                (nearest.sum, nearest.count) = (nearest.sum + range, nearest.count + 1);
            }
        }
    }

    fn note_free(&mut self, pose: Pose2, scan: &Scan) {
        let bin = self.config.max_range / BIN_COUNT as f64;
        for i in 0..scan.beams().len() {
            for (from, to) in scan.free_spans(i) {
                let steps = ((to.min(2.0 * self.config.max_range) - from) / bin).floor().max(0.0) as usize;
                for k in 0..=steps {
                    let point =
                        pose.transform(scan.point(i, from + (k as f64 + 0.5).min(steps as f64) * bin));
                    let range = (point.norm() / bin) as usize;
                    let at = self.beam(point);
                    self.free[at] |= bins(range, range + 1);
                }
            }
        }
    }

    fn scan_parts(&self) -> ScanParts {
        let bin = self.config.max_range / BIN_COUNT as f64;
        let mut parts = ScanParts { free: Some(Vec::new()), ..ScanParts::default() };
        for (i, (nearest, bits)) in self.nearest.iter().zip(&self.free).enumerate() {
            let hit = (nearest.count > 0).then(|| nearest.sum / f64::from(nearest.count));
            let limit = hit.unwrap_or(f64::INFINITY);
            let seen = bridged(*bits)
                & hit.map_or(SpanBits::MAX, |range| BELOW[((range / bin) as usize + 1).min(BIN_COUNT)]);
            let mut end = 0.0;
            for (from, to) in spans(seen) {
                let (from, to) = (from as f64 * bin, (to as f64 * bin).min(limit));
                if to > from {
                    parts.free.get_or_insert_default().push(FreeSpan { beam: i as u32, from, to });
                    end = to;
                }
            }
            parts.beams.push(match hit {
                Some(range) => Beam::Hit { range },
                None if end > 0.0 => Beam::Free { range: end },
                None => Beam::Unseen,
            });
            parts.sigmas.push(nearest.sigma);
            parts.obstacles.push(nearest.kind);
        }
        parts
    }
}

/// The obstacle points of a scan with their beams, transformed.
fn hits<'a>(pose: Pose2, scan: &'a Scan) -> impl Iterator<Item = (usize, Vector2)> + 'a {
    scan.beams().iter().enumerate().filter_map(move |(i, beam)| match beam {
        Beam::Hit { range } => Some((i, pose.transform(scan.point(i, *range)))),
        _ => None,
    })
}
