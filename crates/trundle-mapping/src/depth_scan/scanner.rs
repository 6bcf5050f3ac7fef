use super::{
    DepthScanConfig,
    height_gate::{Finding, HeightGate},
    pixel_rays::{LensRays, PixelRays},
    support::supported,
};
use trundle_core::{Beam, DepthImage, Invalid, PinholeCamera, Pose3, RgbdImage, Scan, Stamp, Vector2};

/// Makes scans of depth images: of each bearing the nearest point in the robot's height band (METHODS A2).
///
/// A pixel's bearing, climb and way over the floor for each metre of depth are fixed by the camera and its mount, so a
/// table of them turns a depth into range and height with two multiplications. Heights are along the base's z axis
/// (gravity), for any camera height, tilt and roll. Cost: one pass over the image.
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
    obstacles: Vec<(u32, f32)>,
    bearings: Vec<Bearing>,
}

/// What follows from where the camera sits.
#[derive(Debug, Clone)]
struct Mount {
    origin: Vector2,
    fan: PixelRays,
    gate: HeightGate,
    blind_range: f64,
}

/// What has been found along one bearing.
#[derive(Debug, Clone, Copy)]
struct Bearing {
    nearest: f32,
    clear: f32,
    sum: f64,
    count: u32,
}

impl Bearing {
    const EMPTY: Self = Self { nearest: f32::INFINITY, clear: 0.0, sum: 0.0, count: 0 };

    fn beam(&self) -> Beam {
        if self.count > 0 {
            Beam::Hit { range: self.sum / f64::from(self.count) }
        } else if self.clear > 0.0 {
            Beam::Free { range: f64::from(self.clear) }
        } else {
            Beam::Unseen
        }
    }
}

/// Free space is not followed more finely than this, m.
const CLEAR_STEP: f32 = 0.02;
/// Points count as one surface when their depths differ by fewer noises than this.
const SURFACE_SIGMAS: f32 = 4.0;
/// Or by less than this, m.
const SURFACE_LEAST: f32 = 0.03;

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
        let (width, height) = lens.image_size();
        Ok(Self { obstacles: Vec::with_capacity(width * height), bearings: Vec::new(), config, lens, mount })
    }

    /// Moves the camera to `base_from_camera`: for a hand-held one, or a mount that was measured anew.
    ///
    /// # Errors
    /// When the mount is not finite or the camera is not above the floor; then it stays where it was.
    pub fn remount(&mut self, base_from_camera: Pose3) -> Result<(), Invalid> {
        self.mount = Mount::new(&self.lens, &base_from_camera, &self.config)?;
        Ok(())
    }

    /// The scan of an image: base frame, from the camera's place on the floor, beams at equal angles across the field
    /// of view, about as many as columns.
    ///
    /// A beam is a hit at the nearest surface in the height band; else free as far as the floor, or anything above or
    /// behind the band, was truly seen through it; else unseen: a missing depth is never free space. An image of
    /// another size than the camera's is unseen altogether.
    pub fn scan(&mut self, image: &RgbdImage) -> Scan {
        self.bearings.clear();
        self.bearings.resize(self.mount.fan.beams, Bearing::EMPTY);
        self.obstacles.clear();
        let depth = image.depth();
        if (depth.width(), depth.height()) == self.lens.image_size() {
            self.sort_pixels(depth);
            self.average_surfaces();
        }
        self.to_scan(image.stamp())
    }

    /// Over the floor from the camera, m: what is nearer may be too near for the depth camera, or so low that it hides
    /// under the field of view; a beam that passes over it proves nothing. For `MapperConfig::blind_range`.
    pub fn blind_range(&self) -> f64 {
        self.mount.blind_range
    }

    fn sort_pixels(&mut self, depth: &DepthImage) {
        let (nearest_depth, farthest_depth) = (self.config.min_depth as f32, self.config.max_depth as f32);
        for (i, (&z, ray)) in depth.data().iter().zip(&self.mount.fan.rays).enumerate() {
            if !(z >= nearest_depth && z <= farthest_depth) {
                continue;
            }
            let bearing = &mut self.bearings[ray.beam as usize];
            match self.mount.gate.judge(ray, z) {
                Finding::Obstacle(range) => {
                    self.obstacles.push((ray.beam, range));
                    let window = || surface_window(&self.mount.gate, z);
                    if range < bearing.nearest && supported(depth, i, window(), self.config.hit_support_px) {
                        bearing.nearest = range;
                    }
                }
                Finding::Clear(range) => {
                    let window = || surface_window(&self.mount.gate, z);
                    if range > bearing.clear + CLEAR_STEP
                        && supported(depth, i, window(), self.config.free_support_px)
                    {
                        bearing.clear = range;
                    }
                }
                Finding::Nothing => {}
            }
        }
    }

    /// The nearest of many noisy points is too near: the range is the mean of the surface that it belongs to.
    fn average_surfaces(&mut self) {
        for &(beam, range) in &self.obstacles {
            let bearing = &mut self.bearings[beam as usize];
            if range >= bearing.nearest
                && range <= bearing.nearest + surface_window(&self.mount.gate, bearing.nearest)
            {
                bearing.sum += f64::from(range);
                bearing.count += 1;
            }
        }
    }

    fn to_scan(&self, stamp: Stamp) -> Scan {
        let beams = self.bearings.iter().map(Bearing::beam).collect();
        Scan::new(stamp, self.mount.origin, self.mount.fan.angle_min, self.mount.fan.angle_increment, beams)
            .expect("invariant: ranges come from finite depths and rays")
    }
}

impl Mount {
    fn new(lens: &LensRays, base_from_camera: &Pose3, config: &DepthScanConfig) -> Result<Self, Invalid> {
        if !base_from_camera.is_finite() {
            return Err(Invalid::new("base_from_camera", "not finite", "", "finite numbers"));
        }
        let position = base_from_camera.translation;
        trundle_core::require_positive("camera height above the floor", position.z, "m")?;
        let fan = PixelRays::new(lens, base_from_camera, config.band_high);
        Ok(Self {
            origin: position.xy(),
            gate: HeightGate::new(config, position.z),
            blind_range: blind_range(&fan, config, position.z),
            fan,
        })
    }
}

fn surface_window(gate: &HeightGate, depth: f32) -> f32 {
    (SURFACE_SIGMAS * gate.depth_noise(depth)).max(SURFACE_LEAST)
}

/// The range from which on every bearing that sees the band's lower edge at all sees it.
fn blind_range(fan: &PixelRays, config: &DepthScanConfig, camera_height: f64) -> f64 {
    let mut first = vec![f64::INFINITY; fan.beams];
    for ray in &fan.rays {
        let drop = (camera_height - config.band_low).max(0.0);
        if ray.rise < 0.0 {
            let depth = (drop / f64::from(-ray.rise)).max(config.min_depth);
            let beam = &mut first[ray.beam as usize];
            *beam = beam.min(depth * f64::from(ray.run));
        }
    }
    let seen = first.into_iter().filter(|range| range.is_finite());
    seen.reduce(f64::max).unwrap_or(config.max_range).min(config.max_range)
}
