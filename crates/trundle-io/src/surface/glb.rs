//! Binary glTF 2.0: one mesh with colours at its vertices, drawn without light, because the colours contain the light of the room.

use super::SurfaceData;
use serde_json::{Value, json};

/// Kinds of numbers of an accessor. Source: glTF 2.0, section 3.6.2.2.
const FLOAT_COMPONENT: u32 = 5126;
const UNSIGNED_SHORT_COMPONENT: u32 = 5123;
const UNSIGNED_INT_COMPONENT: u32 = 5125;
/// Kinds of a chunk: "JSON" and "BIN". Source: glTF 2.0, section 4.4.3.
const JSON_CHUNK: u32 = 0x4E4F_534A;
const BINARY_CHUNK: u32 = 0x004E_4942;
/// Turn from z up to y up, as a quaternion (x, y, z, w): -90 deg about x. Source: glTF 2.0, section 3.4.
const Y_UP: [f64; 4] = [-std::f64::consts::FRAC_1_SQRT_2, 0.0, 0.0, std::f64::consts::FRAC_1_SQRT_2];

/// The surface as a binary glTF file (`.glb`).
#[must_use]
pub fn glb_bytes(surface: &SurfaceData<'_>) -> Vec<u8> {
    let mut binary = Vec::new();
    let views = [
        push_view(&mut binary, surface.vertices.iter().flatten().map(|number| number.to_le_bytes())),
        push_view(&mut binary, surface.normals.iter().flatten().map(|number| number.to_le_bytes())),
        push_view(&mut binary, surface.colors.iter().flat_map(linear).map(u16::to_le_bytes)),
        push_view(&mut binary, surface.triangles.iter().flatten().map(|index| index.to_le_bytes())),
    ];
    let mut text = document(surface, &views, binary.len()).to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let total = 12 + 8 + text.len() + 8 + binary.len();
    let mut bytes = Vec::with_capacity(total);
    bytes.extend(b"glTF");
    let words = [2, total as u32, text.len() as u32, JSON_CHUNK];
    words.iter().for_each(|word| bytes.extend(word.to_le_bytes()));
    bytes.extend(text);
    [binary.len() as u32, BINARY_CHUNK].iter().for_each(|word| bytes.extend(word.to_le_bytes()));
    bytes.extend(binary);
    bytes
}

/// Appends numbers; offset and length of the view, bytes.
fn push_view<const N: usize>(binary: &mut Vec<u8>, numbers: impl Iterator<Item = [u8; N]>) -> (usize, usize) {
    let offset = binary.len();
    binary.extend(numbers.flatten());
    let length = binary.len() - offset;
    binary.resize(binary.len().next_multiple_of(4), 0);
    (offset, length)
}

/// Linear red, green, blue and opacity of an sRGB colour, 0 to 65535: glTF wants linear colours at vertices.
fn linear(color: &[u8; 3]) -> [u16; 4] {
    let [red, green, blue] = color.map(|channel| {
        let encoded = f64::from(channel) / 255.0;
        let linear = if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) };
        (linear * f64::from(u16::MAX)).round() as u16
    });
    [red, green, blue, u16::MAX]
}

/// Smallest or largest coordinate along each axis; 0 without vertices.
fn bound(surface: &SurfaceData<'_>, pick: fn(f32, f32) -> f32) -> [f32; 3] {
    let picked = surface.vertices.iter().copied().reduce(|a, b| std::array::from_fn(|i| pick(a[i], b[i])));
    picked.unwrap_or_default()
}

fn document(surface: &SurfaceData<'_>, views: &[(usize, usize); 4], length: usize) -> Value {
    let view = |&(offset, length): &(usize, usize), target: u32| json!({ "buffer": 0, "byteOffset": offset, "byteLength": length, "target": target });
    let vertices = surface.vertices.len();
    json!({
        "asset": { "version": "2.0", "generator": "trundle" },
        "extensionsUsed": ["KHR_materials_unlit"],
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "name": "surface", "mesh": 0, "rotation": Y_UP }],
        "materials": [{
            "name": "seen",
            "doubleSided": true,
            "pbrMetallicRoughness": { "metallicFactor": 0.0, "roughnessFactor": 1.0 },
            "extensions": { "KHR_materials_unlit": {} },
        }],
        "meshes": [{ "primitives": [{
            "attributes": { "POSITION": 0, "NORMAL": 1, "COLOR_0": 2 }, "indices": 3, "material": 0,
        }] }],
        "accessors": [
            {
                "bufferView": 0, "componentType": FLOAT_COMPONENT, "count": vertices, "type": "VEC3",
                "min": bound(surface, f32::min), "max": bound(surface, f32::max),
            },
            { "bufferView": 1, "componentType": FLOAT_COMPONENT, "count": vertices, "type": "VEC3" },
            {
                "bufferView": 2, "componentType": UNSIGNED_SHORT_COMPONENT, "normalized": true, "count": vertices,
                "type": "VEC4",
            },
            {
                "bufferView": 3, "componentType": UNSIGNED_INT_COMPONENT, "count": surface.triangles.len() * 3,
                "type": "SCALAR",
            },
        ],
        "bufferViews": [
            view(&views[0], 34962), view(&views[1], 34962), view(&views[2], 34962), view(&views[3], 34963),
        ],
        "buffers": [{ "byteLength": length }],
    })
}
