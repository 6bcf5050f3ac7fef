//! The functions of librealsense2 that are used. Source: documentation of the C API, headers `librealsense2/h/rs_*.h`, version 2.50 to 2.59.

use crate::camera::native::library::functions::functions;
use std::ffi::{c_char, c_double, c_float, c_int, c_uint, c_ulonglong, c_void};

/// An object of the library, of which only the address is known.
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
    /// `rs2_error`.
    RawError;
    /// `rs2_context`.
    Context;
    /// `rs2_device_list`.
    DeviceList;
    /// `rs2_device`.
    Device;
    /// `rs2_device_hub`.
    DeviceHub;
    /// `rs2_sensor_list`.
    SensorList;
    /// `rs2_sensor`.
    Sensor;
    /// `rs2_pipeline`.
    Pipeline;
    /// `rs2_pipeline_profile`.
    PipelineProfile;
    /// `rs2_config`.
    Config;
    /// `rs2_stream_profile_list`.
    ProfileList;
    /// `rs2_stream_profile`.
    Profile;
    /// `rs2_frame`.
    Frame;
    /// `rs2_frame_queue`.
    FrameQueue;
}

/// Pointer through which a function returns its error.
pub(super) type ErrorOut = *mut *mut RawError;

/// `rs2_frame_callback_ptr`: takes a frame, with the pointer given at the start.
pub(super) type FrameCallback = unsafe extern "C" fn(*mut Frame, *mut c_void);

/// `rs2_intrinsics`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Intrinsics {
    /// Columns \[px\].
    pub width: c_int,
    /// Rows \[px\].
    pub height: c_int,
    /// Column of the principal point \[px\].
    pub ppx: c_float,
    /// Row of the principal point \[px\].
    pub ppy: c_float,
    /// Focal length across \[px\].
    pub fx: c_float,
    /// Focal length down \[px\].
    pub fy: c_float,
    /// Distortion model, `rs2_distortion`.
    pub model: c_int,
    /// k1, k2, p1, p2, k3.
    pub coeffs: [c_float; 5],
}

/// `rs2_extrinsics`: a point of the first stream, in metres, moved into the second.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Extrinsics {
    /// Rotation, column by column.
    pub rotation: [c_float; 9],
    /// Translation \[m\].
    pub translation: [c_float; 3],
}

functions! {
    /// The functions of librealsense2.
    pub struct RealSenseApi {
        fn rs2_get_api_version(ErrorOut) -> c_int;
        fn rs2_get_error_message(*const RawError) -> *const c_char;
        fn rs2_get_failed_function(*const RawError) -> *const c_char;
        fn rs2_get_librealsense_exception_type(*const RawError) -> c_int;
        fn rs2_free_error(*mut RawError);
        fn rs2_create_context(c_int, ErrorOut) -> *mut Context;
        fn rs2_delete_context(*mut Context);
        fn rs2_query_devices(*const Context, ErrorOut) -> *mut DeviceList;
        fn rs2_get_device_count(*const DeviceList, ErrorOut) -> c_int;
        fn rs2_delete_device_list(*mut DeviceList);
        fn rs2_create_device(*const DeviceList, c_int, ErrorOut) -> *mut Device;
        fn rs2_delete_device(*mut Device);
        fn rs2_supports_device_info(*const Device, c_int, ErrorOut) -> c_int;
        fn rs2_get_device_info(*const Device, c_int, ErrorOut) -> *const c_char;
        fn rs2_create_device_hub(*const Context, ErrorOut) -> *mut DeviceHub;
        fn rs2_delete_device_hub(*mut DeviceHub);
        fn rs2_device_hub_is_device_connected(*const DeviceHub, *const Device, ErrorOut) -> c_int;
        fn rs2_query_sensors(*const Device, ErrorOut) -> *mut SensorList;
        fn rs2_get_sensors_count(*const SensorList, ErrorOut) -> c_int;
        fn rs2_delete_sensor_list(*mut SensorList);
        fn rs2_create_sensor(*const SensorList, c_int, ErrorOut) -> *mut Sensor;
        fn rs2_delete_sensor(*mut Sensor);
        fn rs2_is_sensor_extendable_to(*const Sensor, c_int, ErrorOut) -> c_int;
        fn rs2_get_depth_scale(*mut Sensor, ErrorOut) -> c_float;
        fn rs2_create_pipeline(*mut Context, ErrorOut) -> *mut Pipeline;
        fn rs2_delete_pipeline(*mut Pipeline);
        fn rs2_pipeline_stop(*mut Pipeline, ErrorOut);
        fn rs2_pipeline_start_with_config(*mut Pipeline, *mut Config, ErrorOut) -> *mut PipelineProfile;
        fn rs2_pipeline_start_with_config_and_callback(
            *mut Pipeline, *mut Config, FrameCallback, *mut c_void, ErrorOut,
        ) -> *mut PipelineProfile;
        fn rs2_create_frame_queue(c_int, ErrorOut) -> *mut FrameQueue;
        fn rs2_delete_frame_queue(*mut FrameQueue);
        fn rs2_enqueue_frame(*mut Frame, *mut c_void);
        fn rs2_try_wait_for_frame(*mut FrameQueue, c_uint, *mut *mut Frame, ErrorOut) -> c_int;
        fn rs2_pipeline_try_wait_for_frames(*mut Pipeline, *mut *mut Frame, c_uint, ErrorOut) -> c_int;
        fn rs2_delete_pipeline_profile(*mut PipelineProfile);
        fn rs2_pipeline_profile_get_device(*mut PipelineProfile, ErrorOut) -> *mut Device;
        fn rs2_pipeline_profile_get_streams(*mut PipelineProfile, ErrorOut) -> *mut ProfileList;
        fn rs2_delete_stream_profiles_list(*mut ProfileList);
        fn rs2_get_stream_profiles_count(*const ProfileList, ErrorOut) -> c_int;
        fn rs2_get_stream_profile(*const ProfileList, c_int, ErrorOut) -> *const Profile;
        fn rs2_get_stream_profile_data(
            *const Profile, *mut c_int, *mut c_int, *mut c_int, *mut c_int, *mut c_int, ErrorOut,
        );
        fn rs2_get_video_stream_intrinsics(*const Profile, *mut Intrinsics, ErrorOut);
        fn rs2_get_extrinsics(*const Profile, *const Profile, *mut Extrinsics, ErrorOut);
        fn rs2_create_config(ErrorOut) -> *mut Config;
        fn rs2_delete_config(*mut Config);
        fn rs2_config_enable_stream(*mut Config, c_int, c_int, c_int, c_int, c_int, c_int, ErrorOut);
        fn rs2_config_enable_device(*mut Config, *const c_char, ErrorOut);
        fn rs2_config_enable_device_from_file_repeat_option(*mut Config, *const c_char, c_int, ErrorOut);
        fn rs2_config_can_resolve(*mut Config, *mut Pipeline, ErrorOut) -> c_int;
        fn rs2_config_resolve(*mut Config, *mut Pipeline, ErrorOut) -> *mut PipelineProfile;
        fn rs2_playback_device_set_real_time(*const Device, c_int, ErrorOut);
        fn rs2_playback_device_pause(*const Device, ErrorOut);
        fn rs2_playback_device_resume(*const Device, ErrorOut);
        fn rs2_playback_device_get_current_status(*const Device, ErrorOut) -> c_int;
        fn rs2_release_frame(*mut Frame);
        fn rs2_is_frame_extendable_to(*const Frame, c_int, ErrorOut) -> c_int;
        fn rs2_embedded_frames_count(*mut Frame, ErrorOut) -> c_int;
        fn rs2_extract_frame(*mut Frame, c_int, ErrorOut) -> *mut Frame;
        fn rs2_get_frame_stream_profile(*const Frame, ErrorOut) -> *const Profile;
        fn rs2_get_frame_data(*const Frame, ErrorOut) -> *const c_void;
        fn rs2_get_frame_data_size(*const Frame, ErrorOut) -> c_int;
        fn rs2_get_frame_width(*const Frame, ErrorOut) -> c_int;
        fn rs2_get_frame_height(*const Frame, ErrorOut) -> c_int;
        fn rs2_get_frame_stride_in_bytes(*const Frame, ErrorOut) -> c_int;
        fn rs2_get_frame_number(*const Frame, ErrorOut) -> c_ulonglong;
        fn rs2_get_frame_timestamp(*const Frame, ErrorOut) -> c_double;
        fn rs2_get_frame_timestamp_domain(*const Frame, ErrorOut) -> c_int;
    }
}

impl RealSenseApi {
    pub(super) fn new(
        library: crate::camera::native::library::NativeLibrary,
    ) -> Result<Self, crate::camera::CameraError> {
        Self::from_library(library)
    }
}
