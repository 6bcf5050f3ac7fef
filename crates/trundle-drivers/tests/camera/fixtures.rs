//! A small camera and its frames.

use trundle_core::{Distortion, PinholeCamera, Pose3, Stamp, Vector3};
use trundle_drivers::camera::{CameraFrame, CameraInfo, PixelFormat, RawImage, StreamInfo, UsbSpeed};

/// A lens of `width` x `height` px.
pub fn lens(width: usize, height: usize) -> PinholeCamera {
    let middle = ((width as f64 - 1.0) / 2.0, (height as f64 - 1.0) / 2.0);
    PinholeCamera::new((width, height), (width as f64, width as f64), middle, Distortion::default()).unwrap()
}

/// A live camera with RGB of 8 x 6 px, and depth in millimetres of 4 x 4 px at another place.
pub fn info() -> CameraInfo {
    let stream = |format, camera| StreamInfo { format, camera, rate_hz: 30.0 };
    CameraInfo {
        name: "test camera".into(),
        serial: "17".into(),
        firmware: "1.2".into(),
        usb: None,
        color: stream(PixelFormat::Rgb8, lens(8, 6)),
        depth: stream(PixelFormat::Depth16, lens(4, 4)),
        depth_unit_m: 0.001,
        color_from_depth: Some(Pose3::new(Default::default(), Vector3::new(0.05, 0.0, 0.0))),
        delay_s: 0.02,
        is_live: true,
    }
}

/// The same camera at USB 2.
pub fn slow_info() -> CameraInfo {
    CameraInfo { usb: Some(UsbSpeed::High), ..info() }
}

/// A frame of [`info`] whose bytes depend on `seed`.
pub fn frame(stamp: i64, seed: u8) -> CameraFrame {
    let stamp = Stamp::from_nanos(stamp);
    let color = (0..8 * 6 * 3).map(|i| (i as u8).wrapping_mul(7).wrapping_add(seed)).collect();
    let depth = (0..4 * 4).flat_map(|i| (1000u16 + 10 * i + seed as u16).to_le_bytes()).collect();
    CameraFrame {
        color: RawImage::packed(PixelFormat::Rgb8, (8, 6), color, stamp),
        depth: RawImage::packed(PixelFormat::Depth16, (4, 4), depth, stamp),
    }
}

/// Shortest time of ten runs \[ms\]; the others are longer because of other programs.
pub fn best_ms(mut run: impl FnMut()) -> f64 {
    let mut time = || {
        let started = std::time::Instant::now();
        run();
        started.elapsed().as_secs_f64() * 1e3
    };
    (0..10).map(|_| time()).fold(f64::INFINITY, f64::min)
}
