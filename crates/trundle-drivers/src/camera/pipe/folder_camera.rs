//! A camera whose images appear as files in a folder.

use super::camera_file::parse_header;
use super::folder_scan::{FilePair, FolderScan};
use crate::camera::{CameraError, CameraFrame, CameraInfo, DepthCamera, PixelFormat, RawImage};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use trundle_core::{Invalid, Stamp};

/// Wait between two lists of the folder \[ms\]. Source: ours; half of the time between frames at 30 Hz.
const SCAN_PERIOD_MS: u64 = 15;
/// Longest wait of an image for its partner \[ms\]. Source: ours; equal to the silence after which a camera counts as lost.
const MAX_PAIR_WAIT_MS: u64 = 1000;
/// Largest image file \[bytes\]: 256 MiB. Source: ours; an uncompressed image of the largest size.
const MAX_IMAGE_FILE_BYTES: u64 = 1 << 28;

/// Content of a folder.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct FolderCounts {
    /// Pairs delivered.
    pub frames: u64,
    /// Number of pairs dropped because one file did not arrive in time.
    pub dropped: u64,
}

/// A camera whose images appear as files `color/STAMP.png`, `color/STAMP.jpg` and `depth/STAMP.png` next to a file `camera.json`.
#[derive(Debug)]
pub struct FolderCamera {
    info: CameraInfo,
    folder: PathBuf,
    scan: FolderScan,
    scanned: Option<Instant>,
    frames: u64,
    has_ended: bool,
}

impl FolderCamera {
    /// Opens a folder with its `camera.json`. The folders of images may be empty.
    ///
    /// # Errors
    /// When a folder or `camera.json` is missing, or the file is not valid.
    pub fn open(folder: &Path) -> Result<Self, CameraError> {
        Self::with_pair_wait(folder, Duration::from_millis(MAX_PAIR_WAIT_MS))
    }

    /// As [`FolderCamera::open`], with the longest wait of an image for its partner.
    ///
    /// # Errors
    /// As [`FolderCamera::open`].
    pub fn with_pair_wait(folder: &Path, max_wait: Duration) -> Result<Self, CameraError> {
        let file = folder.join("camera.json");
        let place = file.display().to_string();
        let bytes = fs::read(&file).map_err(|source| CameraError::Io { place: place.clone(), source })?;
        let info = parse_header(&bytes).map_err(|problem| CameraError::BadHeader { place, problem })?;
        let scan = FolderScan::new(folder, max_wait);
        Ok(Self { info, folder: folder.to_owned(), scan, scanned: None, frames: 0, has_ended: false })
    }

    /// Pairs delivered and dropped so far.
    pub fn counts(&self) -> FolderCounts {
        FolderCounts { frames: self.frames, dropped: self.scan.dropped() }
    }

    fn read(&mut self, pair: &FilePair) -> Result<CameraFrame, CameraError> {
        self.frames += 1;
        let stamp = Stamp::from_nanos(pair.stamp_nanos);
        let size = (self.info.color.camera.width(), self.info.color.camera.height());
        let color = color_image(&pair.color, size, stamp)?;
        let size = (self.info.depth.camera.width(), self.info.depth.camera.height());
        let depth = RawImage::packed(PixelFormat::DepthPng16, size, bytes_of(&pair.depth)?, stamp);
        Ok(CameraFrame { color, depth })
    }

    /// Lists the folder, at most once in a period.
    fn rescan(&mut self) -> Result<(), CameraError> {
        let now = Instant::now();
        let period = Duration::from_millis(SCAN_PERIOD_MS);
        if let Some(scanned) = self.scanned {
            std::thread::sleep(period.saturating_sub(now.duration_since(scanned)));
        }
        let is_second = self.scanned.is_some();
        let place = || self.folder.display().to_string();
        self.scan.scan(Instant::now()).map_err(|source| CameraError::Io { place: place(), source })?;
        self.scanned = Some(Instant::now());
        self.has_ended = is_second && !self.info.is_live && self.scan.is_empty();
        Ok(())
    }
}

impl DepthCamera for FolderCamera {
    fn info(&self) -> &CameraInfo {
        &self.info
    }

    fn next_frame(&mut self, timeout: Duration) -> Result<Option<CameraFrame>, CameraError> {
        let deadline = Instant::now() + timeout;
        loop {
            if let Some(pair) = self.scan.take(Instant::now()) {
                return self.read(&pair).map(Some);
            }
            if self.has_ended || Instant::now() >= deadline {
                return Ok(None);
            }
            self.rescan()?;
        }
    }

    fn has_ended(&self) -> bool {
        self.has_ended
    }
}

/// A JPEG unchanged; a PNG decoded, because the pixel formats have no colour PNG.
fn color_image(path: &Path, size: (usize, usize), stamp: Stamp) -> Result<RawImage, CameraError> {
    let bytes = bytes_of(path)?;
    let is_png = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
    if !is_png {
        return Ok(RawImage::packed(PixelFormat::Mjpg, size, bytes, stamp));
    }
    let mut reader = image::ImageReader::with_format(std::io::Cursor::new(bytes), image::ImageFormat::Png);
    let mut limits = image::Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(size.0 as u32), Some(size.1 as u32));
    reader.limits(limits);
    let broken = |error: image::ImageError| {
        let expected = format!("a PNG of {} x {} px", size.0, size.1);
        Invalid::new(path.display().to_string(), format!("not readable ({error})"), "", expected)
    };
    let decoded = reader.decode().map_err(broken)?.into_rgb8();
    let found = (decoded.width() as usize, decoded.height() as usize);
    Ok(RawImage::packed(PixelFormat::Rgb8, found, decoded.into_raw(), stamp))
}

/// The bytes of a file. A file that vanished or cannot be read costs one frame, not the camera.
fn bytes_of(path: &Path) -> Result<Vec<u8>, CameraError> {
    let name = || path.display().to_string();
    let unreadable = |error: std::io::Error| {
        Invalid::new(name(), format!("not readable ({error})"), "", "an image file that stays in its place")
    };
    let length = fs::metadata(path).map_err(unreadable)?.len();
    if length > MAX_IMAGE_FILE_BYTES {
        return Err(Invalid::new(name(), length, "bytes", format!("at most {MAX_IMAGE_FILE_BYTES}")).into());
    }
    Ok(fs::read(path).map_err(unreadable)?)
}
