//! Assembly of all glTF surfaces into one mesh.

use super::buffers::Buffers;
use super::mesh_materials::{MaterialUse, image_of, materials};
use super::primitive::Surface;
use super::schema::at;
use super::vertex_colors::Painting;
use crate::import::{ImportFault, ImportNote};
use crate::world::{Mesh, Triangle};
use gltf::json::{Index, mesh};
use nalgebra::{Matrix4, Point3};
use trundle_core::Invalid;

/// Farthest coordinate, m: a file beyond it is in another unit or broken. Source: ours.
const MAX_COORDINATE_M: f64 = 1e5;

/// Maximum number of triangles of a file with all its instances. Source: ours.
const MAX_TRIANGLES: usize = 50_000_000;

/// Gathers the surfaces of a file into one mesh.
pub(super) struct Builder<'a> {
    buffers: &'a Buffers<'a>,
    positions: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    triangles: Vec<Triangle>,
    /// The appearances in use, by their index in the mesh.
    material_uses: Vec<MaterialUse>,
    painting: Painting,
    /// Number of surfaces whose vertex colours are ignored because they have a texture.
    hidden: usize,
}

impl<'a> Builder<'a> {
    pub(super) fn new(buffers: &'a Buffers<'a>) -> Self {
        Self {
            buffers,
            positions: Vec::new(),
            uvs: Vec::new(),
            triangles: Vec::new(),
            material_uses: Vec::new(),
            painting: Painting::default(),
            hidden: 0,
        }
    }

    /// Adds a mesh of the file at `world_from_mesh`.
    pub(super) fn add(
        &mut self,
        index: Index<mesh::Mesh>,
        world_from_mesh: &Matrix4<f64>,
    ) -> Result<(), ImportFault> {
        let mesh = at(&self.buffers.root().meshes, index, "meshes")?;
        for primitive in &mesh.primitives {
            let mut surface = Surface::read(self.buffers, primitive)?;
            if surface.colors.is_some() && image_of(self.buffers, primitive.material)?.is_some() {
                self.hidden += 1;
                surface.colors = None;
            }
            if self.triangles.len() + surface.triangles.len() > MAX_TRIANGLES {
                let found = format!("more than {MAX_TRIANGLES}");
                return Err(Invalid::new(
                    "number of triangles",
                    found,
                    "",
                    format!("at most {MAX_TRIANGLES}"),
                )
                .into());
            }
            let is_painted = surface.colors.is_some();
            let material = self.place_of(MaterialUse { material: primitive.material, is_painted });
            let name = || {
                mesh.name.as_ref().map_or(format!("mesh {index}"), |name| format!("mesh {index} ('{name}')"))
            };
            self.add_surface(&surface, world_from_mesh, material, &name)?;
        }
        Ok(())
    }

    fn add_surface(
        &mut self,
        surface: &Surface,
        world_from_mesh: &Matrix4<f64>,
        material: u32,
        name: &dyn Fn() -> String,
    ) -> Result<(), ImportFault> {
        let first = self.positions.len();
        for (i, position) in surface.positions.iter().enumerate() {
            let placed = world_from_mesh.transform_point(&Point3::from(position.map(f64::from)));
            if !placed.iter().all(|x| x.abs() <= MAX_COORDINATE_M) {
                let expected = format!("within {MAX_COORDINATE_M} m of the origin; is the scale right?");
                let value = format!("({}, {}, {})", placed.x, placed.y, placed.z);
                return Err(Invalid::new(format!("position {i} of {}", name()), value, "m", expected).into());
            }
            self.positions.push([placed.x as f32, placed.y as f32, placed.z as f32]);
        }
        self.uvs.extend_from_slice(&surface.uvs);
        let positions = &self.positions;
        let solid = surface.triangles.iter().map(|corners| corners.map(|corner| corner + first as u32));
        let solid = solid.filter(|corners| has_area(corners.map(|corner| positions[corner as usize])));
        let triangles: Vec<Triangle> = solid.map(|corners| Triangle { corners, material }).collect();
        match &surface.colors {
            None => self.triangles.extend(triangles),
            Some(colors) => self.paint(&triangles, first, colors),
        }
        Ok(())
    }

    /// Adds triangles with separate corners, because colours are stored per corner.
    fn paint(&mut self, triangles: &[Triangle], first: usize, colors: &[[f32; 3]]) {
        for Triangle { corners, material } in triangles {
            let place = self.positions.len();
            self.painting.add(
                *material as usize,
                place,
                corners.map(|corner| colors[corner as usize - first]),
            );
            self.positions.extend(corners.map(|corner| self.positions[corner as usize]));
            self.uvs.extend([[0.0; 2]; 3]);
            let corners = std::array::from_fn(|k| (place + k) as u32);
            self.triangles.push(Triangle { corners, material: *material });
        }
    }

    fn place_of(&mut self, material_use: MaterialUse) -> u32 {
        let place = self.material_uses.iter().position(|used| *used == material_use).unwrap_or_else(|| {
            self.material_uses.push(material_use);
            self.material_uses.len() - 1
        });
        place as u32
    }

    /// The mesh, its textures decoded on all threads, and the notes about it.
    pub(super) fn build(mut self) -> Result<(Mesh, Vec<ImportNote>), ImportFault> {
        if self.triangles.is_empty() {
            return Err(ImportFault::NoTriangles);
        }
        self.painting.place(&mut self.uvs);
        let (materials, lost) = materials(self.buffers, &self.material_uses, &self.painting)?;
        let hidden = (self.hidden > 0).then_some(ImportNote::HiddenColors { surfaces: self.hidden });
        let notes = lost.into_iter().chain(hidden).collect();
        Ok((Mesh::new(self.positions, self.uvs, self.triangles, materials)?, notes))
    }
}

fn has_area([a, b, c]: [[f32; 3]; 3]) -> bool {
    let [a, b, c] = [a, b, c].map(|p| nalgebra::Vector3::from(p.map(f64::from)));
    (b - a).cross(&(c - a)).norm_squared() > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slivers_have_no_area() {
        assert!(!has_area([[0.0; 3], [1.0; 3], [2.0; 3]]));
        assert!(has_area([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1e-3, 0.0]]));
    }
}
