//! The functions of OrbbecSDK that are used. Source: its public headers `libobsensor/h/*.h`, version 2.

use crate::camera::CameraError;
use crate::camera::native::library::functions::functions;
use crate::camera::native::library::{LibrarySpec, LibraryVersion, NativeLibrary, WheelFile};
use std::ffi::{c_char, c_float, c_int};

/// Specification of OrbbecSDK.
pub const LIBRARY: LibrarySpec = LibrarySpec {
    name: "OrbbecSDK",
    variable: "TRUNDLE_ORBBEC_LIB",
    sonames: &["libOrbbecSDK.so.2"],
    wheel: Some(WheelFile { folder: "pyorbbecsdk", prefix: "libOrbbecSDK.so.2" }),
    from: LibraryVersion::new(2, 0, 0),
    below: LibraryVersion::new(3, 0, 0),
    remedy: "run 'python3 -m pip install --user pyorbbecsdk2' and set TRUNDLE_PYTHON_WHEELS=python3, or install OrbbecSDK 2 from \
        https://github.com/orbbec/OrbbecSDK_v2, or name its file in TRUNDLE_ORBBEC_LIB",
};

macro_rules! opaque {
    ($($(#[$meta:meta])* $name:ident;)*) => {$(
        $(#[$meta])*
        #[repr(C)]
        #[derive(Debug)]
        pub struct $name {
            _private: [u8; 0],
        }
    )*};
}

opaque! {
    /// `ob_error`.
    RawError;
    /// `ob_context`.
    Context;
    /// `ob_device_list`.
    DeviceList;
    /// `ob_device`.
    Device;
    /// `ob_pipeline`.
    Pipeline;
    /// `ob_config`.
    Config;
    /// `ob_frame`.
    Frame;
    /// `ob_stream_profile`.
    Profile;
}

/// Pointer through which a function returns its error.
pub(super) type ErrorOut = *mut *mut RawError;

/// `ob_camera_intrinsic`.
#[repr(C, packed)]
#[derive(Debug, Clone, Copy, Default)]
pub struct Intrinsic {
    /// Focal length across \[px\].
    pub fx: c_float,
    /// Focal length down \[px\].
    pub fy: c_float,
    /// Column of the principal point \[px\].
    pub cx: c_float,
    /// Row of the principal point \[px\].
    pub cy: c_float,
    /// Columns \[px\].
    pub width: i16,
    /// Rows \[px\].
    pub height: i16,
}

/// `ob_camera_distortion`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct LensDistortion {
    /// k1 to k6.
    pub k: [c_float; 6],
    /// p1 and p2.
    pub p: [c_float; 2],
    /// `ob_camera_distortion_model`.
    pub model: c_int,
}

/// `ob_extrinsic`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct Extrinsic {
    /// Rotation, row by row.
    pub rotation: [c_float; 9],
    /// Translation \[mm\].
    pub translation: [c_float; 3],
}

// The functions return these structures by value: their sizes are part of the interface.
const _: () = assert!(
    size_of::<Intrinsic>() == 20 && size_of::<LensDistortion>() == 36 && size_of::<Extrinsic>() == 48
);

functions! {
    /// The functions of OrbbecSDK. `ob_delete_error` is left out: its argument differs between versions 2.x. An error is some 800 bytes.
    pub struct OrbbecApi {
        fn ob_get_version() -> c_int;
        fn ob_error_get_message(*const RawError) -> *const c_char;
        fn ob_error_get_function(*const RawError) -> *const c_char;
        fn ob_error_get_exception_type(*const RawError) -> c_int;
        fn ob_set_logger_severity(c_int, ErrorOut);
        fn ob_set_extensions_directory(*const c_char, ErrorOut);
        fn ob_create_context(ErrorOut) -> *mut Context;
        fn ob_delete_context(*mut Context, ErrorOut);
        fn ob_enable_net_device_enumeration(*mut Context, bool, ErrorOut);
        fn ob_query_device_list(*mut Context, ErrorOut) -> *mut DeviceList;
        fn ob_delete_device_list(*mut DeviceList, ErrorOut);
        fn ob_device_list_get_count(*const DeviceList, ErrorOut) -> u32;
        fn ob_device_list_get_device_name(*const DeviceList, u32, ErrorOut) -> *const c_char;
        fn ob_device_list_get_device_serial_number(*const DeviceList, u32, ErrorOut) -> *const c_char;
        fn ob_device_list_get_device_connection_type(*const DeviceList, u32, ErrorOut) -> *const c_char;
        fn ob_device_list_get_device(*const DeviceList, u32, ErrorOut) -> *mut Device;
        fn ob_delete_device(*mut Device, ErrorOut);
        fn ob_create_pipeline_with_device(*const Device, ErrorOut) -> *mut Pipeline;
        fn ob_delete_pipeline(*mut Pipeline, ErrorOut);
        fn ob_pipeline_enable_frame_sync(*mut Pipeline, ErrorOut);
        fn ob_pipeline_start_with_config(*mut Pipeline, *const Config, ErrorOut);
        fn ob_pipeline_stop(*mut Pipeline, ErrorOut);
        fn ob_pipeline_wait_for_frameset(*mut Pipeline, u32, ErrorOut) -> *mut Frame;
        fn ob_create_config(ErrorOut) -> *mut Config;
        fn ob_delete_config(*mut Config, ErrorOut);
        fn ob_config_enable_video_stream(*mut Config, c_int, u32, u32, u32, c_int, ErrorOut);
        fn ob_delete_frame(*mut Frame, ErrorOut);
        fn ob_frameset_get_color_frame(*const Frame, ErrorOut) -> *mut Frame;
        fn ob_frameset_get_depth_frame(*const Frame, ErrorOut) -> *mut Frame;
        fn ob_frame_get_format(*const Frame, ErrorOut) -> c_int;
        fn ob_frame_get_timestamp_us(*const Frame, ErrorOut) -> u64;
        fn ob_frame_get_data(*const Frame, ErrorOut) -> *mut u8;
        fn ob_frame_get_data_size(*const Frame, ErrorOut) -> u32;
        fn ob_video_frame_get_width(*const Frame, ErrorOut) -> u32;
        fn ob_video_frame_get_height(*const Frame, ErrorOut) -> u32;
        fn ob_depth_frame_get_value_scale(*const Frame, ErrorOut) -> c_float;
        fn ob_frame_get_stream_profile(*const Frame, ErrorOut) -> *mut Profile;
        fn ob_delete_stream_profile(*mut Profile, ErrorOut);
        fn ob_video_stream_profile_get_fps(*const Profile, ErrorOut) -> u32;
        fn ob_video_stream_profile_get_intrinsic(*const Profile, ErrorOut) -> Intrinsic;
        fn ob_video_stream_profile_get_distortion(*const Profile, ErrorOut) -> LensDistortion;
        fn ob_stream_profile_get_extrinsic_to(*const Profile, *mut Profile, ErrorOut) -> Extrinsic;
    }
}

impl OrbbecApi {
    pub(super) fn new(library: NativeLibrary) -> Result<Self, CameraError> {
        Self::from_library(library)
    }
}
