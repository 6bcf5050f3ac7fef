//! Readings along each bearing of one depth image, and the scan made from them.

use super::{
    mount::{BeamView, Mount},
    pixel_model::PixelModel,
    pixel_row::{ClassifiedRow, kind},
    range_bins::{BELOW, BIN_COUNT, SpanBits, bins, bridged, spans},
};
use trundle_core::{Beam, FreeSpan, ObstacleKind, ScanParts};

/// Obstacles and free space along each bearing of one image.
#[derive(Debug, Clone, Default)]
pub(super) struct Bearings {
    /// Nearest certain obstacle, m.
    nearest: Vec<f32>,
    /// Nearest edge of a hole, m.
    drop: Vec<f32>,
    floor: Vec<SpanBits>,
    passed: Vec<SpanBits>,
    surfaces: Vec<Surface>,
    points: Vec<Point>,
}

/// A pixel in the height band.
#[derive(Debug, Clone, Copy)]
struct Point {
    range: f32,
    height: f32,
    beam: u16,
}

/// The points of the nearest surface of a bearing.
#[derive(Debug, Clone, Copy)]
struct Surface {
    sum: f64,
    count: u32,
    /// Height of the obstacle's lowest point, m.
    lowest: f32,
}

impl Surface {
    const EMPTY: Self = Self { sum: 0.0, count: 0, lowest: f32::INFINITY };
}

/// Minimum clearance under an overhang above the highest floor point \[m\]. A lower surface counts as an obstacle that reaches the floor.
/// Source: ours.
const MIN_CLEARANCE_M: f32 = 0.05;
/// Maximum gap between visible floor and the foot of an obstacle \[bins\]. A gap up to this size counts as free. Source: ours.
const FOOT_GAP_BINS: usize = 2;

impl Bearings {
    pub(super) fn reset(&mut self, beams: usize) {
        fn fill<T: Clone>(list: &mut Vec<T>, beams: usize, value: T) {
            list.clear();
            list.resize(beams, value);
        }
        fill(&mut self.nearest, beams, f32::INFINITY);
        fill(&mut self.drop, beams, f32::INFINITY);
        fill(&mut self.floor, beams, 0);
        fill(&mut self.passed, beams, 0);
        fill(&mut self.surfaces, beams, Surface::EMPTY);
        self.points.clear();
    }

    /// Reserves memory for all pixels of an image.
    pub(super) fn reserve(&mut self, pixels: usize) {
        self.points.reserve(pixels);
    }

    /// Adds a row; `beams` are the beams of its pixels.
    pub(super) fn add_row(&mut self, row: &ClassifiedRow, beams: &[u16]) {
        let inner = 1..row.marks.len().saturating_sub(1);
        for i in inner {
            let mark = row.marks[i];
            if mark == kind::NOTHING {
                continue;
            }
            let (beam, range) = (usize::from(beams[i]), row.ranges[i]);
            let cleared = || bins((mark >> 8 & 255) as usize, (mark >> 16) as usize);
            match mark & 255 {
                kind::FLOOR => self.floor[beam] |= cleared(),
                kind::OBSTACLE | kind::DOUBTFUL => {
                    self.points.push(Point { range, height: row.heights[i], beam: beams[i] });
                    if mark == kind::OBSTACLE && range < self.nearest[beam] {
                        self.nearest[beam] = range;
                    }
                }
                kind::PASSING => self.passed[beam] |= cleared(),
                _ => self.drop[beam] = self.drop[beam].min(range),
            }
        }
    }

    /// The nearest of many noisy points has a bias towards the camera: the range is the mean over the surface of this point.
    pub(super) fn average_surfaces(&mut self, model: &PixelModel) {
        for point in &self.points {
            let beam = usize::from(point.beam);
            let nearest = self.nearest[beam];
            if point.range >= nearest && point.range <= nearest + model.surface_window(nearest) {
                let surface = &mut self.surfaces[beam];
                surface.sum += f64::from(point.range);
                surface.count += 1;
                surface.lowest = surface.lowest.min(point.height);
            }
        }
    }

    /// Writes hits, free spans and sigmas of all bearings into the lists of a scan.
    pub(super) fn write_parts(&self, mount: &Mount, model: &PixelModel, parts: &mut ScanParts) {
        let ScanParts { beams, free, sigmas, obstacles, bearings } = parts;
        let free = free.get_or_insert_default();
        beams.clear();
        free.clear();
        sigmas.clear();
        obstacles.clear();
        bearings.clear();
        let bin_length = 1.0 / f64::from(model.bins_per_metre);
        for (i, view) in mount.views.iter().enumerate() {
            let hit = self.hit(i, model);
            let cleared = self.cleared(i, view, model, hit.map(|(range, _)| range));
            let limit = hit.map_or(f64::INFINITY, |(range, _)| range);
            let mut end = 0.0;
            for (from, to) in spans(cleared) {
                let (from, to) = (from as f64 * bin_length, (to as f64 * bin_length).min(limit));
                if to > from {
                    free.push(FreeSpan { beam: i as u32, from, to });
                    end = to;
                }
            }
            beams.push(match hit {
                Some((range, _)) => Beam::Hit { range },
                None if end > 0.0 => Beam::Free { range: end },
                None => Beam::Unseen,
            });
            obstacles.push(hit.map_or(ObstacleKind::Standing, |(_, kind)| kind));
            sigmas.push(hit.map_or(0.0, |(range, _)| sigma(range as f32, view, model)));
        }
    }

    /// The obstacle of a bearing; `None` without one.
    fn hit(&self, i: usize, model: &PixelModel) -> Option<(f64, ObstacleKind)> {
        let surface = self.surfaces[i];
        let drop = self.drop[i];
        if surface.count == 0 || drop < self.nearest[i] {
            return drop.is_finite().then(|| (f64::from(drop), ObstacleKind::Drop));
        }
        let range = surface.sum / f64::from(surface.count);
        let kind =
            if self.hangs(i, range as f32, model) { ObstacleKind::Overhang } else { ObstacleKind::Standing };
        Some((range, kind))
    }

    /// Whether the floor continues under the obstacle of a bearing: rays below its lowest point reached the floor behind it.
    fn hangs(&self, i: usize, range: f32, model: &PixelModel) -> bool {
        let lowest = self.surfaces[i].lowest;
        if lowest < model.floor_edge(1.0, range, range) + MIN_CLEARANCE_M {
            return false;
        }
        let over = model.camera_height - lowest;
        let shadow = if over > 0.0 { range * model.camera_height / over } else { f32::INFINITY };
        let bin = |range: f32| (range * model.bins_per_metre).min(BIN_COUNT as f32) as usize;
        let under = bins(bin(range) + 2, bin(shadow).max(bin(range) + 4));
        (self.floor[i] & under).count_ones() >= 2
    }

    /// Free bins of a bearing up to its obstacle.
    fn cleared(&self, i: usize, view: &BeamView, model: &PixelModel, hit: Option<f64>) -> SpanBits {
        let before_hit = hit.map(|range| ((range as f32 * model.bins_per_metre) as usize + 1).min(BIN_COUNT));
        let below_band = model.camera_height < model.high;
        // A ray that passed through the band in front of its hit.
        let passed = self.passed[i] | before_hit.filter(|_| below_band).map_or(0, |to| BELOW[to]);
        let mut bits = bridged(self.floor[i] | passed & !view.floor & !BELOW[view.begin.min(BIN_COUNT)]);
        if view.floor == 0 {
            bits |= passed;
        }
        // Floor too near to be visible counts as free if the first visible floor is free.
        if bits & bins(view.begin, view.begin + 2) != 0 {
            bits |= BELOW[(view.begin + 1).min(BIN_COUNT)];
        }
        let Some(to) = before_hit else { return bits };
        let foot = bins(to.saturating_sub(FOOT_GAP_BINS + 1), to);
        let touched = bits & bins(to.saturating_sub(FOOT_GAP_BINS + 1), to) != 0;
        (if touched { bits | bins((bits & foot).trailing_zeros() as usize, to) } else { bits }) & BELOW[to]
    }
}

/// Standard deviation of a range, m: the noise of its depth over the floor. At most the range: along an almost vertical ray, the noise of
/// the depth can be of any size.
fn sigma(range: f32, view: &BeamView, model: &PixelModel) -> f32 {
    let noise = if view.run > 0.0 {
        view.run * model.noise.sigma(range / view.run)
    } else {
        model.noise.sigma(range)
    };
    noise.min(range)
}
