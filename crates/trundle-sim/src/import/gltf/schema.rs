//! The glTF description: parsing, versions and extensions.

use crate::import::ImportFault;
use gltf::json::validation::Validate;
use gltf::json::{Index, Root, Value, deserialize};

/// Extensions that may be required: read, without effect on matt surfaces, or of textures that are then grey.
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
/// The schema crate checks only most indices.
pub(super) fn at<'a, T>(list: &'a [T], index: Index<T>, kind: &str) -> Result<&'a T, ImportFault> {
    let reason = || format!("{kind}[{index}] is meant, but there are {}", list.len());
    list.get(index.value()).ok_or_else(|| ImportFault::NotGltf { reason: reason() })
}

/// The description in a glTF file.
pub(super) fn parse(json: &[u8]) -> Result<Root, ImportFault> {
    let not_gltf = |reason: String| ImportFault::NotGltf { reason };
    let mut value: Value = deserialize::from_slice(json).map_err(|error| not_gltf(broken_json(&error)))?;
    remove_extras(&mut value);
    remove_unused_maps(&mut value);
    let mut root: Root = deserialize::from_value(value).map_err(|error| not_gltf(wrong_value(&error)))?;
    if !root.asset.version.starts_with("2.") {
        return Err(not_gltf(format!("asset.version is '{}', expected 2.x", root.asset.version)));
    }
    if let Some(name) = root.extensions_required.iter().find(|name| !UNDERSTOOD.contains(&name.as_str())) {
        return Err(ImportFault::Extension { name: name.clone() });
    }
    root.extensions_required.clear();
    check_attributes(&root)?;
    leave_out_lost_images(&mut root);
    let mut first = None;
    root.validate(&root, gltf::json::Path::new, &mut |path, error| {
        first.get_or_insert_with(|| format!("{}: {error}", path()));
    });
    first.map_or(Ok(root), |reason| Err(not_gltf(reason)))
}

/// Place and fault of a file that is not JSON.
fn broken_json(error: &gltf::json::Error) -> String {
    let (line, column) = (error.line(), error.column());
    if error.is_eof() {
        return format!(
            "its JSON ends at line {line}, column {column}, in the middle: the file is cut short"
        );
    }
    format!("its JSON is broken at line {line}, column {column}")
}

/// Part of the JSON that does not match glTF's schema.
fn wrong_value(error: &gltf::json::Error) -> String {
    let problem = error.to_string();
    match problem.split_once("missing field ") {
        Some((_, name)) => format!("{name} is missing"),
        None => format!("a value is not as glTF 2.0 has it: {problem}"),
    }
}

/// Removes all `extras`: the standard allows any value, the schema crate only objects.
fn remove_extras(value: &mut Value) {
    match value {
        Value::Object(members) => {
            members.remove("extras");
            members.values_mut().for_each(remove_extras);
        }
        Value::Array(items) => items.iter_mut().for_each(remove_extras),
        _ => {}
    }
}

/// Members of a material that hold maps which the renderer does not use.
const UNUSED_MEMBERS: [&str; 4] = ["normalTexture", "occlusionTexture", "emissiveTexture", "extensions"];

/// Removes the maps of materials that the renderer does not use: a wrong index in one of them would refuse the whole scene.
fn remove_unused_maps(value: &mut Value) {
    let materials = value.get_mut("materials").and_then(Value::as_array_mut).into_iter().flatten();
    for material in materials.filter_map(Value::as_object_mut) {
        UNUSED_MEMBERS.iter().for_each(|name| drop(material.remove(*name)));
        let surface = material.get_mut("pbrMetallicRoughness").and_then(Value::as_object_mut);
        surface.into_iter().for_each(|surface| drop(surface.remove("metallicRoughnessTexture")));
    }
}

/// Removes indices of missing image data. Such a texture is grey; otherwise the whole scene would be refused.
fn leave_out_lost_images(root: &mut Root) {
    let (views, images) = (root.buffer_views.len(), root.images.len());
    for image in &mut root.images {
        image.buffer_view = image.buffer_view.filter(|view| view.value() < views);
    }
    for texture in root.textures.iter_mut().filter(|texture| texture.source.value() >= images) {
        texture.source = Index::new(u32::MAX); // as the schema crate has a texture without an image
    }
}

/// The schema crate's own validation assumes valid indices and panics otherwise.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(material: &str) -> Result<Root, ImportFault> {
        parse(format!(r#"{{"asset": {{"version": "2.0"}}, "materials": [{material}]}}"#).as_bytes())
    }

    #[test]
    fn a_wrong_index_of_a_map_that_is_not_drawn_is_not_a_fault() {
        for map in [
            r#"{"normalTexture": {"index": 7}}"#,
            r#"{"occlusionTexture": {"index": 7}}"#,
            r#"{"emissiveTexture": {"index": 7}}"#,
            r#"{"pbrMetallicRoughness": {"metallicRoughnessTexture": {"index": 7}}}"#,
            r#"{"extensions": {"KHR_materials_clearcoat": {"clearcoatTexture": {"index": 7}}}}"#,
        ] {
            let root = parsed(map).unwrap_or_else(|fault| panic!("{map}: {fault}"));
            assert_eq!(root.materials.len(), 1);
        }
        let drawn = parsed(r#"{"pbrMetallicRoughness": {"baseColorTexture": {"index": 7}}}"#);
        assert!(drawn.is_err(), "the base colour is drawn");
    }
}
