//! Free voxels along the camera's rays, and occupied voxels at their ends and on a surface.

use crate::depth_view::DepthView;
use crate::surface_config::SurfaceConfig;
use crate::surface_mesh::SurfaceMesh;
use crate::triangle_voxels::Triangle;
use nalgebra::Vector3;
use std::collections::{BTreeMap, HashSet};
use trundle_core::{Invalid, PinholeCamera, Pose3, RgbdImage, require_in};

/// Pixels between two rays. Source: ours; two rays at 3 m are then 6 cm apart, about a voxel.
const RAY_STRIDE_PX: usize = 8;
/// Logarithm of the odds that an end of a ray adds, in steps of 0.05. Source: the defaults of OctoMap, probabilities 0.7 and 0.4.
const HIT_STEPS: i16 = 17;
/// Logarithm of the odds that a passing ray takes away, in steps of 0.05. Source: the defaults of OctoMap, probabilities 0.7 and 0.4.
const MISS_STEPS: i16 = 8;
/// Bounds of the sum, in steps of 0.05. Source: the defaults of OctoMap, probabilities 0.12 and 0.97.
const SUM_RANGE_STEPS: (i16, i16) = (-40, 70);
/// Largest number of voxels. Source: ours, about 2 GB.
const MAX_VOXELS: usize = 40_000_000;

/// State of a known voxel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VoxelState {
    /// Rays pass, and no surface.
    Free,
    /// Rays end, or a surface passes.
    Occupied,
}

/// Voxels that are known to be free or occupied.
#[derive(Debug, Clone)]
pub struct OccupiedVoxels {
    resolution: f64,
    sums: BTreeMap<[i32; 3], i16>,
}

impl OccupiedVoxels {
    /// No voxels yet; sides of `resolution` m, 0.01 to 1.
    ///
    /// # Errors
    /// When the resolution is outside its range.
    pub fn new(resolution: f64) -> Result<Self, Invalid> {
        require_in("resolution", resolution, "m", 0.01, 1.0)?;
        Ok(Self { resolution, sums: BTreeMap::new() })
    }

    /// Side of a voxel, m.
    #[must_use]
    pub fn resolution(&self) -> f64 {
        self.resolution
    }

    /// Whether no further voxel is taken.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.sums.len() >= MAX_VOXELS
    }

    /// Known voxels by rising x, y, z, in units of their side. Voxel (0, 0, 0) has its lowest corner at the origin of the map.
    pub fn iter(&self) -> impl Iterator<Item = ([i32; 3], VoxelState)> {
        let state = |sum: i16| if sum > 0 { VoxelState::Occupied } else { VoxelState::Free };
        self.sums.iter().map(move |(key, sum)| (*key, state(*sum)))
    }

    /// Adds the rays of an image that `camera` took at `map_from_camera`. `config` has the range of valid depths.
    ///
    /// # Errors
    /// When the image has another size than the camera, or the pose is not finite.
    pub fn integrate(
        &mut self,
        image: &RgbdImage,
        camera: &PinholeCamera,
        map_from_camera: &Pose3,
        config: &SurfaceConfig,
    ) -> Result<(), Invalid> {
        let view = DepthView::new(image, camera, map_from_camera, config)?;
        let start = view.centre() / self.resolution;
        let ends: Vec<Vector3<f64>> =
            view.points(RAY_STRIDE_PX, |depth| [depth]).map(|[end]| end / self.resolution).collect();
        let hits: HashSet<[i32; 3]> = ends.iter().map(|end| voxel_of(*end)).collect();
        let mut passed = HashSet::new();
        for end in &ends {
            passed.extend(voxels_between(start, *end).filter(|voxel| !hits.contains(voxel)));
        }
        hits.iter().for_each(|voxel| self.add(*voxel, HIT_STEPS));
        passed.iter().for_each(|voxel| self.add(*voxel, -MISS_STEPS));
        Ok(())
    }

    /// Marks every voxel that holds a vertex of `mesh` (map frame, m), or that a triangle passes through, as occupied. The rays of a distant
    /// or slanted surface are sparser than voxels; the mesh closes the holes between them.
    ///
    /// # Errors
    /// When a triangle has a missing vertex, a coordinate is not finite, or a triangle has more than 10^6 voxels in its box. Nothing is
    /// then marked.
    pub fn mark_surface(&mut self, mesh: &SurfaceMesh) -> Result<(), Invalid> {
        let points = (0..mesh.vertices.len() as u32).map(|vertex| [vertex; 3]);
        let shapes = points.chain(mesh.triangles.iter().copied());
        let shapes = shapes.map(|corners| Triangle::of(mesh, corners, self.resolution));
        let shapes = shapes.collect::<Result<Vec<_>, _>>()?;
        shapes.into_iter().flat_map(Triangle::voxels).for_each(|voxel| self.mark(voxel));
        Ok(())
    }

    /// Makes a voxel occupied as one end of a ray does; a higher sum stays.
    fn mark(&mut self, voxel: [i32; 3]) {
        if !self.is_full() || self.sums.contains_key(&voxel) {
            let sum = self.sums.entry(voxel).or_default();
            *sum = (*sum).max(HIT_STEPS);
        }
    }

    fn add(&mut self, voxel: [i32; 3], steps: i16) {
        if !self.is_full() || self.sums.contains_key(&voxel) {
            let sum = self.sums.entry(voxel).or_default();
            *sum = (*sum + steps).clamp(SUM_RANGE_STEPS.0, SUM_RANGE_STEPS.1);
        }
    }
}

fn voxel_of(at: Vector3<f64>) -> [i32; 3] {
    at.map(|coordinate| coordinate.floor() as i32).into()
}

/// The voxels from `start` to before the one of `end`, in units of voxels: each step crosses the nearest face (\[Amanatides87\]).
fn voxels_between(start: Vector3<f64>, end: Vector3<f64>) -> impl Iterator<Item = [i32; 3]> {
    let (mut voxel, last) = (voxel_of(start), voxel_of(end));
    let along = end - start;
    let step: [i32; 3] = along.map(|component| if component < 0.0 { -1 } else { 1 }).into();
    let mut next: [f64; 3] = std::array::from_fn(|i| {
        let face = f64::from(voxel[i]) + if step[i] > 0 { 1.0 } else { 0.0 };
        if along[i] == 0.0 { f64::INFINITY } else { (face - start[i]) / along[i] }
    });
    let steps: u32 = (0..3).map(|i| voxel[i].abs_diff(last[i])).sum();
    (0..steps).map(move |_| {
        let passed = voxel;
        let axis = (0..3).min_by(|&a, &b| next[a].total_cmp(&next[b])).unwrap_or(0);
        voxel[axis] += step[axis];
        next[axis] += (1.0 / along[axis]).abs();
        passed
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use trundle_core::{ColorImage, DepthImage, Stamp};

    #[test]
    fn before_a_wall_is_free_floor_and_behind_it_nothing_is_known() {
        let camera = PinholeCamera::kinect_v2();
        let (width, height) = (camera.width(), camera.height());
        let depth = DepthImage::filled(width, height, 2.02);
        let image =
            RgbdImage::new(Stamp::default(), ColorImage::filled(width, height, [9; 3]), depth).unwrap();
        let mut voxels = OccupiedVoxels::new(0.05).unwrap();
        voxels.integrate(&image, &camera, &Pose3::identity(), &SurfaceConfig::default()).unwrap();
        let state = |z: i32| voxels.iter().find(|(key, _)| *key == [0, 0, z]).map(|(_, state)| state);
        assert_eq!((state(20), state(39)), (Some(VoxelState::Free), Some(VoxelState::Free)));
        assert_eq!((state(40), state(41)), (Some(VoxelState::Occupied), None));
    }

    proptest! {
        #[test]
        fn a_ray_passes_voxels_that_touch_each_other(
            start in prop::array::uniform3(-9.0..9.0), end in prop::array::uniform3(-9.0..9.0),
        ) {
            let (start, end) = (Vector3::from(start), Vector3::from(end));
            let passed: Vec<_> = voxels_between(start, end).chain([voxel_of(end)]).collect();
            prop_assert_eq!(passed[0], voxel_of(start));
            for pair in passed.windows(2) {
                let steps: u32 = (0..3).map(|i| pair[0][i].abs_diff(pair[1][i])).sum();
                prop_assert_eq!(steps, 1);
            }
        }
    }
}
