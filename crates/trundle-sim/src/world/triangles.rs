//! Triangles of a world's meshes in the order of the hierarchy's leaves.

use super::mesh::Mesh;
use super::{Aabb, Bvh};
use trundle_core::Vector3;

/// Triangles of a [`Block`]. Source: ours.
pub(crate) const TRIANGLES_PER_BLOCK: usize = 4;

/// The triangles of a world's meshes in the order of the leaves of a hierarchy, for ray casts.
#[derive(Debug)]
pub(crate) struct Triangles {
    bvh: Bvh,
    /// One block per leaf.
    blocks: Vec<Block>,
    surfaces: Vec<Surface>,
    /// Mesh and triangle within the mesh.
    sources: Vec<(u32, u32)>,
}

/// The corners of up to four triangles, interleaved: corner, axis, triangle; world frame, m. Missing triangles are points.
#[derive(Debug, Clone)]
pub(crate) struct Block {
    pub(crate) corners: [[[f32; TRIANGLES_PER_BLOCK]; 3]; 3],
    /// Index of the first triangle.
    pub(crate) first: u32,
}

/// Appearance of a triangle: texture coordinates are affine functions of the position.
#[derive(Debug, Clone)]
pub(crate) struct Surface {
    /// Unit length; which side is undefined.
    pub(crate) normal: [f32; 3],
    /// A point of the triangle, and its texture coordinates.
    pub(crate) corner: [f32; 3],
    pub(crate) uv: [f32; 2],
    /// Gradients of u and v per metre.
    pub(crate) across: [f32; 3],
    pub(crate) down: [f32; 3],
    /// Index of the material among those of all meshes.
    pub(crate) material: u32,
}

impl Triangles {
    pub(crate) fn new(meshes: &[Mesh]) -> Self {
        let sources: Vec<(u32, u32)> = (0..)
            .zip(meshes)
            .flat_map(|(m, mesh)| (0..mesh.triangles().len() as u32).map(move |t| (m, t)))
            .collect();
        let boxes: Vec<Aabb> =
            sources.iter().map(|&(m, t)| bounds(&meshes[m as usize].corners(t as usize))).collect();
        let bvh = Bvh::new(&boxes, TRIANGLES_PER_BLOCK);
        let sources: Vec<(u32, u32)> = bvh.items().iter().map(|&item| sources[item as usize]).collect();
        let first_material: Vec<u32> = first_materials(meshes);
        let surfaces = sources
            .iter()
            .map(|&(m, t)| Surface::new(&meshes[m as usize], t as usize, first_material[m as usize]))
            .collect();
        let blocks = (0..bvh.leaf_count()).map(|leaf| Block::new(meshes, &sources, bvh.leaf(leaf))).collect();
        Self { bvh, blocks, surfaces, sources }
    }

    pub(crate) fn bvh(&self) -> &Bvh {
        &self.bvh
    }

    /// The triangles of a leaf of the hierarchy.
    pub(crate) fn block(&self, leaf: usize) -> &Block {
        &self.blocks[leaf]
    }

    pub(crate) fn surface(&self, triangle: usize) -> &Surface {
        &self.surfaces[triangle]
    }

    /// Index of the mesh, and of the triangle in the mesh.
    pub(crate) fn source(&self, triangle: usize) -> (usize, usize) {
        let (mesh, triangle) = self.sources[triangle];
        (mesh as usize, triangle as usize)
    }

    pub(crate) fn len(&self) -> usize {
        self.surfaces.len()
    }
}

/// Number of materials before each mesh.
fn first_materials(meshes: &[Mesh]) -> Vec<u32> {
    let mut sum = 0;
    meshes
        .iter()
        .map(|mesh| {
            let first = sum;
            sum += mesh.materials().len() as u32;
            first
        })
        .collect()
}

fn bounds(corners: &[[f32; 3]; 3]) -> Aabb {
    let [a, b, c] = corners.map(|corner| Vector3::from(corner.map(f64::from)));
    Aabb { min: a.inf(&b).inf(&c), max: a.sup(&b).sup(&c) }
}

impl Block {
    fn new(meshes: &[Mesh], sources: &[(u32, u32)], (first, end): (usize, usize)) -> Self {
        let mut block = Self { corners: [[[0.0; TRIANGLES_PER_BLOCK]; 3]; 3], first: first as u32 };
        for (lane, &(mesh, triangle)) in sources[first..end].iter().enumerate() {
            for (i, corner) in meshes[mesh as usize].corners(triangle as usize).iter().enumerate() {
                (0..3).for_each(|k| block.corners[i][k][lane] = corner[k]);
            }
        }
        block
    }
}

impl Surface {
    fn new(mesh: &Mesh, triangle: usize, first_material: u32) -> Self {
        let corners = mesh.corners(triangle);
        let [a, b, c] = corners.map(|corner| Vector3::from(corner.map(f64::from)));
        let indices = mesh.triangles()[triangle].corners;
        let uvs = indices.map(|i| mesh.uvs()[i as usize].map(f64::from));
        let (ab, ac) = (b - a, c - a);
        let normal = ab.cross(&ac);
        // The basis dual to ab and ac in the plane.
        let square = normal.norm_squared();
        let scale = if square > 0.0 { 1.0 / square } else { 0.0 };
        let (to_b, to_c) = (ac.cross(&normal) * scale, normal.cross(&ab) * scale);
        let growth = |k: usize| to_b * (uvs[1][k] - uvs[0][k]) + to_c * (uvs[2][k] - uvs[0][k]);
        let single = |v: Vector3| -> [f32; 3] { v.map(|x| x as f32).into() };
        Self {
            normal: single(normal * scale.sqrt()),
            corner: corners[0],
            uv: uvs[0].map(|x| x as f32),
            across: single(growth(0)),
            down: single(growth(1)),
            material: first_material + mesh.triangles()[triangle].material,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::{Material, Triangle};

    fn mesh(shift: f32) -> Mesh {
        let positions = (0..30).map(|i| [i as f32, (i * i % 7) as f32 + shift, (i % 3) as f32]).collect();
        let uvs = (0..30).map(|i| [0.1 * i as f32, (i % 5) as f32]).collect();
        let triangle = |i| Triangle { corners: [i, i + 1, i + 2], material: i % 2 };
        let material = |name: &str| Material { name: name.into(), color: [255; 3], texture: None };
        Mesh::new(positions, uvs, (0..28).map(triangle).collect(), vec![material("a"), material("b")])
            .unwrap()
    }

    #[test]
    fn every_triangle_is_in_one_block_with_its_own_surface() {
        let meshes = [mesh(0.0), mesh(20.0)];
        let triangles = Triangles::new(&meshes);
        let mut sources: Vec<_> = (0..triangles.len()).map(|i| triangles.source(i)).collect();
        for leaf in 0..triangles.bvh().leaf_count() {
            let (first, end) = triangles.bvh().leaf(leaf);
            for i in first..end {
                let corner = |c: usize| [0, 1, 2].map(|k| triangles.block(leaf).corners[c][k][i - first]);
                let (m, t) = triangles.source(i);
                assert_eq!([corner(0), corner(1), corner(2)], meshes[m].corners(t));
            }
        }
        sources.sort_unstable();
        let expected: Vec<_> = (0..2).flat_map(|m| (0..28).map(move |t| (m, t))).collect();
        assert_eq!(sources, expected);
    }

    #[test]
    fn texture_coordinates_of_the_corners_are_found_again() {
        let triangles = Triangles::new(&[mesh(0.0), mesh(20.0)]);
        let mesh = mesh(20.0);
        for i in 0..triangles.len() {
            let surface = triangles.surface(i);
            let (m, t) = triangles.source(i);
            assert_eq!(surface.material, (2 * m + t % 2) as u32);
            if m == 0 {
                continue;
            }
            for (corner, index) in mesh.corners(t).iter().zip(mesh.triangles()[t].corners) {
                let out = [0, 1, 2].map(|k| corner[k] - surface.corner[k]);
                let dot = |a: &[f32; 3]| a.iter().zip(out).map(|(a, b)| a * b).sum::<f32>();
                let uv = mesh.uvs()[index as usize];
                assert!((surface.uv[0] + dot(&surface.across) - uv[0]).abs() < 1e-4);
                assert!((surface.uv[1] + dot(&surface.down) - uv[1]).abs() < 1e-4);
                assert!(dot(&surface.normal).abs() < 1e-5);
            }
        }
    }
}
