//! A simulated camera that writes its frames into a FIFO, in the format of `docs/camera-stream.md`.

use rustix::fs::{CWD, FileType, Mode, OFlags, fcntl_setfl, mknodat};
use std::fs::OpenOptions;
use std::os::unix::fs::{FileTypeExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;
use std::time::Duration;
use trundle_app::AppError;
use trundle_core::RgbdImage;
use trundle_drivers::camera::pipe::StreamWriter;
use trundle_drivers::camera::{CameraError, CameraFrame, CameraInfo, PixelFormat, RawImage, StreamInfo};
use trundle_sim::{DetachedCamera, Shot, SimConfig};

/// Length of a unit of depth \[m\]: a millimetre, as in depth cameras. Source: ours.
const DEPTH_UNIT_M: f64 = 0.001;
/// Time between two attempts to find a reader of the FIFO. Source: ours.
const READER_POLL: Duration = Duration::from_millis(20);

/// A simulated camera that writes its frames into a FIFO.
pub struct CameraServer {
    path: PathBuf,
    info: CameraInfo,
    shared: Arc<Shared>,
    shots: Option<SyncSender<Shot>>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Default)]
struct Shared {
    is_over: AtomicBool,
    images: AtomicU64,
    not_taken: AtomicU64,
}

/// Description of the simulated camera for a driver: depth registered to colour.
pub fn camera_info(config: &SimConfig) -> CameraInfo {
    let stream = |format| StreamInfo { format, camera: config.camera, rate_hz: config.camera_rate_hz };
    CameraInfo {
        name: "simulated camera".to_owned(),
        serial: String::new(),
        firmware: String::new(),
        usb: None,
        color: stream(PixelFormat::Rgb8),
        depth: stream(PixelFormat::Depth16),
        depth_unit_m: DEPTH_UNIT_M,
        color_from_depth: None,
        delay_s: 0.0,
        is_live: true,
    }
}

impl CameraServer {
    /// A server at the FIFO `path`, which is created if missing.
    ///
    /// # Errors
    /// When the FIFO cannot be created, or `path` is another kind of file.
    pub fn start(path: &Path, info: CameraInfo) -> Result<Self, AppError> {
        make_fifo(path)?;
        Ok(Self { path: path.to_owned(), info, shared: Arc::default(), shots: None, thread: None })
    }

    /// Starts the thread that takes and writes the images of `camera`.
    ///
    /// # Errors
    /// When the system refuses a thread.
    pub fn with_camera(mut self, camera: DetachedCamera) -> Result<Self, AppError> {
        let (shots, to_take) = sync_channel(1);
        let (path, info, shared) = (self.path.clone(), self.info.clone(), Arc::clone(&self.shared));
        let thread = std::thread::Builder::new()
            .name("camera".to_owned())
            .spawn(move || serve(camera, &to_take, &path, &info, &shared))
            .map_err(|error| AppError::Environment(format!("cannot start a thread: {error}")))?;
        (self.shots, self.thread) = (Some(shots), Some(thread));
        Ok(self)
    }

    /// Takes a shot; while the last one is in progress, the new one is dropped and counted.
    pub fn take(&mut self, shot: Shot) {
        if self.shots.as_ref().is_some_and(|shots| shots.try_send(shot).is_err()) {
            self.shared.not_taken.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Numbers of sent and of dropped images.
    pub fn counts(&self) -> (u64, u64) {
        (self.shared.images.load(Ordering::Relaxed), self.shared.not_taken.load(Ordering::Relaxed))
    }
}

impl Drop for CameraServer {
    fn drop(&mut self) {
        self.shared.is_over.store(true, Ordering::Relaxed);
        self.shots = None;
        // The thread may wait in a write, which ends when the reader closes the FIFO.
        if let Some(thread) = self.thread.take().filter(JoinHandle::is_finished) {
            let _ = thread.join();
        }
    }
}

fn make_fifo(path: &Path) -> Result<(), AppError> {
    let problem = |what: String| AppError::Input(format!("{}: {what}", path.display()));
    match std::fs::metadata(path) {
        Ok(there) if there.file_type().is_fifo() => Ok(()),
        Ok(_) => Err(problem("there is a file that is not a FIFO: name another path".to_owned())),
        Err(_) => mknodat(CWD, path, FileType::Fifo, Mode::RUSR | Mode::WUSR, 0)
            .map_err(|error| problem(format!("cannot create a FIFO: {error}"))),
    }
}

/// Takes images and writes them, to one reader after the other.
fn serve(
    mut camera: DetachedCamera,
    shots: &Receiver<Shot>,
    path: &Path,
    info: &CameraInfo,
    shared: &Shared,
) {
    let mut writer = None;
    for shot in shots {
        let image = match camera.take(&shot) {
            Ok(image) => image,
            Err(error) => {
                tracing::warn!("the simulated camera took no image: {error}");
                continue;
            }
        };
        if writer.is_none() {
            writer = open(path, info, shared);
        }
        let is_sent = writer.as_mut().is_some_and(|writer| writer.write(&frame(&image)).is_ok());
        if !is_sent {
            writer = None; // the reader is closed
        }
        let counter = if is_sent { &shared.images } else { &shared.not_taken };
        counter.fetch_add(1, Ordering::Relaxed);
    }
}

/// The FIFO with its header written; `None` without a reader.
fn open(path: &Path, info: &CameraInfo, shared: &Shared) -> Option<StreamWriter<std::fs::File>> {
    if shared.is_over.load(Ordering::Relaxed) {
        return None;
    }
    // Without a reader, a FIFO cannot be opened for writing without waiting.
    let Ok(file) = OpenOptions::new().write(true).custom_flags(nonblocking()).open(path) else {
        std::thread::sleep(READER_POLL);
        return None;
    };
    fcntl_setfl(&file, OFlags::empty()).ok()?;
    match StreamWriter::new(file, info) {
        Ok(writer) => Some(writer),
        Err(CameraError::Io { .. }) => None,
        Err(error) => {
            tracing::warn!("the stream of the simulated camera: {error}");
            None
        }
    }
}

fn nonblocking() -> i32 {
    OFlags::NONBLOCK.bits().cast_signed()
}

fn frame(image: &RgbdImage) -> CameraFrame {
    let size = (image.color().width(), image.color().height());
    let color = image.color().data().iter().flatten().copied().collect();
    let units =
        |depth: &f32| (f64::from(*depth) / DEPTH_UNIT_M).round().clamp(0.0, f64::from(u16::MAX)) as u16;
    let depth = image.depth().data().iter().flat_map(|depth| units(depth).to_le_bytes()).collect();
    let stamp = image.stamp();
    CameraFrame {
        color: RawImage::packed(PixelFormat::Rgb8, size, color, stamp),
        depth: RawImage::packed(PixelFormat::Depth16, size, depth, stamp),
    }
}
