//! Scan from a depth image.

use super::{
    DepthScanConfig, FloorFit,
    bearings::Bearings,
    mount::Mount,
    pixel_model::PixelModel,
    pixel_rays::LensRays,
    pixel_row::{ClassifiedRow, RowInput},
};
use trundle_core::{DepthImage, Invalid, PinholeCamera, Pose3, RgbdImage, Scan, ScanParts, Stamp, Vector2};

/// Converts depth images to scans: for each bearing the nearest obstacle in the robot's height band (docs/methods.md A2), and the free
/// spans in front of and behind it.
///
/// The camera and its mount determine a pixel's bearing. A pixel's height and distance over the floor are its depth times constant factors.
/// Heights are along the base's z axis (gravity), above the floor plane fitted to the image, or above the nominal floor if too little floor
/// is visible. Camera height, tilt and roll may be any. Cost: one pass over the image, vectorised on processors with AVX2. After the first
/// image, no memory is allocated.
///
/// | symbol | here | unit |
/// |---|---|---|
/// | noise of a depth z | `noise_base + noise_growth z^2` | m |
/// | highest point that may be floor, at range r | `max(band_low, floor_sigmas * noise * slope + r tan(tilt_error))` | m |
/// | points averaged behind the nearest | within 4 noises, at least 0.03 m | m |
#[derive(Debug, Clone)]
pub struct DepthScanner {
    config: DepthScanConfig,
    lens: LensRays,
    mount: Mount,
    floor: Option<FloorFit>,
    row: ClassifiedRow,
    bearings: Bearings,
}

impl DepthScanner {
    /// A scanner for `camera` (raw pixels: its lens distortion is undone) mounted at `base_from_camera`.
    ///
    /// # Errors
    /// When the configuration is out of range, the mount is not finite, or the camera is not above the floor.
    pub fn new(
        camera: PinholeCamera,
        base_from_camera: Pose3,
        config: DepthScanConfig,
    ) -> Result<Self, Invalid> {
        let config = config.validated()?;
        let lens = LensRays::new(camera);
        let mount = Mount::new(&lens, &base_from_camera, &config)?;
        let mut row = ClassifiedRow::default();
        row.resize(camera.width());
        let mut bearings = Bearings::default();
        bearings.reserve(lens.len());
        Ok(Self { row, bearings, config, lens, mount, floor: None })
    }

    /// Moves the camera to `base_from_camera`: for a hand-held camera, or a mount with a new calibration.
    ///
    /// # Errors
    /// When the mount is not finite or the camera is not above the floor; the mount is then unchanged.
    pub fn remount(&mut self, base_from_camera: Pose3) -> Result<(), Invalid> {
        self.mount = Mount::new(&self.lens, &base_from_camera, &self.config)?;
        Ok(())
    }

    /// The scan of an image: base frame, origin below the camera on the floor, beams at equal angles across the field of view, about one
    /// per column.
    ///
    /// A beam is a hit at the nearest surface in the height band, or at the nearest edge of a hole. Without a hit, a beam is free up to the
    /// end of the visible floor. At ranges without visible floor, it is free up to the end of the rays that passed through the band. All
    /// other beams are unseen. The free spans have gaps at ranges without visible floor or passing rays: a missing depth is never free
    /// space. The sigma of a beam grows with the square of the depth. A scan of an image with a wrong size is completely unseen.
    pub fn scan(&mut self, image: &RgbdImage) -> Scan {
        let mut scan = nothing(image.stamp());
        self.scan_into(image, &mut scan);
        scan
    }

    /// [`DepthScanner::scan`] with reuse of an old scan's memory.
    pub fn scan_into(&mut self, image: &RgbdImage, scan: &mut Scan) {
        let mut parts = std::mem::replace(scan, nothing(image.stamp())).into_parts();
        self.bearings.reset(self.mount.fan.beams);
        self.floor = None;
        let mut model = self.mount.model;
        let depth = image.depth();
        if (depth.width(), depth.height()) == self.lens.image_size() {
            self.floor = self.mount.samples.fit(depth, &model);
            model = self.floor.map_or(model, |floor| model.above(&floor));
            if self.mount.passes_matter {
                self.classify_rows::<true>(depth, &model);
            } else {
                self.classify_rows::<false>(depth, &model);
            }
            self.bearings.average_surfaces(&model);
        }
        self.bearings.write_parts(&self.mount, &model, &mut parts);
        let angles = (self.mount.fan.angle_min, self.mount.fan.angle_increment);
        *scan = Scan::from_parts(image.stamp(), self.mount.origin, angles, parts)
            .expect("invariant: ranges come from finite depths and rays, spans from rising bins");
    }

    /// Distance over the floor from the camera, m, below which a beam does not prove free space: an obstacle may be too near for the depth
    /// camera, or below its field of view. Use it for `MapperConfig::blind_range`.
    pub fn blind_range(&self) -> f64 {
        self.mount.blind_range
    }

    /// The floor fitted to the last image; `None` if no floor was found and the mount's floor was used.
    pub fn floor(&self) -> Option<FloorFit> {
        self.floor
    }

    fn classify_rows<const PASSES: bool>(&mut self, depth: &DepthImage, model: &PixelModel) {
        let width = depth.width();
        for y in 1..depth.height().saturating_sub(1) {
            let (u, v) = self.lens.row(y);
            let depths = [depth.row(y - 1), depth.row(y), depth.row(y + 1)];
            self.row.classify::<PASSES>(model, &RowInput { depths, u, v });
            self.bearings.add_row(&self.row, &self.mount.fan.beam_of[y * width..(y + 1) * width]);
        }
    }
}

/// A scan without beams.
fn nothing(stamp: Stamp) -> Scan {
    Scan::from_parts(stamp, Vector2::zeros(), (0.0, 1.0), ScanParts::default())
        .expect("invariant: no beam can be wrong")
}
