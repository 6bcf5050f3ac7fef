//! The voxels that a triangle passes through.

use crate::surface_mesh::SurfaceMesh;
use nalgebra::Vector3;
use std::ops::RangeInclusive;
use trundle_core::Invalid;

/// Largest number of voxels in the box around a triangle \[1\]. A larger triangle is an error. Source: ours, a quad of 5 x 5 m at 5 cm.
const MAX_BOX_VOXELS: f64 = 1e6;
/// Gap that separates a triangle from a voxel \[voxels\]: rounding is smaller. Source: ours.
const MIN_GAP_VOXELS: f64 = 1e-9;
/// Largest coordinate in units of voxels \[1\]: the next integers are still voxels. Source: the range of `i32`.
const MAX_COORDINATE_VOXELS: f64 = 2e9;

/// A triangle in units of voxels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Triangle {
    corners: [Vector3<f64>; 3],
}

impl Triangle {
    /// The triangle of three vertices of a mesh, for voxels of `resolution` m.
    ///
    /// # Errors
    /// When the mesh has no such vertex, a coordinate is not finite, or the triangle is too large for voxels of this size.
    pub(crate) fn of(mesh: &SurfaceMesh, corners: [u32; 3], resolution: f64) -> Result<Self, Invalid> {
        let count = mesh.vertices.len();
        let refused = |value: String, unit, expected: String| {
            Invalid::new("triangle of the mesh", value, unit, expected)
        };
        let mut triangle = Self { corners: [Vector3::zeros(); 3] };
        for (corner, index) in triangle.corners.iter_mut().zip(corners) {
            let vertex = mesh.vertices.get(index as usize);
            let vertex =
                vertex.ok_or_else(|| refused(format!("vertex {index}"), "", format!("below {count}")))?;
            *corner = Vector3::from(*vertex).cast::<f64>() / resolution;
        }
        let sides = triangle.range().map(|(low, high)| high - low + 1.0);
        let is_near = triangle.corners.iter().all(|corner| corner.amax() < MAX_COORDINATE_VOXELS);
        // A comparison with NaN is false.
        if is_near && sides.iter().product::<f64>() <= MAX_BOX_VOXELS {
            return Ok(triangle);
        }
        let at = triangle.corners.map(|corner| (corner * resolution).as_slice().to_vec());
        Err(refused(
            format!("{at:?}"),
            "m",
            format!("a box of at most {MAX_BOX_VOXELS} voxels of {resolution} m"),
        ))
    }

    /// The lowest and the highest voxel on each axis.
    fn range(&self) -> [(f64, f64); 3] {
        std::array::from_fn(|axis| {
            let on_axis = self.corners.map(|corner| corner[axis].floor());
            let pick = |pick: fn(f64, f64) -> f64| on_axis[1..].iter().fold(on_axis[0], |a, b| pick(a, *b));
            (pick(f64::min), pick(f64::max))
        })
    }

    /// The voxels that the triangle passes through, by the separating axes of triangle and cube (\[AkenineMoeller01\]). A triangle in the
    /// plane between two voxels passes through the upper one.
    pub(crate) fn voxels(self) -> impl Iterator<Item = [i32; 3]> {
        let [x, y, z] = self.range().map(|(low, high)| -> RangeInclusive<i32> { low as i32..=high as i32 });
        let in_box = x.flat_map(move |x| {
            let z = z.clone();
            y.clone().flat_map(move |y| z.clone().map(move |z| [x, y, z]))
        });
        in_box.filter(move |voxel| self.passes(*voxel))
    }

    /// Whether no plane separates the triangle from a voxel in its box.
    fn passes(&self, voxel: [i32; 3]) -> bool {
        let centre = Vector3::from(voxel).cast::<f64>().add_scalar(0.5);
        let corners = self.corners.map(|corner| corner - centre);
        let sides = [corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]];
        let units = [Vector3::x(), Vector3::y(), Vector3::z()];
        let crossed = sides.iter().flat_map(|side| units.iter().map(move |unit| side.cross(unit)));
        let mut axes = crossed.chain([sides[0].cross(&sides[1])]);
        !axes.any(|axis| separates(&axis, &corners))
    }
}

/// Whether an axis separates a triangle from the unit cube about the origin.
fn separates(axis: &Vector3<f64>, corners: &[Vector3<f64>; 3]) -> bool {
    let half = axis.abs().sum() / 2.0 + MIN_GAP_VOXELS;
    let along = corners.map(|corner| axis.dot(&corner));
    along.iter().all(|at| *at > half) || along.iter().all(|at| *at < -half)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    fn triangle(corners: [[f32; 3]; 3]) -> Result<Triangle, Invalid> {
        let mesh = SurfaceMesh { vertices: corners.to_vec(), ..SurfaceMesh::default() };
        Triangle::of(&mesh, [0, 1, 2], 1.0)
    }

    fn any_corner() -> impl Strategy<Value = [f32; 3]> {
        prop::array::uniform3(-4.0..4.0_f32)
    }

    proptest! {
        /// The voxels cover the triangle, and each of them is near it.
        #[test]
        fn the_voxels_are_those_of_the_triangles_points(corners in prop::array::uniform3(any_corner())) {
            let triangle = triangle(corners).unwrap();
            let voxels: BTreeSet<[i32; 3]> = triangle.voxels().collect();
            let [a, b, c] = triangle.corners;
            let mut nearest = vec![f64::INFINITY; voxels.len()];
            for i in 0..=60 {
                for j in 0..=60 - i {
                    let point = a + (b - a) * (f64::from(i) / 60.0) + (c - a) * (f64::from(j) / 60.0);
                    let voxel: [i32; 3] = point.map(|at| at.floor() as i32).into();
                    prop_assert!(voxels.contains(&voxel), "{point:?} {voxel:?}");
                    for (nearest, voxel) in nearest.iter_mut().zip(&voxels) {
                        let centre = Vector3::from(*voxel).cast::<f64>().add_scalar(0.5);
                        *nearest = nearest.min((point - centre).amax());
                    }
                }
            }
            // The points are at most 0.24 voxels apart.
            prop_assert!(nearest.iter().all(|gap| *gap < 0.75), "{nearest:?}");
        }
    }

    #[test]
    fn a_triangle_in_a_plane_between_voxels_passes_through_one_layer() {
        let flat = triangle([[0.1, 0.1, 2.0], [2.9, 0.1, 2.0], [0.1, 2.9, 2.0]]).unwrap();
        assert!(flat.voxels().count() >= 6);
        assert!(flat.voxels().all(|voxel| voxel[2] == 2));
        let point = triangle([[-0.5; 3]; 3]).unwrap();
        assert_eq!(point.voxels().collect::<Vec<_>>(), [[-1; 3]]);
    }

    #[test]
    fn wrong_triangles_are_named() {
        let mesh = SurfaceMesh { vertices: vec![[0.0; 3]; 2], ..SurfaceMesh::default() };
        let missing = Triangle::of(&mesh, [0, 1, 2], 0.05).unwrap_err().to_string();
        assert!(missing.contains("vertex 2") && missing.contains("below 2"), "{missing}");
        for wrong in [f32::NAN, f32::INFINITY, 1e30, 500.0] {
            let error = triangle([[0.0; 3], [wrong, 0.0, 0.0], [0.0, wrong, wrong]]).unwrap_err();
            assert!(error.to_string().contains("at most 1000000 voxels of 1 m"), "{error}");
        }
    }
}
