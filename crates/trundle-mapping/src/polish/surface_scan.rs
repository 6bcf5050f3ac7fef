//! Hits of a scan with the lines through their surfaces, ordered by bearing.

use crate::polish::line_fit::line_at;
use crate::scan_match::scan_points::ScanHit;
use trundle_core::Vector2;

/// Largest number of hits of a scan. Of more, every n-th is used. Source: ours, a scanner of 0.5 deg over half a turn.
const MAX_HITS: usize = 361;
/// Number of hits on each side of a bearing among which the counterpart of a point is searched. Source: ours; at 1 deg and 2 m the
/// filter's reach of 0.2 m.
const BEARING_REACH_HITS: usize = 6;
/// Range up to which hits count for the centre of a view \[m\]. A far hit at the end of a corridor would displace the centre. Source: ours.
const VIEW_RANGE_M: f64 = 8.0;
/// Largest distance of neighbouring hits that counts as the uncertainty of an edge \[m\]. Source: ours.
const MAX_SPACING_M: f64 = 0.3;

/// A hit of a scan, base frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct SurfaceHit {
    /// End point, m.
    end: [f32; 2],
    /// Normal of the surface towards the sensor; zero without a straight surface.
    normal: [f32; 2],
    /// Distance of the surface's line from the base along the normal, m.
    offset: f32,
    /// Distance to the nearer neighbouring hit, m.
    spacing: f32,
    /// One sigma of the range, m.
    sigma: f32,
}

impl SurfaceHit {
    /// End point, m.
    pub(super) fn end(&self) -> Vector2 {
        self.end.map(f64::from).into()
    }

    /// Unit normal of the surface towards the sensor; zero without a straight surface.
    pub(super) fn normal(&self) -> Vector2 {
        self.normal.map(f64::from).into()
    }

    /// Whether the hit is on a straight surface.
    pub(super) fn is_straight(&self) -> bool {
        self.normal != [0.0, 0.0]
    }

    /// Distance of the surface's line from the base along the normal, m.
    pub(super) fn offset(&self) -> f64 {
        f64::from(self.offset)
    }

    /// Distance to the nearer neighbouring hit, m.
    pub(super) fn spacing(&self) -> f64 {
        f64::from(self.spacing)
    }

    /// One sigma of the range, m.
    pub(super) fn sigma(&self) -> f64 {
        f64::from(self.sigma)
    }

    fn new(hits: &[ScanHit], k: usize, origin: Vector2) -> Self {
        let hit = hits[k];
        let gap = |other: Option<&ScanHit>| other.map_or(MAX_SPACING_M, |other| (other.end - hit.end).norm());
        let spacing = gap(k.checked_sub(1).map(|k| &hits[k])).min(gap(hits.get(k + 1))).min(MAX_SPACING_M);
        let line = line_at(hits, k, origin);
        Self {
            end: [hit.end.x as f32, hit.end.y as f32],
            normal: line.map_or([0.0, 0.0], |line| [line.normal.x as f32, line.normal.y as f32]),
            offset: line.map_or(0.0, |line| line.offset as f32),
            spacing: spacing as f32,
            sigma: hit.sigma as f32,
        }
    }
}

/// The hits of a scan by bearing from the sensor.
#[derive(Debug, Clone)]
pub(super) struct SurfaceScan {
    /// Position of the sensor, base frame, m.
    origin: Vector2,
    pub(super) hits: Vec<SurfaceHit>,
    /// Pseudo-angle of each hit, ascending.
    bearings: Vec<f32>,
    /// Mean of the near hits, base frame, m: the place that the scan observes.
    pub(super) centre: Vector2,
}

impl SurfaceScan {
    /// The hits `all` (base frame, in the order of their beams) of a sensor at `origin` (base frame, m).
    pub(super) fn new(origin: Vector2, all: &[ScanHit]) -> Self {
        let every = all.len().div_ceil(MAX_HITS).max(1);
        let mut hits: Vec<(f32, SurfaceHit)> = (0..all.len())
            .step_by(every)
            .map(|k| (pseudo_angle(all[k].end - origin), SurfaceHit::new(all, k, origin)))
            .collect();
        hits.sort_by(|a, b| a.0.total_cmp(&b.0));
        let near = |end: &Vector2| (end - origin).norm() < VIEW_RANGE_M;
        let near: Vec<Vector2> = all.iter().map(|hit| hit.end).filter(near).collect();
        let centre = if near.is_empty() { origin } else { near.iter().sum::<Vector2>() / near.len() as f64 };
        let (bearings, hits) = hits.into_iter().unzip();
        Self { origin, hits, bearings, centre }
    }

    /// The hits near the bearing of a point (base frame, m).
    pub(super) fn around(&self, point: Vector2) -> &[SurfaceHit] {
        let at = self.after(point);
        &self.hits[at.saturating_sub(BEARING_REACH_HITS)..(at + BEARING_REACH_HITS).min(self.hits.len())]
    }

    /// Length by which the scan observes free space beyond a point (base frame, m); `None` outside its field of view.
    pub(super) fn free_beyond(&self, point: Vector2) -> Option<f64> {
        let at = self.after(point);
        let range = |hit: &SurfaceHit| (hit.end() - self.origin).norm();
        let (before, after) = (self.hits.get(at.checked_sub(1)?)?, self.hits.get(at)?);
        Some(range(before).min(range(after)) - (point - self.origin).norm())
    }

    /// Number of the first hit beyond the bearing of a point.
    fn after(&self, point: Vector2) -> usize {
        let bearing = pseudo_angle(point - self.origin);
        self.bearings.partition_point(|other| *other < bearing)
    }
}

/// A monotonic function of the angle of a vector, in [-2, 2], without trigonometry.
fn pseudo_angle(v: Vector2) -> f32 {
    let all = v.x.abs() + v.y.abs();
    let share = if all > 0.0 { v.y / all } else { 0.0 };
    let angle = match (v.x >= 0.0, v.y >= 0.0) {
        (true, _) => share,
        (false, true) => 2.0 - share,
        (false, false) => -2.0 - share,
    };
    angle as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pseudo_angle_rises_with_the_angle() {
        let at = |k: i32| {
            let (s, c) = (f64::from(k) * 0.01).sin_cos();
            pseudo_angle(Vector2::new(3.0 * c, 3.0 * s))
        };
        assert!((-313..313).all(|k| at(k) < at(k + 1)));
        assert_eq!(pseudo_angle(Vector2::zeros()), 0.0);
    }
}
