//! The glTF description: parsing, versions and extensions.

use crate::import::ImportFault;
use gltf::json::validation::Validate;
use gltf::json::{Index, Root};

/// Extensions that may be required: read, or of no matter to a camera that sees matt surfaces, or of textures that are then grey.
const UNDERSTOOD: [&str; 17] = [
    "EXT_texture_webp",
    "EXT_texture_avif",
    "KHR_texture_basisu",
    "MSFT_texture_dds",
    "KHR_texture_transform",
    "KHR_mesh_quantization",
    "KHR_lights_punctual",
    "KHR_materials_unlit",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_variants",
    "KHR_xmp_json_ld",
];

/// The item of a list that an index means; `kind` is the list's name in the file.
///
/// The schema crate checks most indices, not all of them.
pub(super) fn at<'a, T>(list: &'a [T], index: Index<T>, kind: &str) -> Result<&'a T, ImportFault> {
    let reason = || format!("{kind}[{index}] is meant, but there are {}", list.len());
    list.get(index.value()).ok_or_else(|| ImportFault::NotGltf { reason: reason() })
}

/// The description in a glTF file.
pub(super) fn parse(json: &[u8]) -> Result<Root, ImportFault> {
    let not_gltf = |reason: String| ImportFault::NotGltf { reason };
    let mut root = Root::from_slice(json).map_err(|e| not_gltf(e.to_string()))?;
    if !root.asset.version.starts_with("2.") {
        return Err(not_gltf(format!("asset.version is '{}', expected 2.x", root.asset.version)));
    }
    if let Some(name) = root.extensions_required.iter().find(|name| !UNDERSTOOD.contains(&name.as_str())) {
        return Err(ImportFault::Extension { name: name.clone() });
    }
    root.extensions_required.clear();
    check_attributes(&root)?;
    let mut first = None;
    root.validate(&root, gltf::json::Path::new, &mut |path, error| {
        first.get_or_insert_with(|| format!("{}: {error}", path()));
    });
    first.map_or(Ok(root), |reason| Err(not_gltf(reason)))
}

/// The schema crate's own validation takes these indices for good and panics where they are not.
fn check_attributes(root: &Root) -> Result<(), ImportFault> {
    for (i, mesh) in root.meshes.iter().enumerate() {
        for (k, primitive) in mesh.primitives.iter().enumerate() {
            if let Some(index) = primitive.attributes.values().find(|a| a.value() >= root.accessors.len()) {
                let list = format!("meshes[{i}].primitives[{k}].attributes: accessors");
                at(&root.accessors, *index, &list)?;
            }
        }
    }
    Ok(())
}
