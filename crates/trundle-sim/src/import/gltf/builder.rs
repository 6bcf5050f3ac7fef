//! Assembly of all glTF surfaces into one mesh.

use super::buffers::Buffers;
use super::primitive::Surface;
use super::schema::at;
use super::textures;
use crate::import::ImportFault;
use crate::world::{Material, Mesh, Triangle};
use gltf::json::{Index, image, material, mesh};
use nalgebra::{Matrix4, Point3};
use rayon::prelude::*;
use std::collections::BTreeMap;
use trundle_core::{ColorImage, Invalid};

/// Farthest coordinate, m: a file beyond it is in another unit or broken.
const MAX_COORDINATE_M: f64 = 1e5;

/// Most triangles of a file with all its instances.
const MOST_TRIANGLES: usize = 50_000_000;

/// Gathers the surfaces of a file into one mesh.
pub(super) struct Builder<'a> {
    buffers: &'a Buffers<'a>,
    positions: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    triangles: Vec<Triangle>,
    /// Materials of the file in use, by their place in the mesh; `None` is the default material.
    used: Vec<Option<Index<material::Material>>>,
}

impl<'a> Builder<'a> {
    pub(super) fn new(buffers: &'a Buffers<'a>) -> Self {
        Self { buffers, positions: Vec::new(), uvs: Vec::new(), triangles: Vec::new(), used: Vec::new() }
    }

    /// Adds a mesh of the file that stands at `world_from_mesh`.
    pub(super) fn add(
        &mut self,
        index: Index<mesh::Mesh>,
        world_from_mesh: &Matrix4<f64>,
    ) -> Result<(), ImportFault> {
        let mesh = at(&self.buffers.root().meshes, index, "meshes")?;
        for primitive in &mesh.primitives {
            let surface = Surface::read(self.buffers, primitive)?;
            if self.triangles.len() + surface.triangles.len() > MOST_TRIANGLES {
                let found = format!("more than {MOST_TRIANGLES}");
                return Err(Invalid::new(
                    "number of triangles",
                    found,
                    "",
                    format!("at most {MOST_TRIANGLES}"),
                )
                .into());
            }
            let material = self.place_of(primitive.material);
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
        let solid = surface.triangles.iter().map(|corners| corners.map(|corner| corner + first as u32));
        let positions = &self.positions;
        self.triangles.extend(
            solid
                .filter(|corners| has_area(corners.map(|corner| positions[corner as usize])))
                .map(|corners| Triangle { corners, material }),
        );
        Ok(())
    }

    fn place_of(&mut self, material: Option<Index<material::Material>>) -> u32 {
        let place = self.used.iter().position(|used| *used == material).unwrap_or_else(|| {
            self.used.push(material);
            self.used.len() - 1
        });
        place as u32
    }

    /// The mesh, its textures decoded on all threads.
    pub(super) fn build(self) -> Result<Mesh, ImportFault> {
        if self.triangles.is_empty() {
            return Err(ImportFault::NoTriangles);
        }
        let images = self.decode_images()?;
        let materials =
            self.used.iter().map(|used| self.material(*used, &images)).collect::<Result<_, _>>()?;
        Ok(Mesh::new(self.positions, self.uvs, self.triangles, materials)?)
    }

    fn decode_images(&self) -> Result<BTreeMap<usize, ColorImage>, ImportFault> {
        let mut wanted = Vec::new();
        for used in self.used.iter().flatten() {
            wanted.extend(self.image_of(*used)?);
        }
        wanted.sort_unstable();
        wanted.dedup();
        let decode =
            |&index: &Index<image::Image>| Ok((index.value(), textures::decode(self.buffers, index)?));
        let decoded: Vec<Result<_, ImportFault>> = wanted.par_iter().map(decode).collect();
        decoded.into_iter().collect()
    }

    fn image_of(
        &self,
        material: Index<material::Material>,
    ) -> Result<Option<Index<image::Image>>, ImportFault> {
        let root = self.buffers.root();
        let look = &at(&root.materials, material, "materials")?.pbr_metallic_roughness;
        let texture = look.base_color_texture.as_ref();
        texture.map(|info| Ok(at(&root.textures, info.index, "textures")?.source)).transpose()
    }

    fn material(
        &self,
        used: Option<Index<material::Material>>,
        images: &BTreeMap<usize, ColorImage>,
    ) -> Result<Material, ImportFault> {
        let Some(index) = used else {
            return Ok(Material { name: "default".into(), color: [255; 3], texture: None });
        };
        let material = at(&self.buffers.root().materials, index, "materials")?;
        let [r, g, b, _] = material.pbr_metallic_roughness.base_color_factor.0;
        let texture = self.image_of(index)?.and_then(|image| images.get(&image.value()).cloned());
        let name = material.name.clone().unwrap_or_else(|| format!("material {index}"));
        Ok(Material { name, color: [r, g, b].map(srgb), texture })
    }
}

fn has_area([a, b, c]: [[f32; 3]; 3]) -> bool {
    let [a, b, c] = [a, b, c].map(|p| nalgebra::Vector3::from(p.map(f64::from)));
    (b - a).cross(&(c - a)).norm_squared() > 0.0
}

/// A linear share of light, 0 to 1, as an sRGB level (IEC 61966-2-1).
fn srgb(linear: f32) -> u8 {
    let x = linear.clamp(0.0, 1.0);
    let level = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    (level * 255.0 + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_become_srgb_and_slivers_have_no_area() {
        assert_eq!([0.0, 0.5, 1.0, 7.0].map(srgb), [0, 188, 255, 255]);
        assert!(!has_area([[0.0; 3], [1.0; 3], [2.0; 3]]));
        assert!(has_area([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1e-3, 0.0]]));
    }
}
