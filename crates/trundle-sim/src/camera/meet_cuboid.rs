use super::rays::{Linear, Rays};
use super::tile::{COLUMNS, ROWS, Tile};

/// Keeps the faces of a box where they are nearest; `origin` is the camera's centre in the box's frame, `rays` are in the frame
/// in which `axes` are the box's. Of the id the last two bits become the axis of the face.
///
/// Slabs (Kay and Kajiya 1986) in inverse depth: on the plane of each face it is an affine function of the pixel. The box is
/// entered through the last of the planes that face the camera, the least inverse depth, if that is before the first of the others.
#[inline(always)]
pub(super) fn meet_cuboid(
    rays: &Rays,
    axes: [[f64; 3]; 3],
    origin: [f64; 3],
    half: [f64; 3],
    id: u32,
    tile: &mut Tile,
) {
    let mut near = [Linear::constant(f32::INFINITY); 3];
    let mut far = [Linear::constant(f32::NEG_INFINITY); 6];
    for k in 0..3 {
        let along = rays.along(axes[k].map(|x| x as f32));
        let (high, low) =
            (along.times(inverse(half[k] - origin[k])), along.times(inverse(-half[k] - origin[k])));
        (far[k], far[k + 3]) = (high, low);
        if origin[k] > half[k] {
            (near[k], far[k]) = (high, low);
        } else if origin[k] < -half[k] {
            (near[k], far[k + 3]) = (low, high);
        }
    }
    for row in 0..ROWS {
        let (near, far) = (near.map(|n| n.row(row)), far.map(|f| f.row(row)));
        for i in 0..COLUMNS {
            let (mut entry, mut axis) = (near[0][i], 0);
            for k in 1..3 {
                axis = if near[k][i] < entry { k as u32 } else { axis };
                entry = if near[k][i] < entry { near[k][i] } else { entry };
            }
            let exit =
                far.iter().fold(f32::NEG_INFINITY, |exit, far| if far[i] > exit { far[i] } else { exit });
            // From inside there is no entry: infinite.
            tile.keep(row, i, entry, (entry >= exit) & (entry < f32::INFINITY), id + axis);
        }
    }
}

/// 1 / x, finite.
fn inverse(x: f64) -> f32 {
    (1.0 / x.abs().max(1e-9).copysign(x)) as f32
}
