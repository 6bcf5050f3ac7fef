use super::{ScanShape, shape::ScanRay};

/// A processed scan, packed: 5 bytes a beam.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct StoredScan {
    /// Where the beams begin, base frame, cells.
    pub(crate) origin: (f32, f32),
    rays: Box<[PackedRay]>,
}

/// The end of a beam in 1/16 cells, and how it relates to the ray before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C, packed)]
struct PackedRay {
    x: i16,
    y: i16,
    /// 1: a hit; 2: on one surface with the ray before; 4 and up: beams since the ray before.
    what: u8,
}

/// A ray with the number of its beam, counted from the first ray's.
pub(crate) struct StoredRay {
    pub(crate) ray: ScanRay,
    pub(crate) beam: usize,
}

/// Units a cell.
const PER_CELL: f32 = 16.0;
const HIT: u8 = 1;
const JOINED: u8 = 2;
const MOST_SKIPPED: usize = 63;

impl StoredScan {
    /// Packs a scan. Ends farther than 2047 cells are left out: a ray of a laser at 5 cm reaches 102 m.
    pub(crate) fn new(shape: &ScanShape) -> Self {
        let mut last = None;
        let pack = |v: f32| {
            let scaled = (v * PER_CELL).round();
            (scaled.abs() <= f32::from(i16::MAX)).then_some(scaled as i16)
        };
        let packed = shape.rays.iter().zip(&shape.beams).filter_map(|(ray, &beam)| {
            let (x, y) = (pack(ray.x)?, pack(ray.y)?);
            let skipped = last.map_or(0, |last| beam - last).min(MOST_SKIPPED) as u8;
            last = Some(beam);
            let what = (skipped << 2)
                | if ray.hit { HIT } else { 0 }
                | if ray.joined && skipped == 1 { JOINED } else { 0 };
            Some(PackedRay { x, y, what })
        });
        Self { origin: shape.origin, rays: packed.collect() }
    }

    /// The rays, in order.
    pub(crate) fn rays(&self) -> impl Iterator<Item = StoredRay> {
        let mut beam = 0;
        self.rays.iter().map(move |packed| {
            beam += usize::from(packed.what >> 2);
            let ray = ScanRay {
                x: f32::from(packed.x) / PER_CELL,
                y: f32::from(packed.y) / PER_CELL,
                hit: packed.what & HIT != 0,
                joined: packed.what & JOINED != 0,
            };
            StoredRay { ray, beam }
        })
    }

    /// Bytes that it holds.
    pub(crate) fn bytes(&self) -> usize {
        size_of::<Self>() + self.rays.len() * size_of::<PackedRay>()
    }

    /// The numbers it consists of, for saving.
    pub(crate) fn raw(&self) -> impl Iterator<Item = (i16, i16, u8)> {
        self.rays.iter().map(|ray| (ray.x, ray.y, ray.what))
    }

    /// From its numbers.
    pub(crate) fn from_raw(origin: (f32, f32), rays: impl Iterator<Item = (i16, i16, u8)>) -> Self {
        Self { origin, rays: rays.map(|(x, y, what)| PackedRay { x, y, what }).collect() }
    }
}
