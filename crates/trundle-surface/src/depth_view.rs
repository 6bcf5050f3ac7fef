//! A depth image as its voxels see it: projection, depth, weight, and the range of depths in a part of the image.

use crate::surface_config::SurfaceConfig;
use nalgebra::{Matrix3, Vector3};
use trundle_core::{Distortion, Invalid, PinholeCamera, Pose3, RgbdImage, Vector2};

/// Side of a tile of the image, px: the largest depth of each tile is stored. Source: ours.
const TILE_PX: usize = 16;
/// Depth of a voxel at which an observation has weight 1, m. Nearer ones weigh more by the square of the depth, as the noise of a structured-light or
/// time-of-flight camera. Source: \[Khoshelham12\].
const UNIT_WEIGHT_DEPTH_M: f32 = 2.0;
/// Largest coordinate of a point, map frame, m: farther points are left out. Source: ours.
const MAX_COORDINATE_M: f64 = 10_000.0;
/// Largest weight of an observation. Source: ours, that of a surface at 0.5 m.
const MAX_OBSERVATION_WEIGHT: f32 = 16.0;

/// An RGB-D image with its camera and pose.
pub(crate) struct DepthView<'a> {
    image: &'a RgbdImage,
    camera: &'a PinholeCamera,
    is_distorted: bool,
    intrinsics: [f32; 4],
    /// `camera_from_map`.
    pub(crate) rotation: Matrix3<f32>,
    pub(crate) translation: Vector3<f32>,
    map_from_camera: Pose3,
    depths: (f32, f32),
    tiles: Vec<f32>,
    tile_columns: usize,
}

/// A voxel's observation.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Observation {
    /// Depth of the image at the voxel, m.
    pub(crate) depth: f32,
    pub(crate) color: [u8; 3],
    pub(crate) weight: u16,
}

impl<'a> DepthView<'a> {
    /// # Errors
    /// When the image has another size than the camera, or the pose is not finite.
    pub(crate) fn new(
        image: &'a RgbdImage,
        camera: &'a PinholeCamera,
        map_from_camera: &Pose3,
        config: &SurfaceConfig,
    ) -> Result<Self, Invalid> {
        let size = (image.depth().width(), image.depth().height());
        if size != (camera.width(), camera.height()) {
            let expected = format!("{} x {} as the camera", camera.width(), camera.height());
            return Err(Invalid::new("depth image size", format!("{} x {}", size.0, size.1), "px", expected));
        }
        if !<[f64; 7]>::from(*map_from_camera).iter().all(|number| number.is_finite()) {
            return Err(Invalid::new(
                "pose of the camera",
                format!("{map_from_camera:?}"),
                "m",
                "finite numbers",
            ));
        }
        let camera_from_map = map_from_camera.inverse();
        let mut view = Self {
            image,
            camera,
            is_distorted: camera.distortion() != Distortion::default(),
            intrinsics: [camera.fx(), camera.fy(), camera.cx(), camera.cy()].map(|value| value as f32),
            rotation: camera_from_map.rotation_matrix().cast(),
            translation: camera_from_map.transform(Vector3::zeros()).cast(),
            map_from_camera: *map_from_camera,
            depths: (config.min_depth as f32, config.max_depth as f32),
            tiles: Vec::new(),
            tile_columns: size.0.div_ceil(TILE_PX),
        };
        view.tiles = view.farthest_of_tiles();
        Ok(view)
    }

    /// The largest valid depth of each tile, m; 0 for none.
    fn farthest_of_tiles(&self) -> Vec<f32> {
        let depth = self.image.depth();
        let mut tiles = vec![0.0_f32; self.tile_columns * depth.height().div_ceil(TILE_PX)];
        for y in 0..depth.height() {
            let row = y / TILE_PX * self.tile_columns;
            for (x, &depth) in depth.row(y).iter().enumerate().filter(|(_, depth)| self.is_valid(**depth)) {
                let tile = &mut tiles[row + x / TILE_PX];
                *tile = tile.max(depth);
            }
        }
        tiles
    }

    fn is_valid(&self, depth: f32) -> bool {
        depth >= self.depths.0 && depth <= self.depths.1
    }

    /// A point of the map in the camera frame, m.
    pub(crate) fn in_camera(&self, point: Vector3<f32>) -> Vector3<f32> {
        self.rotation * point + self.translation
    }

    /// Points of the map, m, on the rays of every `stride`-th pixel, at the depths that `at` gives for the measured one.
    pub(crate) fn points<const N: usize>(
        &self,
        stride: usize,
        at: impl Fn(f32) -> [f32; N],
    ) -> impl Iterator<Item = [Vector3<f64>; N]> {
        let depth = self.image.depth();
        let pixels = (0..depth.height())
            .step_by(stride)
            .flat_map(move |y| (0..depth.width()).step_by(stride).map(move |x| (x, y)));
        let points = pixels.filter(move |&pixel| self.is_valid(depth[pixel])).map(move |(x, y)| {
            let rectified = self.camera.undistort(Vector2::new(x as f64, y as f64));
            at(depth[(x, y)]).map(|depth| {
                self.map_from_camera.transform(self.camera.unproject(rectified, f64::from(depth)))
            })
        });
        points.filter(|points| points.iter().all(|point| point.amax() <= MAX_COORDINATE_M))
    }

    /// The centre of the camera, map frame, m.
    pub(crate) fn centre(&self) -> Vector3<f64> {
        self.map_from_camera.transform(Vector3::zeros())
    }

    /// Whether the image may show a ball (camera frame, m), or points up to `behind` m behind a surface.
    pub(crate) fn may_show(&self, centre: Vector3<f32>, radius: f32, behind: f32) -> bool {
        let nearest = centre.z - radius;
        if centre.z + radius < self.depths.0 || nearest > self.depths.1 + behind {
            return false;
        }
        if nearest < self.depths.0 / 2.0 {
            return true;
        }
        let [fx, fy, cx, cy] = self.intrinsics;
        let tiles = |at: f32, focal: f32, offset: f32, count: usize| {
            let pixel = focal * at / centre.z + offset;
            let half = focal * radius / nearest;
            let low = (pixel - half) / TILE_PX as f32;
            let high = (pixel + half) / TILE_PX as f32;
            (low.max(0.0) as usize, (high.min(count as f32 - 1.0), count))
        };
        let rows = self.tiles.len() / self.tile_columns;
        let (left, (right, _)) = tiles(centre.x, fx, cx, self.tile_columns);
        let (top, (bottom, _)) = tiles(centre.y, fy, cy, rows);
        if right < 0.0 || bottom < 0.0 {
            return false;
        }
        let columns = left..(right as usize + 1).max(left);
        (top..(bottom as usize + 1).max(top)).any(|row| {
            columns.clone().any(|column| {
                let at = row * self.tile_columns + column;
                self.tiles.get(at).is_some_and(|&farthest| farthest > 0.0 && nearest <= farthest + behind)
            })
        })
    }

    /// The image at a point of the camera frame, m; `None` outside the image and without depth.
    #[inline]
    pub(crate) fn observe(&self, point: Vector3<f32>) -> Option<Observation> {
        if point.z <= 0.0 {
            return None;
        }
        let [fx, fy, cx, cy] = self.intrinsics;
        let inverse = 1.0 / point.z;
        let (mut x, mut y) = (fx * point.x * inverse + cx, fy * point.y * inverse + cy);
        if self.is_distorted {
            let raw = self.camera.distort(Vector2::new(f64::from(x), f64::from(y)));
            (x, y) = (raw.x as f32, raw.y as f32);
        }
        let depth = self.image.depth();
        if !(x > -0.5 && y > -0.5) {
            return None;
        }
        let (column, row) = ((x + 0.5) as usize, (y + 0.5) as usize);
        if column >= depth.width() || row >= depth.height() {
            return None;
        }
        let at = row * depth.width() + column;
        let depth = depth.data()[at];
        if !self.is_valid(depth) {
            return None;
        }
        let ratio = UNIT_WEIGHT_DEPTH_M * inverse;
        let weight = (ratio * ratio).clamp(1.0, MAX_OBSERVATION_WEIGHT) as u16;
        Some(Observation { depth, color: self.image.color().data()[at], weight })
    }
}
