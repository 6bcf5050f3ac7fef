//! The static scene: solids, ray casting, contact, and the true map.

mod aabb;
mod band;
mod bvh;
mod contact;
mod form;
mod grid;
mod intersect_solid;
mod intersect_triangle;
mod lights;
mod mesh;
mod mover;
mod outline;
mod outline_index;
mod probe;
mod ray;
mod region;
mod scene_snapshot;
pub(crate) mod shape;
mod triangles;

use crate::materials::{Paintings, Texture};
pub use crate::solid::Solid;
pub(crate) use aabb::Aabb;
pub use band::HeightBand;
pub(crate) use bvh::{Bvh, Node, Probe, WIDTH};
pub use contact::Obstacles;
pub(crate) use form::{Form, Kind};
pub use lights::{Lamp, Lights};
pub use mesh::{Material, Mesh, Triangle};
pub use mover::Mover;
use outline::Outline;
pub use ray::{Hit, Target};
use rayon::prelude::*;
pub use scene_snapshot::SceneSnapshot;
pub use shape::{Cuboid, Cylinder, Shape};
use std::sync::OnceLock;
pub(crate) use triangles::{Block, TRIANGLES_PER_BLOCK, Triangles};
use trundle_core::{Invalid, Vector3};

/// A static scene: frame `world`, z up, the floor's top at z = 0, metres.
///
/// Textures are drawn from `seed` at their first use; geometry alone draws none.
#[derive(Debug)]
pub struct World {
    seed: u64,
    solids: Vec<Solid>,
    meshes: Vec<Mesh>,
    outlines: Vec<Outline>,
    bounds: Aabb,
    /// Over the solids, one a leaf.
    bvh: Bvh,
    forms: Vec<Form>,
    triangles: Triangles,
    paintings: OnceLock<Paintings>,
    pictures: OnceLock<Vec<Texture>>,
}

impl World {
    /// A world of `solids`, its textures drawn from `seed`.
    ///
    /// # Errors
    /// When no solid is given, or a solid has a number that is not finite or a size that is not positive.
    pub fn new(solids: Vec<Solid>, seed: u64) -> Result<Self, Invalid> {
        Self::with_meshes(solids, Vec::new(), seed)
    }

    /// A world of `solids` and `meshes`, the textures of the solids drawn from `seed`.
    ///
    /// # Errors
    /// When neither solid nor mesh is given, or a solid has a number that is not finite or a size that is not positive.
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
        let forms = solids.iter().map(|solid| Form::new(&solid.shape)).collect();
        let (bvh, triangles) = (Bvh::new(&boxes, 1), Triangles::new(&meshes));
        let (paintings, pictures) = (OnceLock::new(), OnceLock::new());
        Ok(Self { seed, solids, meshes, outlines, bounds, bvh, forms, triangles, paintings, pictures })
    }

    /// The same world with one more solid; the appearance of the others does not change.
    pub(crate) fn with_solid(self, solid: Solid) -> Result<Self, Invalid> {
        let solids = self.solids.into_iter().chain([solid]).collect();
        Self::with_meshes(solids, self.meshes, self.seed)
    }

    /// The solids.
    pub fn solids(&self) -> &[Solid] {
        &self.solids
    }

    /// The triangle meshes.
    pub fn meshes(&self) -> &[Mesh] {
        &self.meshes
    }

    /// The lowest and the highest corner of all solids and meshes, m.
    pub fn bounds(&self) -> (Vector3, Vector3) {
        (self.bounds.min, self.bounds.max)
    }

    /// The hierarchy over the solids, one a leaf.
    pub(crate) fn bvh(&self) -> &Bvh {
        &self.bvh
    }

    /// The solids, as the camera meets them.
    pub(crate) fn forms(&self) -> &[Form] {
        &self.forms
    }

    /// The triangles of the meshes, as rays meet them.
    pub(crate) fn triangles(&self) -> &Triangles {
        &self.triangles
    }

    /// Draws the textures immediately instead of at their first use: some tenths of a second.
    pub fn prepare_textures(&self) {
        self.paintings();
        self.pictures();
    }

    /// The painted faces of every solid, drawn at the first call.
    pub(crate) fn paintings(&self) -> &Paintings {
        self.paintings.get_or_init(|| Paintings::new(&self.solids, self.seed))
    }

    /// The textures of the materials of all meshes, mesh after mesh, made at the first call.
    pub(crate) fn pictures(&self) -> &[Texture] {
        self.pictures.get_or_init(|| {
            let materials: Vec<&Material> = self.meshes.iter().flat_map(Mesh::materials).collect();
            materials.par_iter().map(|m| Texture::of_picture(m.color, m.texture.as_ref())).collect()
        })
    }
}

fn around_mesh(mesh: &Mesh) -> Aabb {
    let corners = mesh.triangles().iter().flat_map(|triangle| triangle.corners);
    let points = corners.map(|corner| Vector3::from(mesh.positions()[corner as usize].map(f64::from)));
    let boxes = points.map(|point| Aabb { min: point, max: point });
    boxes.reduce(Aabb::union).expect("invariant: a mesh has a triangle")
}
