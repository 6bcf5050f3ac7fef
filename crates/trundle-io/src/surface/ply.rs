//! PLY, binary, little-endian. Source: G. Turk, The PLY Polygon File Format, 1994.

use super::SurfaceData;

/// The surface as a binary PLY file: position, normal, colour; faces if it has triangles.
#[must_use]
pub fn ply_bytes(surface: &SurfaceData<'_>) -> Vec<u8> {
    let mut bytes = header(surface).into_bytes();
    bytes.reserve(surface.vertices.len() * 27 + surface.triangles.len() * 13);
    for ((at, normal), color) in surface.vertices.iter().zip(surface.normals).zip(surface.colors) {
        at.iter().chain(normal).for_each(|number| bytes.extend(number.to_le_bytes()));
        bytes.extend(color);
    }
    for triangle in surface.triangles {
        bytes.push(3);
        triangle.iter().for_each(|corner| bytes.extend(corner.to_le_bytes()));
    }
    bytes
}

fn header(surface: &SurfaceData<'_>) -> String {
    let mut text = format!(
        "ply\nformat binary_little_endian 1.0\ncomment trundle: metres, z up\nelement vertex {}\n",
        surface.vertices.len()
    );
    for name in ["x", "y", "z", "nx", "ny", "nz"] {
        text += &format!("property float {name}\n");
    }
    for name in ["red", "green", "blue"] {
        text += &format!("property uchar {name}\n");
    }
    if !surface.triangles.is_empty() {
        let faces = surface.triangles.len();
        text += &format!("element face {faces}\nproperty list uchar uint vertex_indices\n");
    }
    text + "end_header\n"
}
