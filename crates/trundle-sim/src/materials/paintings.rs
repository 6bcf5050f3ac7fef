//! Textures of all faces of a world's solids.

use super::bake::{bake_solid, texels_of_solid};
use super::finish::Finish;
use super::texture::Texture;
use crate::solid::Solid;
use crate::world::shape::Shape;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::ops::Index;

/// Texels of a world, about 5.4 bytes each with their mip levels; beyond, all texels get coarser. Source: ours.
const MAX_TEXELS: usize = 40_000_000;

/// The painted faces of every solid of a world. Equal solids (equal sizes, equal finishes with a seed) share one set, so repeated furniture
/// is free.
#[derive(Debug)]
pub(crate) struct Paintings {
    distinct: Vec<Vec<Texture>>,
    /// Index of each solid's set.
    of_solid: Vec<u32>,
}

impl Paintings {
    /// Paints `solids`; chance comes from `world_seed`.
    pub(crate) fn new(solids: &[Solid], world_seed: u64) -> Self {
        let (firsts, of_solid) = share(solids);
        let texels: usize = firsts.iter().map(|&first| texels_of_solid(&solids[first])).sum();
        let coarse = coarseness(texels);
        let bake = |&first: &usize| bake_solid(&solids[first], world_seed, first, coarse);
        Self { distinct: firsts.par_iter().map(bake).collect(), of_solid }
    }

    /// The faces of every solid, in the order of the solids.
    #[cfg(test)]
    fn iter(&self) -> impl ExactSizeIterator<Item = &Vec<Texture>> {
        self.of_solid.iter().map(|&which| &self.distinct[which as usize])
    }
}

impl Index<usize> for Paintings {
    type Output = Vec<Texture>;

    fn index(&self, solid: usize) -> &Vec<Texture> {
        &self.distinct[self.of_solid[solid] as usize]
    }
}

/// Factor on the width of texels that limits their number to [`MAX_TEXELS`].
fn coarseness(texels: usize) -> f64 {
    (texels as f64 / MAX_TEXELS as f64).sqrt().max(1.0)
}

/// Exact seed and size: the key by which appearances are compared.
type LookKey = (u64, [u64; 3]);

/// The first solid of every appearance, and the appearance of each solid.
fn share(solids: &[Solid]) -> (Vec<usize>, Vec<u32>) {
    let mut firsts = Vec::new();
    let mut of_solid = Vec::with_capacity(solids.len());
    let mut looks: BTreeMap<LookKey, Vec<(&Finish, u32)>> = BTreeMap::new();
    for (i, solid) in solids.iter().enumerate() {
        let fresh = firsts.len() as u32;
        let which = match solid.finish.seed {
            None => fresh,
            Some(seed) => {
                let alike = looks.entry((seed, size_bits(&solid.shape))).or_default();
                let known = alike.iter().find(|(finish, _)| **finish == solid.finish);
                known.map_or(fresh, |(_, which)| *which)
            }
        };
        if which == fresh {
            firsts.push(i);
            if let Some(seed) = solid.finish.seed {
                let alike = looks.entry((seed, size_bits(&solid.shape))).or_default();
                alike.push((&solid.finish, fresh));
            }
        }
        of_solid.push(which);
    }
    (firsts, of_solid)
}

/// A shape's size, exactly; a cylinder's has no third number.
fn size_bits(shape: &Shape) -> [u64; 3] {
    match shape {
        Shape::Cuboid(c) => [c.size.x.to_bits(), c.size.y.to_bits(), c.size.z.to_bits()],
        Shape::Cylinder(c) => [c.radius.to_bits(), c.height.to_bits(), 0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::bake::texels_of_face;
    use crate::materials::kind::Paint;
    use crate::world::shape::Cuboid;
    use trundle_core::Vector3;

    #[test]
    fn only_equal_sizes_finishes_and_seeds_share_a_painting() {
        let solid = |x: f64, side: f64, paint: Paint, seed: Option<u64>| {
            let size = Vector3::from_element(side);
            let shape = Shape::Cuboid(Cuboid { center: Vector3::new(x, 0.0, 0.5), size, yaw: x });
            Solid { shape, finish: Finish { seed, ..Finish::all(paint) } }
        };
        let veneer = Paint::Veneer { color: [150, 110, 70] };
        let solids = [
            solid(0.0, 0.2, veneer, Some(3)),
            solid(1.0, 0.2, veneer, Some(3)),
            solid(2.0, 0.2, veneer, Some(4)),
            solid(3.0, 0.3, veneer, Some(3)),
            solid(4.0, 0.2, Paint::Cardboard, Some(3)),
            solid(5.0, 0.2, veneer, None),
            solid(6.0, 0.2, veneer, None),
        ];
        let paintings = Paintings::new(&solids, 1);
        assert_eq!(paintings.of_solid, [0, 0, 1, 2, 3, 4, 5]);
        assert_eq!(paintings.iter().len(), 7);
        assert_eq!(paintings[0], paintings[1]);
        for other in 2..7 {
            assert_ne!(paintings[0], paintings[other], "{other}");
        }
        assert_ne!(paintings[5], paintings[6]);
        assert_ne!(paintings[0], Paintings::new(&solids, 2)[0], "another world");
    }

    #[test]
    fn worlds_of_too_many_texels_get_coarser_ones() {
        let texels = |coarse| {
            let (columns, rows) = texels_of_face(Paint::Bricks, (8.0, 4.0), coarse);
            columns * rows
        };
        assert_eq!(coarseness(1_000_000), 1.0);
        // 100 walls, 8 x 4 m each, at 5 mm would be 128 million.
        let coarse = coarseness(100 * texels(1.0));
        let all = 100 * texels(coarse);
        assert!((0.9..1.1).contains(&(all as f64 / MAX_TEXELS as f64)), "{all} texels");
    }
}
