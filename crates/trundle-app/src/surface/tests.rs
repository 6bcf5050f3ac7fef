//! Files of a small surface, and refusals.

use super::*;
use trundle_core::{ColorImage, DepthImage};

fn request(mesh: &str) -> Result<SurfaceRequest, AppError> {
    let heights = Path::new("out/height.png");
    SurfaceRequest::new(
        Some(Path::new(mesh)),
        Some(Path::new("c.PLY")),
        Some(Path::new("o.bt")),
        Some(heights),
        Some(0.04),
    )
}

/// Looks down at the floor from 1.2 m, at `x`.
fn above_floor(x: f64) -> Pose3 {
    let rotation = nalgebra::Matrix3::new(0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0);
    Pose3::from_matrix(rotation, nalgebra::Vector3::new(x, 0.0, 1.2))
}

fn floor(second: f64) -> RgbdImage {
    let camera = PinholeCamera::kinect_v2();
    let (width, height) = (camera.width(), camera.height());
    let color = ColorImage::filled(width, height, [90, 60, 30]);
    let stamp = Stamp::default().after(second);
    RgbdImage::new(stamp, color, DepthImage::filled(width, height, 1.2)).unwrap()
}

#[test]
fn four_files_of_a_floor_are_made() {
    let request = request("m.glb").unwrap();
    let mut surface = Surface::new(&request).unwrap();
    for i in 0..4 {
        let (second, pose) = (f64::from(i), above_floor(0.2 * f64::from(i)));
        assert!(surface.is_due(Stamp::default().after(second), pose));
        surface.integrate(&floor(second), &PinholeCamera::kinect_v2(), pose).unwrap();
        assert!(!surface.is_due(Stamp::default().after(second + 0.1), pose), "the same view");
    }
    let made = surface.files(&request, Path::new("in")).unwrap();
    let names: Vec<_> = made.files.iter().map(|(path, _)| path.to_str().unwrap()).collect();
    assert_eq!(names, ["m.glb", "c.PLY", "o.bt", "out/height.png", "out/height.png.yaml"]);
    let starts = ["glTF", "ply\n", "# Octomap", "\u{89}PNG", "# Heights"];
    for ((name, bytes), start) in made.files.iter().zip(starts) {
        let head: String = bytes.iter().take(start.chars().count()).map(|byte| char::from(*byte)).collect();
        assert_eq!(head, start, "{}", name.display());
    }
    let lowest = String::from_utf8(made.files[4].1.clone()).unwrap();
    assert!(lowest.contains("resolution: 0.05"), "{lowest}");
}

#[test]
fn wrong_names_and_an_empty_surface_are_refused_in_words() {
    let error = request("m.obj").unwrap_err().to_string();
    assert!(error.contains("m.obj: a mesh is written as .glb or .ply"), "{error}");
    let cloud = SurfaceRequest::new(None, Some(Path::new("c.pcd")), None, None, None).unwrap_err();
    assert!(cloud.to_string().contains("ends in .ply"), "{cloud}");
    assert!(SurfaceRequest::new(None, None, None, None, Some(0.0)).is_err());
    let twice = Some(Path::new("m.ply"));
    let error = SurfaceRequest::new(twice, twice, None, None, None).unwrap_err().to_string();
    assert!(error.contains("m.ply: --mesh and --cloud"), "{error}");
    let idle = SurfaceRequest::new(None, None, None, None, Some(0.05)).unwrap_err().to_string();
    assert!(idle.contains("--voxel 0.05 m has no effect without a surface"), "{idle}");
    let nothing = SurfaceRequest::new(None, None, None, None, None).unwrap();
    assert!(nothing.is_empty());
    let failure = Surface::new(&nothing).unwrap().files(&nothing, Path::new("in")).unwrap().failure.unwrap();
    assert!(failure.contains("in: no surface: 0 images"), "{failure}");
}
