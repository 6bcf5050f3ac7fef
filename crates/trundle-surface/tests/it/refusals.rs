//! Settings, images and poses that are refused, and an empty map.

use crate::scene::{Body, camera, grey, image, look_at};
use nalgebra::{UnitQuaternion, Vector3};
use trundle_core::{PinholeCamera, Pose3};
use trundle_surface::{OccupiedVoxels, SurfaceConfig, SurfaceMap, SurfaceMesh, surface_mesh};

/// Field of a setting, and a change of it beyond its range.
type Wrong = (&'static str, fn(&mut SurfaceConfig));

#[test]
fn each_setting_out_of_its_range_is_named() {
    let default = SurfaceConfig::default();
    let wrong: [Wrong; 10] = [
        ("voxel", |c| c.voxel = 0.003),
        ("voxel", |c| c.voxel = 0.6),
        ("voxel", |c| c.voxel = f64::NAN),
        ("truncation_voxels", |c| c.truncation_voxels = 1.9),
        ("truncation_voxels", |c| c.truncation_voxels = f64::INFINITY),
        ("min_depth", |c| c.min_depth = 0.0),
        ("max_depth", |c| c.max_depth = 0.3),
        ("max_depth", |c| c.max_depth = 31.0),
        ("min_weight", |c| c.min_weight = 0),
        ("min_weight", |c| c.min_weight = 101),
    ];
    for (field, set) in wrong {
        let mut config = default;
        set(&mut config);
        assert_eq!(SurfaceMap::new(config).unwrap_err().field, field, "{config:?}");
    }
    assert_eq!(default.validated().unwrap(), default);
}

#[test]
fn an_empty_map_is_an_empty_mesh() {
    let map = SurfaceMap::new(SurfaceConfig::default()).unwrap();
    let mesh = surface_mesh(&map);
    assert_eq!(mesh, SurfaceMesh::default());
    assert_eq!((mesh.area(), mesh.without_specks(9), map.is_full()), (0.0, mesh.clone(), false));
    assert_eq!(map.memory(), 0);
}

#[test]
fn a_wrong_camera_and_wrong_poses_are_refused_by_map_and_octree() {
    let wall = [grey(Body::Plane { at: [1.5, 0.0, 0.0], normal: [-1.0, 0.0, 0.0] })];
    let image = image(&wall, &camera(), &look_at([0.0; 3], [1.0, 0.0, 0.0]));
    let (mut map, mut voxels) =
        (SurfaceMap::new(SurfaceConfig::default()).unwrap(), OccupiedVoxels::new(0.05).unwrap());
    let config = SurfaceConfig::default();
    let mut refused = |camera: &PinholeCamera, pose: &Pose3| {
        let errors = [map.integrate(&image, camera, pose), voxels.integrate(&image, camera, pose, &config)];
        assert_eq!((surface_mesh(&map).vertices.len(), voxels.iter().count()), (0, 0));
        errors.map(|error| error.unwrap_err().to_string())
    };
    let size = refused(&PinholeCamera::kinect_v2(), &Pose3::identity());
    assert!(
        size.iter().all(|error| error.contains("160 x 120") && error.contains("as the camera")),
        "{size:?}"
    );
    for at in [f64::NAN, f64::INFINITY] {
        let pose = Pose3 { translation: Vector3::new(0.0, at, 0.0), ..Pose3::identity() };
        let error = refused(&camera(), &pose);
        assert!(error.iter().all(|error| error.contains("pose of the camera")), "{error:?}");
    }
    let turned = nalgebra::Quaternion::new(f64::NAN, 0.0, 0.0, 0.0);
    let pose = Pose3 { rotation: UnitQuaternion::new_unchecked(turned), ..Pose3::identity() };
    refused(&camera(), &pose);
}

#[test]
fn sides_of_octree_voxels_have_a_range() {
    for resolution in [0.0, -0.05, 0.009, 1.01, f64::NAN, f64::INFINITY] {
        let error = OccupiedVoxels::new(resolution).unwrap_err();
        assert_eq!((error.field.as_str(), error.unit), ("resolution", "m"), "{resolution}");
    }
    assert_eq!(OccupiedVoxels::new(0.05).unwrap().resolution(), 0.05);
}
