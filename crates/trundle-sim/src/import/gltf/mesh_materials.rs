//! The materials of a glTF file: colours and decoded textures. A texture that cannot be read is grey.

use super::buffers::Buffers;
use super::schema::at;
use super::srgb::srgb;
use super::textures;
use super::vertex_colors::Painting;
use crate::import::{ImportFault, ImportNote};
use crate::world::Material;
use gltf::json::{Index, image, material};
use rayon::prelude::*;
use std::collections::BTreeMap;
use trundle_core::ColorImage;

/// sRGB level of a texture that cannot be read, before the material's own colour. Source: ours.
const GREY_LEVEL: u8 = 150;
/// Place of the image of a texture without one, as `gltf-json` has it.
const NO_IMAGE: usize = u32::MAX as usize;

/// Appearance of surfaces: a material of the file, and optionally vertex colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct MaterialUse {
    /// `None` is the default material.
    pub(super) material: Option<Index<material::Material>>,
    /// Whether the corners' colours are drawn.
    pub(super) is_painted: bool,
}

/// The decoded images, and for each other image the reason.
type Images = BTreeMap<usize, Result<ColorImage, String>>;

/// The materials of a mesh, in the order of `material_uses`, and notes about the materials.
pub(super) fn materials(
    buffers: &Buffers<'_>,
    material_uses: &[MaterialUse],
    painting: &Painting,
) -> Result<(Vec<Material>, Option<ImportNote>), ImportFault> {
    let mut wanted = Vec::new();
    for material_use in material_uses {
        wanted.extend(image_of(buffers, material_use.material)?);
    }
    wanted.sort_unstable();
    wanted.dedup();
    let images: Images = wanted
        .par_iter()
        .map(|index| (index.value(), decoded(buffers, *index)))
        .collect::<Vec<_>>()
        .into_iter()
        .collect();
    let make = |(place, material_use): (usize, &MaterialUse)| {
        material_of(buffers, *material_use, &images, painting.picture(place))
    };
    let materials = material_uses.iter().enumerate().map(make).collect::<Result<_, _>>()?;
    let lost: Vec<String> = images.into_values().filter_map(Result::err).collect();
    Ok((materials, (!lost.is_empty()).then_some(ImportNote::LostTextures { reasons: lost })))
}

/// The image, or the reason for its absence.
fn decoded(buffers: &Buffers<'_>, index: Index<image::Image>) -> Result<ColorImage, String> {
    if index.value() == NO_IMAGE {
        return Err("a texture names no PNG or JPEG image".to_owned());
    }
    textures::decode(buffers, index).map_err(|fault| fault.to_string())
}

/// The image of a material's texture.
pub(super) fn image_of(
    buffers: &Buffers<'_>,
    material: Option<Index<material::Material>>,
) -> Result<Option<Index<image::Image>>, ImportFault> {
    let Some(material) = material else { return Ok(None) };
    let root = buffers.root();
    let material_use = &at(&root.materials, material, "materials")?.pbr_metallic_roughness;
    let texture = material_use.base_color_texture.as_ref();
    texture.map(|info| Ok(at(&root.textures, info.index, "textures")?.source)).transpose()
}

fn material_of(
    buffers: &Buffers<'_>,
    material_use: MaterialUse,
    images: &Images,
    painted: Option<ColorImage>,
) -> Result<Material, ImportFault> {
    let Some(index) = material_use.material else {
        return Ok(Material { name: "default".into(), color: [255; 3], texture: painted });
    };
    let material = at(&buffers.root().materials, index, "materials")?;
    let [r, g, b, _] = material.pbr_metallic_roughness.base_color_factor.0;
    let color = [r, g, b].map(srgb);
    let name = material.name.clone().unwrap_or_else(|| format!("material {index}"));
    let image = image_of(buffers, material_use.material)?.and_then(|image| images.get(&image.value()));
    let (color, texture) = match image {
        Some(Ok(image)) => (color, Some(image.clone())),
        Some(Err(_)) => (color.map(|level| (u16::from(level) * u16::from(GREY_LEVEL) / 255) as u8), None),
        None => (color, painted),
    };
    Ok(Material { name, color, texture })
}
