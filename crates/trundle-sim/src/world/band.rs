//! The obstacle height band and the outlines of the objects within it.

use super::outline::fill_hull;
use super::region::Region;
use super::{Mesh, World};
use rayon::prelude::*;
use trundle_core::{Invalid, Vector2, Vector3, require_finite};

/// Number of triangles per work item of a thread. Source: ours.
const TRIANGLES_PER_CHUNK: usize = 4096;

/// The heights between which a solid is an obstacle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeightBand {
    low: f64,
    high: f64,
}

impl HeightBand {
    /// Above `low` and below `high`, m above the floor.
    ///
    /// # Errors
    /// When a bound is not finite or `high` is not above `low`.
    pub fn new(low: f64, high: f64) -> Result<Self, Invalid> {
        require_finite("low end of the height band", low, "m")?;
        require_finite("high end of the height band", high, "m")?;
        if high > low {
            Ok(Self { low, high })
        } else {
            Err(Invalid::new("high end of the height band", high, "m", format!("more than {low}")))
        }
    }

    /// Whether an object from `bottom` to `top` overlaps the band.
    fn is_reached(&self, bottom: f64, top: f64) -> bool {
        top > self.low && bottom < self.high
    }
}

/// Outlines, the corners of all in one list.
#[derive(Debug, Default)]
pub(super) struct Outlines {
    corners: Vec<Vector2>,
    /// (end among the corners, radius) of each.
    ends: Vec<(usize, f64)>,
}

impl Outlines {
    fn push(&mut self, corners: &[Vector2], radius: f64) {
        self.corners.extend_from_slice(corners);
        self.ends.push((self.corners.len(), radius));
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = Region<'_>> {
        let mut start = 0;
        self.ends.iter().map(move |&(end, radius)| {
            let region = Region { corners: &self.corners[start..end], radius };
            start = end;
            region
        })
    }
}

impl World {
    /// Parts of all solids and triangles within a height band, seen from above: one list per thread's share.
    pub(super) fn outlines_in(&self, band: HeightBand) -> Vec<Outlines> {
        let mut solids = Outlines::default();
        for (solid, outline) in self.solids.iter().zip(&self.outlines) {
            let bounds = solid.shape.aabb();
            if band.is_reached(bounds.min.z, bounds.max.z) {
                solids.push(outline.region().corners, outline.region().radius);
            }
        }
        let mut lists = vec![solids];
        for mesh in &self.meshes {
            let count = mesh.triangles().len();
            let starts: Vec<usize> = (0..count).step_by(TRIANGLES_PER_CHUNK).collect();
            lists.par_extend(
                starts
                    .par_iter()
                    .map(|&start| clip(mesh, start..(start + TRIANGLES_PER_CHUNK).min(count), band)),
            );
        }
        lists
    }
}

fn clip(mesh: &Mesh, triangles: std::ops::Range<usize>, band: HeightBand) -> Outlines {
    let (mut clipped, mut swap) = (Vec::with_capacity(8), Vec::with_capacity(8));
    let (mut points, mut hull) = (Vec::with_capacity(8), Vec::with_capacity(8));
    let mut outlines = Outlines::default();
    for i in triangles {
        let corners = mesh.corners(i).map(|corner| Vector3::from(corner.map(f64::from)));
        let bottom = corners.iter().map(|corner| corner.z).fold(f64::INFINITY, f64::min);
        let top = corners.iter().map(|corner| corner.z).fold(f64::NEG_INFINITY, f64::max);
        if !band.is_reached(bottom, top) {
            continue;
        }
        clipped.clear();
        clipped.extend(corners);
        cut(&mut clipped, &mut swap, |corner| corner.z - band.low);
        cut(&mut clipped, &mut swap, |corner| band.high - corner.z);
        points.clear();
        points.extend(clipped.iter().map(Vector3::xy));
        fill_hull(&mut points, &mut hull);
        if !hull.is_empty() {
            outlines.push(&hull, 0.0);
        }
    }
    outlines
}

/// Clips a polygon to the side with non-negative `height` (Sutherland and Hodgman 1974).
fn cut(polygon: &mut Vec<Vector3>, swap: &mut Vec<Vector3>, height: impl Fn(&Vector3) -> f64) {
    swap.clear();
    for (i, corner) in polygon.iter().enumerate() {
        let next = &polygon[if i + 1 == polygon.len() { 0 } else { i + 1 }];
        let (here, there) = (height(corner), height(next));
        if here >= 0.0 {
            swap.push(*corner);
        }
        if (here < 0.0) != (there < 0.0) {
            swap.push(corner + (next - corner) * (here / (here - there)));
        }
    }
    std::mem::swap(polygon, swap);
}
