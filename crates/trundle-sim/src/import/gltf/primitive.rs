//! glTF primitives: triangles with texture coordinates.

use super::accessor;
use super::buffers::Buffers;
use super::schema::at;
use crate::import::ImportFault;
use gltf::json::accessor::{Accessor, Type};
use gltf::json::extensions::texture::TextureTransform;
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Index, texture};
use trundle_core::Invalid;

/// A primitive's surface, in its mesh's frame.
pub(super) struct Surface {
    pub(super) positions: Vec<[f32; 3]>,
    /// One per position; zeros if the primitive has none.
    pub(super) uvs: Vec<[f32; 2]>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Linear shares of red, green and blue, one per position, if the primitive has them.
    pub(super) colors: Option<Vec<[f32; 3]>>,
}

impl Surface {
    /// Points and lines have no triangles.
    pub(super) fn read(buffers: &Buffers<'_>, primitive: &Primitive) -> Result<Self, ImportFault> {
        let Some(positions) = attribute(primitive, Semantic::Positions) else {
            return Ok(Self { positions: Vec::new(), uvs: Vec::new(), triangles: Vec::new(), colors: None });
        };
        let positions = accessor::vectors::<3>(buffers, positions)?;
        let uvs = read_uvs(buffers, primitive, positions.len())?;
        let corners = match primitive.indices {
            Some(indices) => accessor::indices(buffers, indices)?,
            None => (0..positions.len() as u32).collect(),
        };
        if let Some(i) = corners.iter().position(|&corner| corner as usize >= positions.len()) {
            let accessor = primitive.indices.map_or(String::new(), |index| format!(" of accessor {index}"));
            let expected = format!("below {}, the number of positions", positions.len());
            return Err(Invalid::new(format!("index {i}{accessor}"), corners[i], "", expected).into());
        }
        let colors = read_colors(buffers, primitive, positions.len())?;
        Ok(Self { positions, uvs, triangles: assemble(&primitive.mode, &corners), colors })
    }
}

/// Triangles of a list, a strip or a fan (glTF 2.0, section 3.7.2.1).
fn assemble(mode: &Checked<Mode>, corners: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        Checked::Valid(Mode::Triangles) => corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
        Checked::Valid(Mode::TriangleStrip) => {
            corners.windows(3).enumerate().map(|(i, c)| [c[0], c[1 + i % 2], c[2 - i % 2]]).collect()
        }
        Checked::Valid(Mode::TriangleFan) => {
            corners.get(1..).unwrap_or_default().windows(2).map(|c| [c[0], c[1], corners[0]]).collect()
        }
        _ => Vec::new(),
    }
}

fn attribute(primitive: &Primitive, semantic: Semantic) -> Option<Index<Accessor>> {
    primitive.attributes.get(&Checked::Valid(semantic)).copied()
}

/// The coordinates for the material's base colour texture, moved by KHR_texture_transform.
fn read_uvs(
    buffers: &Buffers<'_>,
    primitive: &Primitive,
    count: usize,
) -> Result<Vec<[f32; 2]>, ImportFault> {
    let texture = base_color_texture(buffers, primitive)?;
    let transform = texture.and_then(|info| info.extensions.as_ref()?.texture_transform.as_ref());
    let set = transform.and_then(|t| t.tex_coord).or(texture.map(|info| info.tex_coord)).unwrap_or(0);
    let Some(index) = attribute(primitive, Semantic::TexCoords(set)) else {
        return Ok(vec![[0.0; 2]; count]);
    };
    let mut uvs = accessor::vectors::<2>(buffers, index)?;
    require_count(&format!("accessor {index} of texture coordinates"), uvs.len(), count)?;
    if let Some(transform) = transform {
        for uv in &mut uvs {
            *uv = transformed(*uv, transform);
        }
    }
    Ok(uvs)
}

/// The colours of the corners without alpha; `None` if absent, or if all are white.
fn read_colors(
    buffers: &Buffers<'_>,
    primitive: &Primitive,
    count: usize,
) -> Result<Option<Vec<[f32; 3]>>, ImportFault> {
    let Some(index) = attribute(primitive, Semantic::Colors(0)) else { return Ok(None) };
    let accessor = at(&buffers.root().accessors, index, "accessors")?;
    let colors = match accessor.type_ {
        Checked::Valid(Type::Vec4) => {
            accessor::vectors::<4>(buffers, index)?.into_iter().map(|[r, g, b, _]| [r, g, b]).collect()
        }
        _ => accessor::vectors::<3>(buffers, index)?,
    };
    require_count(&format!("accessor {index} of colours"), colors.len(), count)?;
    Ok(colors.iter().any(|color| *color != [1.0; 3]).then_some(colors))
}

fn require_count(item: &str, found: usize, expected: usize) -> Result<(), ImportFault> {
    if found != expected {
        return Err(Invalid::new(item, found, "", format!("{expected} as positions")).into());
    }
    Ok(())
}

fn base_color_texture<'a>(
    buffers: &Buffers<'a>,
    primitive: &Primitive,
) -> Result<Option<&'a texture::Info>, ImportFault> {
    let Some(index) = primitive.material else { return Ok(None) };
    let material = at(&buffers.root().materials, index, "materials")?;
    Ok(material.pbr_metallic_roughness.base_color_texture.as_ref())
}

/// Scaled, turned, shifted, as in the extension's example; the printed matrix of the extension turns the other way.
fn transformed([u, v]: [f32; 2], transform: &TextureTransform) -> [f32; 2] {
    let (s, c) = transform.rotation.0.sin_cos();
    let (u, v) = (u * transform.scale.0[0], v * transform.scale.0[1]);
    [c * u + s * v + transform.offset.0[0], c * v - s * u + transform.offset.0[1]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use gltf::json::extensions::texture::{
        TextureTransformOffset, TextureTransformRotation, TextureTransformScale,
    };

    #[test]
    fn strips_and_fans_keep_their_winding() {
        let corners = [0, 1, 2, 3, 4];
        assert_eq!(assemble(&Checked::Valid(Mode::Triangles), &corners), [[0, 1, 2]]);
        assert_eq!(
            assemble(&Checked::Valid(Mode::TriangleStrip), &corners),
            [[0, 1, 2], [1, 3, 2], [2, 3, 4]]
        );
        assert_eq!(assemble(&Checked::Valid(Mode::TriangleFan), &corners), [[1, 2, 0], [2, 3, 0], [3, 4, 0]]);
        assert!(assemble(&Checked::Valid(Mode::Lines), &corners).is_empty());
        assert!(assemble(&Checked::Valid(Mode::TriangleFan), &[]).is_empty());
    }

    #[test]
    fn the_example_of_the_extension_uses_the_lower_left_quadrant() {
        let transform = TextureTransform {
            offset: TextureTransformOffset([0.0, 1.0]),
            rotation: TextureTransformRotation(std::f32::consts::FRAC_PI_2),
            scale: TextureTransformScale([0.5, 0.5]),
            ..TextureTransform::default()
        };
        let near = |a: [f32; 2], b: [f32; 2]| (a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-6;
        assert!(near(transformed([0.0, 0.0], &transform), [0.0, 1.0]));
        assert!(near(transformed([1.0, 1.0], &transform), [0.5, 0.5]));
    }
}
