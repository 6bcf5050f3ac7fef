//! Laws of a mesh without its small parts.

use proptest::prelude::*;
use trundle_surface::SurfaceMesh;

/// Triangles among `count` vertices.
fn any_mesh() -> impl Strategy<Value = SurfaceMesh> {
    (3..40_u32).prop_flat_map(|count| {
        let corner = prop::array::uniform3(0..count);
        prop::collection::vec(corner, 0..30).prop_map(move |triangles| SurfaceMesh {
            vertices: (0..count).map(|i| [i as f32, (i * i % 17) as f32, (i % 5) as f32]).collect(),
            normals: vec![[0.0, 0.0, 1.0]; count as usize],
            colors: (0..count).map(|i| [i as u8; 3]).collect(),
            triangles,
        })
    })
}

proptest! {
    #[test]
    fn parts_are_kept_whole_or_dropped_whole(mesh in any_mesh(), min in 0..12_usize) {
        let kept = mesh.without_specks(min);
        prop_assert_eq!(&kept.without_specks(min), &kept);
        prop_assert_eq!((kept.vertices.len(), kept.vertices.len()), (kept.normals.len(), kept.colors.len()));
        prop_assert!(kept.triangles.iter().flatten().all(|corner| (*corner as usize) < kept.vertices.len()));
        // The colour of a vertex is its number in the first mesh.
        let number = |corner: u32| u32::from(kept.colors[corner as usize][0]);
        let renamed: Vec<_> = kept.triangles.iter().map(|triangle| triangle.map(number)).collect();
        let is_kept = |corner: &u32| kept.colors.contains(&[*corner as u8; 3]);
        let expected: Vec<_> = mesh.triangles.iter().copied().filter(|triangle| is_kept(&triangle[0])).collect();
        prop_assert_eq!(renamed, expected);
        prop_assert!(kept.area() <= mesh.area() + 1e-9);
    }

    #[test]
    fn more_vertices_asked_for_keep_fewer(mesh in any_mesh(), min in 0..12_usize, more in 0..12_usize) {
        let (few, fewer) = (mesh.without_specks(min), mesh.without_specks(min + more));
        prop_assert!(fewer.colors.iter().all(|color| few.colors.contains(color)));
        prop_assert_eq!(mesh.without_specks(1), mesh);
    }
}
