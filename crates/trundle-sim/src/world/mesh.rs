//! Triangle meshes with textured materials.

use trundle_core::{ColorImage, Invalid, Vector2};

/// A surface of triangles with textured materials, world frame, m, z up.
///
/// Both sides of a surface are visible and solid. (u, v) are in texture widths and heights from the upper left corner and
/// repeat outside 0 to 1, as in glTF 2.0.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    positions: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    triangles: Vec<Triangle>,
    materials: Vec<Material>,
}

/// A triangle of a [`Mesh`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Triangle {
    /// Indices of its corners among the positions and the texture coordinates.
    pub corners: [u32; 3],
    /// Index of its material.
    pub material: u32,
}

/// Appearance of a triangle.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// For messages.
    pub name: String,
    /// sRGB; multiplies the texture, if any.
    pub color: [u8; 3],
    /// The texture, sRGB.
    pub texture: Option<ColorImage>,
}

impl Mesh {
    /// A mesh; every position has its texture coordinate.
    ///
    /// # Errors
    /// When a number is not finite, an index is out of range, or the mesh has no triangle; the error names the item.
    pub fn new(
        positions: Vec<[f32; 3]>,
        uvs: Vec<[f32; 2]>,
        triangles: Vec<Triangle>,
        materials: Vec<Material>,
    ) -> Result<Self, Invalid> {
        let mesh = Self { positions, uvs, triangles, materials };
        mesh.check()?;
        Ok(mesh)
    }

    /// The mesh lowered by `height_m`.
    ///
    /// # Errors
    /// When a coordinate is then not finite.
    pub(crate) fn lowered(mut self, height_m: f64) -> Result<Self, Invalid> {
        for position in &mut self.positions {
            position[2] = (f64::from(position[2]) - height_m) as f32;
        }
        self.check()?;
        Ok(self)
    }

    /// The size along x, y and z, to a millimetre, m.
    pub(crate) fn size(&self) -> [f64; 3] {
        std::array::from_fn(|k| {
            let along = || self.positions.iter().map(|position| f64::from(position[k]));
            let size = along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min);
            (size * 1000.0).round() / 1000.0
        })
    }

    /// Corners, world frame, m.
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.positions
    }

    /// Texture coordinates, one a position.
    pub fn uvs(&self) -> &[[f32; 2]] {
        &self.uvs
    }

    /// The triangles.
    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// The materials.
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// The corners of triangle `i`, world frame, m.
    pub fn corners(&self, i: usize) -> [[f32; 3]; 3] {
        self.triangles[i].corners.map(|corner| self.positions[corner as usize])
    }

    fn check(&self) -> Result<(), Invalid> {
        if self.triangles.is_empty() {
            return Err(Invalid::new("triangles of the mesh", 0, "", "1 or more"));
        }
        if self.uvs.len() != self.positions.len() {
            let expected = format!("{} as positions", self.positions.len());
            return Err(Invalid::new("texture coordinates of the mesh", self.uvs.len(), "", expected));
        }
        for (i, position) in self.positions.iter().enumerate() {
            for x in position {
                trundle_core::require_finite(&format!("position {i} of the mesh"), f64::from(*x), "m")?;
            }
        }
        for (i, uv) in self.uvs.iter().enumerate() {
            let uv = Vector2::new(f64::from(uv[0]), f64::from(uv[1]));
            trundle_core::require_finite(&format!("texture coordinate {i} of the mesh"), uv.x + uv.y, "")?;
        }
        let out_of_range = |t: &Triangle| {
            t.corners.iter().any(|&c| c as usize >= self.positions.len())
                || t.material as usize >= self.materials.len()
        };
        match self.triangles.iter().position(out_of_range) {
            Some(i) => Err(Invalid::new(
                format!("triangle {i} of the mesh"),
                format!("{:?}", self.triangles[i]),
                "",
                format!("corners below {}, material below {}", self.positions.len(), self.materials.len()),
            )),
            None => Ok(()),
        }
    }
}
