use super::rays::{Linear, Rays};
use super::tile::{COLUMNS, ROWS, Tile};
use crate::world::{BLOCK, Block};

/// Keeps the triangles of a block where they are nearest; `apex` is the camera's centre in their frame, ids are `id` and what
/// follows. `floor` is the least inverse depth in the tile. Whether anything may have changed.
///
/// Triangle scan conversion in homogeneous coordinates (Olano and Greer 1997): with corners a, b, c seen from the camera, the ray
/// d is on the inner side of edge ab where d . (a x b) has the sign of the volume a . (b x c), and the inverse depth is d . n / volume,
/// n = a x b + b x c + c x a. All are affine functions of the pixel; nothing is divided or clipped. The triangles at an edge have
/// exactly opposite functions of it: no pixel between them is lost.
#[inline(always)]
pub(super) fn meet_block(
    rays: &Rays,
    apex: [f64; 3],
    block: &Block,
    id: u32,
    floor: f32,
    tile: &mut Tile,
) -> bool {
    let setups = Setups::new(rays, apex, block, floor);
    let mut is_changed = false;
    for lane in 0..BLOCK {
        if setups.is_seen[lane] {
            is_changed = true;
            meet_one(setups.functions.map(|f| f.lane(lane)), id + lane as u32, tile);
        }
    }
    is_changed
}

#[inline(always)]
fn meet_one([a, b, c, inverse_depth]: [Linear; 4], id: u32, tile: &mut Tile) {
    let mut is_empty = [false; ROWS];
    for (row, is_empty) in is_empty.iter_mut().enumerate() {
        *is_empty = (a.most_in_row(row) < 0.0) | (b.most_in_row(row) < 0.0) | (c.most_in_row(row) < 0.0);
    }
    for row in (0..ROWS).filter(|&row| !is_empty[row]) {
        let (a, b, c, w) = (a.row(row), b.row(row), c.row(row), inverse_depth.row(row));
        for i in 0..COLUMNS {
            tile.keep(row, i, w[i], (a[i] >= 0.0) & (b[i] >= 0.0) & (c[i] >= 0.0), id);
        }
    }
}

/// [`Linear`] functions, one a triangle.
#[derive(Clone, Copy)]
struct Functions {
    start: [f32; BLOCK],
    right: [f32; BLOCK],
    down: [f32; BLOCK],
}

impl Functions {
    const ZERO: Self = Self { start: [0.0; BLOCK], right: [0.0; BLOCK], down: [0.0; BLOCK] };

    #[inline(always)]
    fn lane(&self, lane: usize) -> Linear {
        Linear { start: self.start[lane], right: self.right[lane], down: self.down[lane] }
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, function: Linear) {
        self.start[lane] = function.start;
        self.right[lane] = function.right;
        self.down[lane] = function.down;
    }
}

/// Of each triangle the three edges' functions, positive inside, and the inverse depth.
struct Setups {
    functions: [Functions; 4],
    is_seen: [bool; BLOCK],
}

impl Setups {
    #[inline(always)]
    fn new(rays: &Rays, apex: [f64; 3], block: &Block, floor: f32) -> Self {
        let mut setups = Self { functions: [Functions::ZERO; 4], is_seen: [false; BLOCK] };
        for lane in 0..BLOCK {
            let corner = |i: usize| [0, 1, 2].map(|k| f64::from(block.corners[i][k][lane]) - apex[k]);
            let (a, b, c) = (corner(0), corner(1), corner(2));
            let normals = [cross(b, c), cross(c, a), cross(a, b)];
            let volume = a[0] * normals[0][0] + a[1] * normals[0][1] + a[2] * normals[0][2];
            let sign = if volume < 0.0 { -1.0 } else { 1.0 };
            let plane = [0, 1, 2].map(|k| (normals[0][k] + normals[1][k] + normals[2][k]) / volume);
            let mut is_seen = volume != 0.0;
            for (i, normal) in normals.iter().enumerate() {
                let edge = rays.along([0, 1, 2].map(|k| (sign * normal[k]) as f32));
                is_seen &= edge.most() >= 0.0;
                setups.functions[i].set(lane, edge);
            }
            let inverse_depth = rays.along(plane.map(|x| x as f32));
            is_seen &= inverse_depth.most() > floor;
            setups.functions[3].set(lane, inverse_depth);
            setups.is_seen[lane] = is_seen;
        }
        setups
    }
}

#[inline(always)]
fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
