//! The static scene: solids, what a ray meets, what a robot touches, and its true map.

mod aabb;
mod band;
mod bvh;
mod contact;
mod grid;
mod lights;
mod mesh;
mod mover;
mod outline;
mod outline_index;
mod ray;
mod region;
mod shape;
mod stage;

use crate::paint::{Finish, Paintings};
pub(crate) use aabb::Aabb;
pub(crate) use bvh::Bvh;
pub use band::HeightBand;
pub use contact::Obstacles;
pub use lights::{Lamp, Lights};
pub use mesh::{Material, Mesh, Triangle};
pub use mover::Mover;
use outline::Outline;
pub use ray::Hit;
pub use shape::{Cuboid, Cylinder, Shape};
pub use stage::Stage;
use std::sync::OnceLock;
use trundle_core::{Invalid, Vector3};

/// A shape and how its faces look.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// Where it is.
    pub shape: Shape,
    /// What is painted on it.
    pub finish: Finish,
}

/// A static scene: frame `world`, z up, the floor's top at z = 0, metres.
///
/// Textures are drawn from `seed` when first looked at; geometry alone costs nothing of them.
#[derive(Debug)]
pub struct World {
    seed: u64,
    solids: Vec<Solid>,
    meshes: Vec<Mesh>,
    outlines: Vec<Outline>,
    boxes: Vec<Aabb>,
    bounds: Aabb,
    bvh: Bvh,
    paintings: OnceLock<Paintings>,
}

impl World {
    /// A world of `solids`, its textures drawn from `seed`.
    ///
    /// # Errors
    /// When there is no solid, or a solid has a number that is not finite or a size that is not positive.
    pub fn new(solids: Vec<Solid>, seed: u64) -> Result<Self, Invalid> {
        Self::with_meshes(solids, Vec::new(), seed)
    }

    /// A world of `solids` and `meshes`, the textures of the solids drawn from `seed`.
    ///
    /// # Errors
    /// When there is neither solid nor mesh, or a solid has a number that is not finite or a size that is not positive.
    pub fn with_meshes(solids: Vec<Solid>, meshes: Vec<Mesh>, seed: u64) -> Result<Self, Invalid> {
        for (i, solid) in solids.iter().enumerate() {
            solid.shape.check(i)?;
        }
        let boxes: Vec<Aabb> = solids.iter().map(|solid| solid.shape.aabb()).collect();
        let all = boxes.iter().copied().chain(meshes.iter().map(around_mesh));
        let Some(bounds) = all.reduce(Aabb::union) else {
            return Err(Invalid::new("solids and meshes of the world", 0, "", "1 or more"));
        };
        let outlines = solids.iter().map(|solid| solid.shape.outline()).collect();
        let bvh = Bvh::new(&boxes);
        Ok(Self { seed, solids, meshes, outlines, boxes, bounds, bvh, paintings: OnceLock::new() })
    }

    /// What stands in it.
    pub fn solids(&self) -> &[Solid] {
        &self.solids
    }

    /// What stands in it made of triangles.
    pub fn meshes(&self) -> &[Mesh] {
        &self.meshes
    }

    /// The lowest and the highest corner of all solids and meshes, m.
    pub fn bounds(&self) -> (Vector3, Vector3) {
        (self.bounds.min, self.bounds.max)
    }

    /// The boxes around the solids.
    pub(crate) fn boxes(&self) -> &[Aabb] {
        &self.boxes
    }

    pub(crate) fn bvh(&self) -> &Bvh {
        &self.bvh
    }

    /// Draws the textures now rather than at the first look: some tenths of a second.
    pub fn paint(&self) {
        self.paintings();
    }

    /// The painted faces of every solid, drawn at the first call.
    pub(crate) fn paintings(&self) -> &Paintings {
        self.paintings.get_or_init(|| Paintings::new(&self.solids, self.seed))
    }
}

fn around_mesh(mesh: &Mesh) -> Aabb {
    let corners = mesh.triangles().iter().flat_map(|triangle| triangle.corners);
    let points = corners.map(|corner| Vector3::from(mesh.positions()[corner as usize].map(f64::from)));
    let boxes = points.map(|point| Aabb { min: point, max: point });
    boxes.reduce(Aabb::union).expect("invariant: a mesh has a triangle")
}
