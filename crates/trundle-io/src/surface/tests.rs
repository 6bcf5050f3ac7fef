//! Files read back, by other readers where there are some.

use super::*;
use std::path::Path;

/// A square of two triangles, half red and half blue.
fn with_square<T>(check: impl FnOnce(&SurfaceData<'_>) -> T) -> T {
    check(&SurfaceData {
        vertices: &[[0.0, 0.0, 1.0], [2.0, 0.0, 1.0], [2.0, 3.0, 1.0], [0.0, 3.0, 1.0]],
        normals: &[[0.0, 0.0, 1.0]; 4],
        colors: &[[255, 0, 0], [255, 0, 0], [0, 0, 255], [0, 0, 255]],
        triangles: &[[0, 1, 2], [0, 2, 3]],
    })
}

#[test]
fn a_ply_has_the_bytes_that_its_header_says() {
    let bytes = with_square(ply_bytes);
    let end = bytes.windows(11).position(|window| window == b"end_header\n").unwrap() + 11;
    let header = String::from_utf8(bytes[..end].to_vec()).unwrap();
    assert!(header.contains("element vertex 4\n") && header.contains("element face 2\n"), "{header}");
    assert_eq!(bytes.len() - end, 4 * 27 + 2 * 13);
    assert_eq!(bytes[end + 27..end + 31], 2.0_f32.to_le_bytes());
    let cloud = with_square(|square| ply_bytes(&SurfaceData { triangles: &[], ..*square }));
    assert!(!String::from_utf8_lossy(&cloud).contains("face"));
}

#[test]
fn a_glb_is_read_by_a_gltf_library_with_its_colours_and_its_size() {
    let file = gltf::Gltf::from_slice(&with_square(glb_bytes)).unwrap();
    let blob = file.blob.clone().unwrap();
    let primitive = file.meshes().next().unwrap().primitives().next().unwrap();
    let bytes = |accessor: gltf::Accessor<'_>| {
        let view = accessor.view().unwrap();
        blob[view.offset()..view.offset() + view.length()].to_vec()
    };
    let positions = primitive.get(&gltf::Semantic::Positions).unwrap();
    assert_eq!((positions.count(), &bytes(positions)[24..28]), (4, &2.0_f32.to_le_bytes()[..]));
    let indices = bytes(primitive.indices().unwrap());
    let indices: Vec<u8> = indices.chunks(4).map(|index| index[0]).collect();
    assert_eq!(indices, [0, 1, 2, 0, 2, 3]);
    let colors = bytes(primitive.get(&gltf::Semantic::Colors(0)).unwrap());
    assert_eq!(
        (&colors[..8], &colors[24..]),
        (&[255, 255, 0, 0, 0, 0, 255, 255][..], &[0, 0, 0, 0, 255, 255, 255, 255][..])
    );
    assert_eq!(primitive.bounding_box().max, [2.0, 3.0, 1.0]);
    let empty = SurfaceData { vertices: &[], normals: &[], colors: &[], triangles: &[] };
    assert!(glb_bytes(&empty).starts_with(b"glTF"));
}

#[test]
fn an_octree_joins_equal_voxels_and_keeps_unknown_ones() {
    // Eight free voxels of one octant, and one occupied one elsewhere.
    let free = (0..8).map(|i| ([i & 1, i >> 1 & 1, i >> 2], false));
    let bytes = octomap_bytes(0.05, free.chain([([-1, 0, 0], true), ([40_000, 0, 0], true)]));
    let text = String::from_utf8_lossy(&bytes);
    let data = bytes.windows(5).position(|window| window == b"data\n").unwrap() + 5;
    // Root; 14 nodes and a joined leaf above the free ones; 15 nodes and a leaf above the occupied one.
    assert!(text.contains("size 32\n") && text.contains("res 0.05\n"), "{text}");
    assert_eq!(bytes.len() - data, 2 * (1 + 14 + 15));
    let root = u16::from_le_bytes([bytes[data], bytes[data + 1]]);
    // Octant 6 is -x +y +z, octant 7 is +x +y +z: both have children.
    assert_eq!(root, 0b11 << 12 | 0b11 << 14);
    assert!(octomap_bytes(0.05, std::iter::empty()).ends_with(b"data\n"));
}

#[test]
fn heights_become_millimetres_above_the_lowest() {
    let heights = [0.5, f32::NAN, 0.7, 99.0];
    let grid = HeightGrid { resolution: 0.1, origin: [-1.0, 2.0], width: 2, heights: &heights };
    let files = height_files(Path::new("out/height.png"), &grid).unwrap();
    let picture = image::load_from_memory(&files.picture).unwrap().into_luma16();
    assert_eq!(picture.dimensions(), (2, 2));
    assert_eq!(picture.as_raw(), &[200, u16::MAX, 0, u16::MAX]);
    assert!(
        files.description.contains("image: \"height.png\"") && files.description.contains("lowest_m: 0.5")
    );
}
