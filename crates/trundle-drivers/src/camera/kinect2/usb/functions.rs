//! The functions and structures of libusb that are used. Source: its public header `libusb.h`, API documentation of version 1.0.

use crate::camera::CameraError;
use crate::camera::native::library::functions::functions;
use crate::camera::native::library::{LibrarySpec, LibraryVersion, NativeLibrary};
use std::ffi::{c_char, c_int, c_uint, c_void};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Specification of libusb. Versions before 1.0.20 limit isochronous packets to 192 bytes.
pub const LIBRARY: LibrarySpec = LibrarySpec {
    name: "libusb-1.0",
    variable: "TRUNDLE_LIBUSB_LIB",
    sonames: &["libusb-1.0.so.0"],
    wheel: None,
    from: LibraryVersion::new(1, 0, 20),
    below: LibraryVersion::new(2, 0, 0),
    remedy: "run 'sudo apt install libusb-1.0-0' to install it, or name its file in TRUNDLE_LIBUSB_LIB",
};

/// `libusb_context`.
#[repr(C)]
#[derive(Debug)]
pub struct UsbContext {
    _private: [u8; 0],
}

/// `libusb_device`.
#[repr(C)]
#[derive(Debug)]
pub struct UsbDevice {
    _private: [u8; 0],
}

/// `libusb_device_handle`.
#[repr(C)]
#[derive(Debug)]
pub struct UsbHandle {
    _private: [u8; 0],
}

/// `libusb_version`.
#[repr(C)]
#[derive(Debug)]
pub struct UsbVersion {
    pub(super) major: u16,
    pub(super) minor: u16,
    pub(super) micro: u16,
    nano: u16,
    release: *const c_char,
    text: *const c_char,
}

/// `libusb_device_descriptor`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct DeviceDescriptor {
    length: u8,
    kind: u8,
    usb: u16,
    class: u8,
    subclass: u8,
    protocol: u8,
    max_packet: u8,
    pub(super) vendor: u16,
    pub(super) product: u16,
    release: u16,
    manufacturer_text: u8,
    product_text: u8,
    pub(super) serial_text: u8,
    configurations: u8,
}

/// `libusb_iso_packet_descriptor`.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct IsoPacket {
    pub(super) length: c_uint,
    pub(super) actual_length: c_uint,
    pub(super) status: c_int,
}

/// `libusb_transfer_cb_fn`.
pub type TransferCallback = unsafe extern "C" fn(*mut UsbTransfer);

/// `libusb_transfer`. The library allocates it, with space for the packets after its end.
#[repr(C)]
#[derive(Debug)]
pub struct UsbTransfer {
    pub(super) handle: *mut UsbHandle,
    flags: u8,
    pub(super) endpoint: u8,
    pub(super) kind: u8,
    pub(super) timeout_ms: c_uint,
    pub(super) status: c_int,
    pub(super) length: c_int,
    pub(super) actual_length: c_int,
    pub(super) callback: Option<TransferCallback>,
    pub(super) user_data: *mut c_void,
    pub(super) buffer: *mut u8,
    pub(super) packet_count: c_int,
    pub(super) packets: [IsoPacket; 0],
}

functions! {
    /// The functions of libusb.
    pub struct UsbApi {
        fn libusb_get_version() -> *const UsbVersion;
        fn libusb_init(*mut *mut UsbContext) -> c_int;
        fn libusb_exit(*mut UsbContext);
        fn libusb_error_name(c_int) -> *const c_char;
        fn libusb_get_device_list(*mut UsbContext, *mut *mut *mut UsbDevice) -> isize;
        fn libusb_free_device_list(*mut *mut UsbDevice, c_int);
        fn libusb_get_device_descriptor(*mut UsbDevice, *mut DeviceDescriptor) -> c_int;
        fn libusb_get_device_speed(*mut UsbDevice) -> c_int;
        fn libusb_get_string_descriptor_ascii(*mut UsbHandle, u8, *mut u8, c_int) -> c_int;
        fn libusb_open(*mut UsbDevice, *mut *mut UsbHandle) -> c_int;
        fn libusb_close(*mut UsbHandle);
        fn libusb_get_configuration(*mut UsbHandle, *mut c_int) -> c_int;
        fn libusb_set_configuration(*mut UsbHandle, c_int) -> c_int;
        fn libusb_claim_interface(*mut UsbHandle, c_int) -> c_int;
        fn libusb_release_interface(*mut UsbHandle, c_int) -> c_int;
        fn libusb_set_interface_alt_setting(*mut UsbHandle, c_int, c_int) -> c_int;
        fn libusb_control_transfer(*mut UsbHandle, u8, u8, u16, u16, *mut u8, u16, c_uint) -> c_int;
        fn libusb_bulk_transfer(*mut UsbHandle, u8, *mut u8, c_int, *mut c_int, c_uint) -> c_int;
        fn libusb_alloc_transfer(c_int) -> *mut UsbTransfer;
        fn libusb_free_transfer(*mut UsbTransfer);
        fn libusb_submit_transfer(*mut UsbTransfer) -> c_int;
        fn libusb_cancel_transfer(*mut UsbTransfer) -> c_int;
        fn libusb_handle_events_timeout_completed(*mut UsbContext, *mut libc::timeval, *mut c_int) -> c_int;
    }
}

impl UsbApi {
    /// Loads the library; `setting` is its file in the settings, if given.
    ///
    /// # Errors
    /// When the library is missing, broken, lacks functions, or has a version that does not suit.
    pub fn load(setting: Option<&Path>) -> Result<Arc<Self>, CameraError> {
        let api = Self::from_library(NativeLibrary::load(LIBRARY, setting)?)?;
        api.library.check_version(api.version())?;
        Ok(Arc::new(api))
    }

    /// File of the library.
    pub fn file(&self) -> PathBuf {
        self.library.path_of(self.libusb_init as *const ())
    }
}

#[cfg(all(test, target_pointer_width = "64"))]
mod tests {
    use super::*;
    use std::mem::{offset_of, size_of};

    /// Offsets on Linux with 64 bits, by the rules of the System V ABI from the order of the fields in `libusb.h`.
    #[test]
    fn the_structures_have_the_layout_of_the_header() {
        let transfer = [
            offset_of!(UsbTransfer, endpoint),
            offset_of!(UsbTransfer, kind),
            offset_of!(UsbTransfer, timeout_ms),
            offset_of!(UsbTransfer, status),
            offset_of!(UsbTransfer, length),
            offset_of!(UsbTransfer, actual_length),
            offset_of!(UsbTransfer, callback),
            offset_of!(UsbTransfer, user_data),
            offset_of!(UsbTransfer, buffer),
            offset_of!(UsbTransfer, packet_count),
            offset_of!(UsbTransfer, packets),
        ];
        assert_eq!(transfer, [9, 10, 12, 16, 20, 24, 32, 40, 48, 56, 60]);
        assert_eq!((size_of::<UsbTransfer>(), size_of::<IsoPacket>()), (64, 12));
        assert_eq!(size_of::<DeviceDescriptor>(), 18);
        assert_eq!(
            (offset_of!(DeviceDescriptor, vendor), offset_of!(DeviceDescriptor, serial_text)),
            (8, 16)
        );
    }
}
