//! From signed distances to triangles: one vertex in each cell that the surface crosses, one quadrilateral on each edge it crosses.

use crate::surface_map::SurfaceMap;
use crate::surface_mesh::SurfaceMesh;
use crate::voxel_block::{BLOCK_SIDE, BlockKey, VoxelBlock, voxel_index};
use std::collections::HashMap;

/// Corners of a cell, as steps from its first corner.
const CORNERS: [[usize; 3]; 8] =
    [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]];
/// Edges of a cell, as pairs of corners.
const EDGES: [(usize, usize); 12] =
    [(0, 1), (2, 3), (4, 5), (6, 7), (0, 2), (1, 3), (4, 6), (5, 7), (0, 4), (1, 5), (2, 6), (3, 7)];
/// Side of the samples of a block: its voxels and the first ones of the next blocks.
const SAMPLES_SIDE: usize = BLOCK_SIDE + 1;

/// Cell of the whole map.
type CellKey = [i32; 3];

/// Distances of a block and the first voxels of the next blocks; NaN where nothing is known.
struct Samples {
    distance: [f32; SAMPLES_SIDE * SAMPLES_SIDE * SAMPLES_SIDE],
}

impl Samples {
    fn index([x, y, z]: [usize; 3]) -> usize {
        (z * SAMPLES_SIDE + y) * SAMPLES_SIDE + x
    }

    fn of(map: &SurfaceMap, key: BlockKey) -> Self {
        let next = |offset: [usize; 3]| map.block(std::array::from_fn(|i| key[i] + offset[i] as i32));
        let blocks: [Option<&VoxelBlock>; 8] = CORNERS.map(next);
        let mut distance = [f32::NAN; SAMPLES_SIDE * SAMPLES_SIDE * SAMPLES_SIDE];
        for z in 0..SAMPLES_SIDE {
            for y in 0..SAMPLES_SIDE {
                for x in 0..SAMPLES_SIDE {
                    let at = [x, y, z];
                    let over = |i: usize| at[i] / BLOCK_SIDE;
                    let Some(block) = blocks[over(0) + 2 * over(1) + 4 * over(2)] else { continue };
                    let voxel = voxel_index(x % BLOCK_SIDE, y % BLOCK_SIDE, z % BLOCK_SIDE);
                    if block.weight(voxel) >= map.config().min_weight {
                        distance[Self::index(at)] = block.distance(voxel);
                    }
                }
            }
        }
        Self { distance }
    }

    fn at(&self, at: [usize; 3]) -> f32 {
        self.distance[Self::index(at)]
    }

    /// The axis, and whether the edge from a voxel along it leads out of the surface; `None` if the edge crosses no surface.
    fn crossing(&self, voxel: [usize; 3], axis: usize) -> Option<(usize, bool)> {
        let mut end = voxel;
        end[axis] += 1;
        let (from, to) = (self.at(voxel), self.at(end));
        let is_crossed = from.is_finite() && to.is_finite() && (from < 0.0) != (to < 0.0);
        is_crossed.then_some((axis, from < 0.0))
    }

    /// Distances at the corners of a cell; `None` if one is unknown, or no edge crosses the surface.
    fn crossed_cell(&self, cell: [usize; 3]) -> Option<[f32; 8]> {
        let corners = CORNERS.map(|step| self.at(std::array::from_fn(|i| cell[i] + step[i])));
        let inside = corners.iter().filter(|distance| **distance < 0.0).count();
        (corners.iter().all(|distance| distance.is_finite()) && inside > 0 && inside < 8).then_some(corners)
    }
}

/// An edge between two voxels that crosses the surface.
struct Crossing {
    from: CellKey,
    axis: usize,
    /// Whether the edge leads out of the surface.
    is_outward: bool,
}

/// The surface of a map as triangles with colours, in the order of its blocks. Points with less weight than `min_weight` are left out.
#[must_use]
pub fn surface_mesh(map: &SurfaceMap) -> SurfaceMesh {
    let mut mesh = SurfaceMesh::default();
    let mut vertex_of: HashMap<CellKey, u32> = HashMap::new();
    let mut crossings = Vec::new();
    for (&key, block) in map.keys.iter().zip(&map.blocks) {
        let samples = Samples::of(map, key);
        for cell in cells() {
            if let Some(corners) = samples.crossed_cell(cell) {
                vertex_of.insert(global(key, cell), mesh.vertices.len() as u32);
                push_vertex(&mut mesh, map.config().voxel, global(key, cell), &corners, block, cell);
            }
            let crossed = (0..3).filter_map(|axis| samples.crossing(cell, axis));
            crossings.extend(crossed.map(|(axis, is_outward)| Crossing {
                from: global(key, cell),
                axis,
                is_outward,
            }));
        }
    }
    // A face needs the vertices of four cells, which may be in other blocks.
    crossings.iter().for_each(|crossing| push_faces(&mut mesh, &vertex_of, crossing));
    mesh
}

fn cells() -> impl Iterator<Item = [usize; 3]> {
    let side = 0..BLOCK_SIDE;
    side.clone().flat_map(move |z| (0..BLOCK_SIDE).flat_map(move |y| (0..BLOCK_SIDE).map(move |x| [x, y, z])))
}

fn global(key: BlockKey, cell: [usize; 3]) -> CellKey {
    std::array::from_fn(|i| key[i] * BLOCK_SIDE as i32 + cell[i] as i32)
}

/// The vertex of a cell: the mean of the crossings on its edges. Its normal is the gradient of the distances.
fn push_vertex(
    mesh: &mut SurfaceMesh,
    voxel: f64,
    cell: CellKey,
    corners: &[f32; 8],
    block: &VoxelBlock,
    in_block: [usize; 3],
) {
    let (mut sum, mut count) = ([0.0_f32; 3], 0.0_f32);
    for (a, b) in EDGES {
        if (corners[a] < 0.0) != (corners[b] < 0.0) {
            let part = corners[a] / (corners[a] - corners[b]);
            for axis in 0..3 {
                let (from, to) = (CORNERS[a][axis] as f32, CORNERS[b][axis] as f32);
                sum[axis] += from + (to - from) * part;
            }
            count += 1.0;
        }
    }
    let position = |axis: usize| f64::from(sum[axis] / count + 0.5) + f64::from(cell[axis]);
    mesh.vertices.push(std::array::from_fn(|axis| (position(axis) * voxel) as f32));
    mesh.normals.push(gradient(corners));
    mesh.colors.push(block.color(voxel_index(in_block[0], in_block[1], in_block[2])));
}

/// Unit direction of increasing distance; up if the distances have none.
fn gradient(corners: &[f32; 8]) -> [f32; 3] {
    let slope = |axis: usize| -> f32 {
        let sign = |corner: usize| CORNERS[corner][axis] as f32 * 2.0 - 1.0;
        (0..8).map(|corner| corners[corner] * sign(corner)).sum()
    };
    let direction = nalgebra::Vector3::new(slope(0), slope(1), slope(2));
    direction.try_normalize(1e-9).unwrap_or_else(nalgebra::Vector3::z).into()
}

/// The two triangles on an edge that crosses the surface, if the four cells around it are known.
fn push_faces(mesh: &mut SurfaceMesh, vertex_of: &HashMap<CellKey, u32>, crossing: &Crossing) {
    let (b, c) = ((crossing.axis + 1) % 3, (crossing.axis + 2) % 3);
    let around = [(-1, -1), (0, -1), (0, 0), (-1, 0)].map(|(along_b, along_c)| {
        let mut at = crossing.from;
        at[b] += along_b;
        at[c] += along_c;
        vertex_of.get(&at).copied()
    });
    let [Some(p), Some(q), Some(r), Some(s)] = around else { return };
    let [p, q, r, s] = if crossing.is_outward { [p, q, r, s] } else { [p, s, r, q] };
    let length = |a: u32, b: u32| {
        let (a, b) = (mesh.vertices[a as usize], mesh.vertices[b as usize]);
        (0..3).map(|i| (a[i] - b[i]) * (a[i] - b[i])).sum::<f32>()
    };
    let split = if length(p, r) <= length(q, s) { [[p, q, r], [p, r, s]] } else { [[p, q, s], [q, r, s]] };
    mesh.triangles.extend(split);
}
