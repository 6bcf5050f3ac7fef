//! The grid map of a camera that is not on a robot: scans levelled by the camera pose.

use crate::{camera_mount::CameraMount, schedule::Ticker};
use std::collections::BTreeMap;
use trundle_core::{
    Hypotenuse, Invalid, OccupancyGrid, PinholeCamera, Pose2, Pose3, RgbdImage, Scan, Stamp, Vector3,
};
use trundle_mapping::{DepthScanConfig, DepthScanner, GridMapper, MapperConfig};

/// A floor map of a camera that moves freely, hand-held or on a robot.
///
/// The visual frame must be level: z up, the floor at z = 0. Each scan is made from the height band by tilt and height of the image's pose.
/// The scans are kept, and drawn at the final poses.
#[derive(Debug)]
pub struct LevelMap {
    scanner: DepthScanner,
    due: Ticker,
    scans: BTreeMap<Stamp, Scan>,
}

impl LevelMap {
    /// An empty map, for at most `map_hz` scans per second.
    ///
    /// # Errors
    /// When the scan's configuration is not valid.
    pub fn new(camera: PinholeCamera, scan: DepthScanConfig, map_hz: f64) -> Result<Self, Invalid> {
        // The mount follows from each image; the default is a placeholder until the first one.
        let scanner = DepthScanner::new(camera, CameraMount::default().base_from_camera(), scan)?;
        Ok(Self { scanner, due: Ticker::new(map_hz), scans: BTreeMap::new() })
    }

    /// Keeps the scan of an image taken at `level_from_camera`. An image too soon after the last kept one is skipped. An image without a
    /// scan is skipped too: the camera points too steeply up or down, or is below the floor.
    pub fn note(&mut self, image: &RgbdImage, level_from_camera: Pose3) {
        let Some(base) = base_below(&level_from_camera) else { return };
        let base_from_camera = Pose3::from_pose2(base).inverse() * level_from_camera;
        if self.due.due(image.stamp()) && self.scanner.remount(base_from_camera).is_ok() {
            self.scans.insert(image.stamp(), self.scanner.scan(image));
        }
    }

    /// The grid of all scans, each at the pose that `trajectory` (level_from_camera) has for its stamp.
    ///
    /// # Errors
    /// When the map's configuration is not valid.
    pub fn grid(
        &self,
        trajectory: &[(Stamp, Pose3)],
        config: MapperConfig,
    ) -> Result<OccupancyGrid, Invalid> {
        Ok(self.mapper(trajectory, config)?.grid().clone())
    }

    /// A mapper with all scans, as [`LevelMap::grid`]: further scans may be inserted.
    ///
    /// # Errors
    /// When the map's configuration is not valid.
    pub fn mapper(&self, trajectory: &[(Stamp, Pose3)], config: MapperConfig) -> Result<GridMapper, Invalid> {
        let mut mapper = GridMapper::new(config)?;
        for (stamp, pose) in trajectory {
            if let (Some(scan), Some(base)) = (self.scans.get(stamp), base_below(pose)) {
                mapper.insert(base, scan);
            }
        }
        Ok(mapper)
    }

    /// The scan of a kept image, and `level_from_base` of a base below the camera's pose.
    #[must_use]
    pub fn scan_at(&self, stamp: Stamp, level_from_camera: &Pose3) -> Option<(Pose2, &Scan)> {
        Some((base_below(level_from_camera)?, self.scans.get(&stamp)?))
    }

    /// The scan of a kept image, in the frame of a base under the camera.
    #[must_use]
    pub fn scan(&self, stamp: Stamp) -> Option<&Scan> {
        self.scans.get(&stamp)
    }

    /// Distance within which the floor is not visible to the camera at its last pose, m.
    #[must_use]
    pub fn blind_range(&self) -> f64 {
        self.scanner.blind_range()
    }

    /// Number of scans.
    #[must_use]
    pub fn scan_count(&self) -> usize {
        self.scans.len()
    }
}

/// The level pose of a first camera at `height` m above the floor, tilted down by `tilt_deg` and rolled to its right
/// around the optical axis by `roll_deg`.
///
/// # Errors
/// When a number is outside the range of [`CameraMount`].
pub fn level_from_first_camera(height: f64, tilt_deg: f64, roll_deg: f64) -> Result<Pose3, Invalid> {
    let mount = CameraMount { x: 0.0, y: 0.0, z: height, yaw_deg: 0.0, pitch_deg: tilt_deg, roll_deg };
    Ok(mount.validated()?.base_from_camera())
}

/// Angle between the optical axis and the vertical \[deg\]. Below it the camera has no heading. Source: ours.
const MIN_AXIS_TILT_DEG: f64 = 20.0;

/// `level_from_base` of a base under the camera at `level_from_camera`, with the heading of the optical axis; `None` if the axis is nearly
/// vertical.
#[must_use]
pub fn base_below(level_from_camera: &Pose3) -> Option<Pose2> {
    let axis = level_from_camera.rotate(Vector3::z());
    let flat = axis.x.hypotenuse(axis.y);
    let at = level_from_camera.translation;
    (flat > MIN_AXIS_TILT_DEG.to_radians().sin()).then(|| Pose2::new(at.x, at.y, axis.y.atan2(axis.x)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{Cell, DepthImage, Image, Vector2};

    #[test]
    fn the_base_stands_under_the_camera() {
        let pose = level_from_first_camera(1.2, 30.0, 10.0).unwrap();
        assert_eq!(base_below(&pose), Some(Pose2::IDENTITY));
        assert_eq!(base_below(&level_from_first_camera(1.2, 75.0, 0.0).unwrap()), None);
        assert!(level_from_first_camera(f64::NAN, 0.0, 0.0).is_err());
    }

    /// A wall 2.02 m ahead of a level camera, 0.4 m above the floor.
    fn wall(time: f64) -> RgbdImage {
        let camera = PinholeCamera::kinect_v2();
        let (width, height) = (camera.width(), camera.height());
        let depth = DepthImage::from_fn(width, height, |_, row| {
            let below = (row as f64 - camera.cy()) / camera.fy();
            if below > 0.0 { (0.4 / below).min(2.02) as f32 } else { 2.02 }
        });
        RgbdImage::new(Stamp::default().after(time), Image::filled(width, height, [90; 3]), depth).unwrap()
    }

    fn level_map() -> LevelMap {
        LevelMap::new(PinholeCamera::kinect_v2(), DepthScanConfig::default(), 5.0).unwrap()
    }

    #[test]
    fn a_scan_is_drawn_where_the_final_trajectory_has_its_image() {
        let (mut map, at_first) = (level_map(), level_from_first_camera(0.4, 0.0, 0.0).unwrap());
        // A single hit is no obstacle.
        let times = [0.0, 0.25, 0.5, 0.75];
        times.iter().for_each(|time| map.note(&wall(*time), at_first));
        for pose in [Pose2::IDENTITY, Pose2::new(1.0, -0.5, 0.0), Pose2::new(0.5, 1.0, 2.0)] {
            let at = |time: f64, pose| (Stamp::default().after(time), Pose3::from_pose2(pose) * at_first);
            let mut trajectory: Vec<_> = times.iter().map(|time| at(*time, pose)).collect();
            trajectory.push(at(9.0, Pose2::new(50.0, 0.0, 0.0)));
            let grid = map.grid(&trajectory, MapperConfig::default()).unwrap();
            assert_eq!(grid.at(pose.transform(Vector2::new(2.02, 0.0))), Cell::Occupied, "{pose:?}");
            assert_eq!(grid.at(pose.transform(Vector2::new(1.2, 0.0))), Cell::Free, "{pose:?}");
            assert!(grid.geometry().cell_at(Vector2::new(52.0, 0.0)).is_none(), "an image without a scan");
        }
    }

    #[test]
    fn images_in_quick_succession_and_of_a_steep_camera_are_left_out() {
        let (mut map, level) = (level_map(), level_from_first_camera(0.4, 0.0, 0.0).unwrap());
        (0..30).for_each(|i| map.note(&wall(f64::from(i) / 30.0), level));
        assert_eq!(map.scans.len(), 5);
        let mut steep = level_map();
        steep.note(&wall(0.0), level_from_first_camera(1.2, 75.0, 0.0).unwrap());
        assert!(steep.scans.is_empty());
    }
}
