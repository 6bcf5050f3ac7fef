//! Baking: the textures of a solid's faces, drawn from its paints.

use super::color::{self, Rgb, packed};
use super::kind::Paint;
use super::noise::Fractal;
use super::poster::{self, Poster};
use super::texture::Texture;
use super::{furnishings, industry, joinery, surfaces};
use crate::rng::hash;
use crate::solid::Solid;
use crate::world::shape::Shape;
use rayon::prelude::*;

/// Sides of textures are multiples of this number, so five levels halve exactly. Source: ours.
const TEXEL_MULTIPLE: usize = 16;

/// Grain of every size, which gives corners at 1 m as well as at 6 m.
const GRAIN: Fractal = Fractal { wavelength: 0.64, octaves: 7, gain: 0.82 };

/// Maximum number of texels of one face; larger faces get coarser texels. Source: ours.
const MAX_TEXELS: f64 = 4e6;

/// Faces of a solid: which of [`Finish::faces`], width and height, m.
fn faces(shape: &Shape) -> Vec<(usize, f64, f64)> {
    match shape {
        Shape::Cuboid(c) => {
            let (x, y, z) = (c.size.x, c.size.y, c.size.z);
            vec![(0, y, z), (1, y, z), (2, x, z), (3, x, z), (4, x, y), (5, x, y)]
        }
        Shape::Cylinder(c) => {
            let d = 2.0 * c.radius;
            vec![(0, std::f64::consts::PI * d, c.height), (4, d, d), (5, d, d)]
        }
    }
}

/// The painted faces of a solid, six for a box, (side, top, bottom) for a cylinder, with texels `coarse` times as wide as in the paints.
pub(super) fn bake_solid(solid: &Solid, world_seed: u64, index: usize, coarse: f64) -> Vec<Texture> {
    // Given seeds must not collide with those derived from indices.
    let (world_seed, nth) = match solid.finish.seed {
        Some(seed) => (hash(world_seed, u64::MAX), hash(seed, 0)),
        None => (world_seed, index as u64),
    };
    let bake = |(face, width, height): (usize, f64, f64)| {
        let seed = hash(world_seed, nth.wrapping_mul(8).wrapping_add(face as u64)) as u32;
        bake_face(solid.finish.faces[face], seed, (width, height), coarse)
    };
    faces(&solid.shape).into_iter().map(bake).collect()
}

/// Texels that the faces of a solid need.
pub(super) fn texels_of_solid(solid: &Solid) -> usize {
    let texels = |(face, width, height): (usize, f64, f64)| {
        let (columns, rows) = texels_of_face(solid.finish.faces[face], (width, height), 1.0);
        columns * rows
    };
    faces(&solid.shape).into_iter().map(texels).sum()
}

/// Columns and rows of a face's texture.
pub(super) fn texels_of_face(paint: Paint, (width, height): (f64, f64), coarse: f64) -> (usize, usize) {
    if let Paint::Flat { .. } = paint {
        return (1, 1);
    }
    let texel = (texel_of(paint) * coarse).max((width * height / MAX_TEXELS).sqrt());
    let texels =
        |length: f64| ((length / texel / TEXEL_MULTIPLE as f64).ceil() as usize).max(1) * TEXEL_MULTIPLE;
    (texels(width), texels(height))
}

fn bake_face(paint: Paint, seed: u32, (width, height): (f64, f64), coarse: f64) -> Texture {
    let size = (width as f32, height as f32);
    let (columns, rows) = texels_of_face(paint, (width, height), coarse);
    if let Paint::Flat { color } = paint {
        return Texture::new(columns, rows, vec![packed(color::rgb(color))], size);
    }
    let prints = prints_on(paint, seed, size);
    let (dx, dy) = (size.0 / columns as f32, size.1 / rows as f32);
    let mut texels = vec![0; columns * rows];
    texels.par_chunks_mut(columns).enumerate().for_each_init(
        || (vec![0.0; columns], Vec::<Poster>::new()),
        |(grain, across), (row, texels)| {
            let y = (row as f32 + 0.5) * dy;
            GRAIN.fill_row(seed, y, dx, grain);
            across.clear();
            across.extend(prints.iter().copied().filter(|poster| poster.crosses(y)));
            for (column, texel) in texels.iter_mut().enumerate() {
                let x = (column as f32 + 0.5) * dx;
                let print = across.iter().find_map(|poster| poster.at(x, y));
                *texel = packed(print.unwrap_or_else(|| color_at(paint, seed, size, x, y, grain[column])));
            }
        },
    );
    Texture::new(columns, rows, texels, size)
}

/// Side of a texel, m: walls are seen from farther away than furniture.
fn texel_of(paint: Paint) -> f64 {
    match paint {
        Paint::Ceiling => 0.010,
        Paint::Plaster { .. }
        | Paint::Wallpaper { .. }
        | Paint::Bricks
        | Paint::Boards { .. }
        | Paint::Tiles { .. } => 0.005,
        Paint::Carpet { .. } | Paint::Goods { .. } => 0.006,
        Paint::Plain { .. } => 0.008,
        Paint::Concrete { .. } | Paint::Corrugated { .. } | Paint::Marking { .. } => 0.010,
        Paint::Print | Paint::Sign { .. } | Paint::Screen => 0.003,
        _ => 0.004,
    }
}

fn prints_on(paint: Paint, seed: u32, size: (f32, f32)) -> Vec<Poster> {
    match paint {
        Paint::Plaster { prints, .. } => poster::spread(seed, size, prints),
        Paint::Wallpaper { .. } => poster::spread(seed, size, 0.25),
        Paint::Print => vec![Poster { left: 0.0, top: 0.0, width: size.0, height: size.1, seed }],
        _ => Vec::new(),
    }
}

fn color_at(paint: Paint, seed: u32, size: (f32, f32), x: f32, y: f32, grain: f32) -> Rgb {
    match paint {
        Paint::Flat { color } => color::rgb(color),
        Paint::Plaster { color, .. } => surfaces::plaster(seed, color, x, y, grain),
        Paint::Wallpaper { color } => surfaces::wallpaper(seed, color, x, y, grain),
        Paint::Bricks => surfaces::bricks(seed, x, y, grain),
        Paint::Boards { color } => surfaces::boards(seed, color, x, y, grain),
        Paint::Tiles { color } => surfaces::tiles(seed, color, x, y, grain),
        Paint::Ceiling => surfaces::ceiling(seed, x, y, grain),
        Paint::Books => furnishings::books(seed, x, y, grain),
        Paint::Cardboard => furnishings::cardboard(seed, size, x, y, grain),
        Paint::Fabric { color } => furnishings::fabric(seed, color, x, y, grain),
        Paint::Veneer { color } => furnishings::veneer(seed, color, size, x, y, grain),
        Paint::Metal { color } => furnishings::metal(seed, color, x, y, grain),
        Paint::Plain { color } => industry::plain(color, grain),
        Paint::Carpet { color } => industry::carpet(seed, color, x, y, grain),
        Paint::Concrete { color } => industry::concrete(seed, color, x, y, grain),
        Paint::Corrugated { color } => industry::corrugated(seed, color, x, y, grain),
        Paint::Marking { color } => industry::marking(seed, color, x, y, grain),
        Paint::Slotted { color } => industry::slotted(seed, color, size, x, y, grain),
        Paint::Goods { color } => industry::goods(seed, color, x, y, grain),
        Paint::Door { color } => joinery::door(seed, color, size, x, y, grain),
        Paint::Window => joinery::window(seed, size, x, y, grain),
        // The print covers the whole face.
        Paint::Print => [0.0; 3],
        Paint::Sign { color } => joinery::sign(seed, color, size, x, y),
        Paint::Fronts { color } => joinery::fronts(seed, color, size, x, y, grain),
        Paint::Screen => joinery::screen(seed, size, x, y),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_face_has_its_own_painting_and_the_same_one_every_time() {
        let paint = Paint::Veneer { color: [150, 110, 70] };
        let face = |seed| bake_face(paint, seed, (0.5, 0.4), 1.0);
        assert_eq!(face(1), face(1));
        assert_ne!(face(1), face(2));
    }
}
