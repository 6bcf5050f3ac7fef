//! Bodies that a perfect depth camera sees: the true surface is known.

use nalgebra::{Matrix3, Vector3};
use trundle_core::{ColorImage, DepthImage, PinholeCamera, Pose3, RgbdImage, Stamp, Vector2};
use trundle_surface::{SurfaceConfig, SurfaceMap};

/// A body, map frame, m.
#[derive(Debug, Clone, Copy)]
pub enum Body {
    Ball {
        at: [f64; 3],
        radius: f64,
    },
    Block {
        low: [f64; 3],
        high: [f64; 3],
    },
    /// The plane through `at`, seen from the side of `normal`.
    Plane {
        at: [f64; 3],
        normal: [f64; 3],
    },
}

/// A body and the colour of each of its points.
pub type Painted = (Body, fn(Vector3<f64>) -> [u8; 3]);

/// The same body in one colour.
pub fn grey(body: Body) -> Painted {
    (body, |_| [128; 3])
}

impl Body {
    /// Distance along a ray, in units of `direction`.
    fn hit(&self, from: Vector3<f64>, direction: Vector3<f64>) -> Option<f64> {
        let at = match *self {
            Self::Ball { at, radius } => {
                let to = Vector3::from(at) - from;
                let (a, b) = (direction.dot(&direction), direction.dot(&to));
                let root = (b * b - a * (to.dot(&to) - radius * radius)).sqrt();
                (b - root) / a
            }
            Self::Block { low, high } => {
                let (low, high) = (Vector3::from(low) - from, Vector3::from(high) - from);
                let (low, high) = (low.component_div(&direction), high.component_div(&direction));
                let (enter, exit) = (low.inf(&high).max(), low.sup(&high).min());
                if enter < exit { enter } else { f64::NAN }
            }
            Self::Plane { at, normal } => {
                let (at, normal) = (Vector3::from(at), Vector3::from(normal));
                let slope = direction.dot(&normal);
                if slope < 0.0 { (at - from).dot(&normal) / slope } else { f64::NAN }
            }
        };
        (at > 0.0).then_some(at)
    }
}

/// A camera of 160 x 120 px.
pub fn camera() -> PinholeCamera {
    PinholeCamera::from_field_of_view((160, 120), (1.2, 0.95)).unwrap()
}

/// A camera at `from` that looks at `to`, neither of which is above the other.
pub fn look_at(from: [f64; 3], to: [f64; 3]) -> Pose3 {
    let forward = (Vector3::from(to) - Vector3::from(from)).normalize();
    let right = forward.cross(&Vector3::z()).normalize();
    Pose3::from_matrix(Matrix3::from_columns(&[right, forward.cross(&right), forward]), from.into())
}

/// `count` cameras all around a point, `distance` m away.
pub fn around(at: [f64; 3], distance: f64, count: usize) -> Vec<Pose3> {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let pose = |i: usize| {
        let z = 1.0 - (2.0 * i as f64 + 1.0) / count as f64;
        let (ring, turn) = ((1.0 - z * z).sqrt(), golden * i as f64);
        let ray = Vector3::new(ring * turn.cos(), ring * turn.sin(), z);
        look_at((Vector3::from(at) + ray * distance).into(), at)
    };
    (0..count).map(pose).collect()
}

/// The image of `bodies`; depth 0 where a ray meets none.
pub fn image(bodies: &[Painted], camera: &PinholeCamera, pose: &Pose3) -> RgbdImage {
    let from = pose.transform(Vector3::zeros());
    let seen = |x: usize, y: usize| {
        let pixel = camera.undistort(Vector2::new(x as f64, y as f64));
        let direction = pose.rotate(camera.unproject(pixel, 1.0));
        let hits = bodies.iter().filter_map(|(body, paint)| Some((body.hit(from, direction)?, paint)));
        let nearest = hits.min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.map_or((0.0, [0; 3]), |(depth, paint)| (depth as f32, paint(from + direction * depth)))
    };
    let (width, height) = (camera.width(), camera.height());
    let depth = DepthImage::from_fn(width, height, |x, y| seen(x, y).0);
    let color = ColorImage::from_fn(width, height, |x, y| seen(x, y).1);
    RgbdImage::new(Stamp::default(), color, depth).unwrap()
}

/// Settings with voxels of `voxel` m.
pub fn voxels_of(voxel: f64) -> SurfaceConfig {
    let mut config = SurfaceConfig::default();
    config.voxel = voxel;
    config
}

/// The map of `bodies` from `poses`.
pub fn map_of(bodies: &[Painted], poses: &[Pose3], config: SurfaceConfig) -> SurfaceMap {
    let mut map = SurfaceMap::new(config).unwrap();
    look(&mut map, bodies, poses);
    map
}

/// Adds the images of `bodies` from `poses`.
pub fn look(map: &mut SurfaceMap, bodies: &[Painted], poses: &[Pose3]) {
    for pose in poses {
        map.integrate(&image(bodies, &camera(), pose), &camera(), pose).unwrap();
    }
}
