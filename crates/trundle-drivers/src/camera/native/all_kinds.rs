//! Reports, lists and cameras of all kinds, with default settings.

use super::freenect::{self, FreenectApi, FreenectCamera, FreenectSettings};
use super::openni2::{self, OpenNiApi, OpenNiCamera, OpenNiSettings};
use super::orbbec::{self, OrbbecApi, OrbbecCamera, OrbbecSettings};
use super::realsense::{self, RealSenseApi, RealSenseCamera, RealSenseSettings};
use super::{DeviceEntry, LibraryReport, NativeKind, Selection};
#[cfg(feature = "kinect2-usb")]
use crate::camera::kinect2::usb::{self, Kinect2UsbCamera, UsbApi};
use crate::camera::{CameraError, DepthCamera};

/// Whether the library of each kind is usable, in the order of [`NativeKind::ALL`].
pub fn reports() -> Vec<LibraryReport> {
    NativeKind::ALL.iter().copied().map(report).collect()
}

/// Whether the library of `kind` is usable.
pub fn report(kind: NativeKind) -> LibraryReport {
    match kind {
        NativeKind::RealSense => {
            let loaded = RealSenseApi::load(None).and_then(|api| Ok((api.file(), Some(api.version()?))));
            LibraryReport::new(&realsense::LIBRARY, loaded)
        }
        NativeKind::Freenect => {
            LibraryReport::new(&freenect::LIBRARY, FreenectApi::load(None).map(|api| (api.file(), None)))
        }
        NativeKind::Orbbec => {
            let loaded = OrbbecApi::load(None).map(|api| (api.file(), Some(api.version())));
            LibraryReport::new(&orbbec::LIBRARY, loaded)
        }
        NativeKind::OpenNi2 => {
            let loaded = OpenNiApi::load(None).map(|api| (api.file(), Some(api.version())));
            LibraryReport::new(&openni2::LIBRARY, loaded)
        }
        #[cfg(feature = "kinect2-usb")]
        NativeKind::Kinect2Usb => {
            let loaded = UsbApi::load(None).map(|api| (api.file(), Some(api.version())));
            LibraryReport::new(&usb::LIBRARY, loaded)
        }
    }
}

/// The connected cameras of `kind`.
///
/// # Errors
/// When the library is not usable, or it refuses.
pub fn list_devices(kind: NativeKind) -> Result<Vec<DeviceEntry>, CameraError> {
    match kind {
        NativeKind::RealSense => realsense::list_devices(&RealSenseApi::load(None)?),
        NativeKind::Freenect => freenect::list_devices(&FreenectApi::load(None)?),
        NativeKind::Orbbec => orbbec::list_devices(&OrbbecApi::load(None)?),
        NativeKind::OpenNi2 => openni2::list_devices(&OpenNiApi::load(None)?),
        #[cfg(feature = "kinect2-usb")]
        NativeKind::Kinect2Usb => usb::list_devices(&UsbApi::load(None)?),
    }
}

/// Opens a camera or recording of `kind` with default settings. A camera of OpenNI2 should run in a separate process: see
/// [`openni2::serve_openni`].
///
/// # Errors
/// When the library is not usable, or the camera cannot be opened.
pub fn open(kind: NativeKind, selection: &Selection) -> Result<Box<dyn DepthCamera>, CameraError> {
    Ok(match kind {
        NativeKind::RealSense => {
            let settings = RealSenseSettings::default();
            Box::new(RealSenseCamera::open(&RealSenseApi::load(None)?, selection, &settings)?)
        }
        NativeKind::Freenect => {
            let settings = FreenectSettings::default();
            Box::new(FreenectCamera::open(&FreenectApi::load(None)?, selection, &settings)?)
        }
        NativeKind::Orbbec => {
            let settings = OrbbecSettings::default();
            Box::new(OrbbecCamera::open(&OrbbecApi::load(None)?, selection, &settings)?)
        }
        NativeKind::OpenNi2 => {
            let settings = OpenNiSettings::default();
            Box::new(OpenNiCamera::open(&OpenNiApi::load(None)?, selection, &settings)?)
        }
        #[cfg(feature = "kinect2-usb")]
        NativeKind::Kinect2Usb => Box::new(Kinect2UsbCamera::open(&UsbApi::load(None)?, selection)?),
    })
}
