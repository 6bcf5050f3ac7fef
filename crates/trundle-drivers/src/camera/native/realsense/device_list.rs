//! The connected RealSense cameras.

use super::api::{RealSenseError, text};
use super::constants::{
    CAMERA_INFO_FIRMWARE_VERSION, CAMERA_INFO_NAME, CAMERA_INFO_SERIAL_NUMBER, CAMERA_INFO_USB_TYPE,
};
use super::functions::{Context, Device, RealSenseApi};
use super::handle::Handle;
use crate::camera::native::DeviceEntry;
use crate::camera::{CameraError, UsbSpeed};
use std::ffi::c_int;
use std::sync::Arc;

/// The connected RealSense cameras, as the library orders them.
///
/// # Errors
/// When the library refuses.
pub fn list_devices(api: &Arc<RealSenseApi>) -> Result<Vec<DeviceEntry>, CameraError> {
    devices(api).map_err(|error| error.of("any camera"))
}

fn devices(api: &Arc<RealSenseApi>) -> Result<Vec<DeviceEntry>, RealSenseError> {
    let context = api.context()?;
    connected(api, &context)?.iter().map(|device| entry(api, device)).collect()
}

fn connected(
    api: &Arc<RealSenseApi>,
    context: &Handle<Context>,
) -> Result<Vec<Handle<Device>>, RealSenseError> {
    // SAFETY: the context is valid.
    let list = api.owned(api.rs2_delete_device_list, |error| unsafe {
        (api.rs2_query_devices)(context.get(), error)
    })?;
    // SAFETY: the list is valid.
    let count = api.call(|error| unsafe { (api.rs2_get_device_count)(list.get(), error) })?;
    (0..count)
        .map(|index| {
            // SAFETY: the list is valid, and the index is below its length.
            api.owned(api.rs2_delete_device, |error| unsafe {
                (api.rs2_create_device)(list.get(), index, error)
            })
        })
        .collect()
}

/// A device's own description.
pub(super) fn entry(api: &RealSenseApi, device: &Handle<Device>) -> Result<DeviceEntry, RealSenseError> {
    Ok(DeviceEntry {
        name: info(api, device, CAMERA_INFO_NAME)?,
        serial: info(api, device, CAMERA_INFO_SERIAL_NUMBER)?,
        firmware: info(api, device, CAMERA_INFO_FIRMWARE_VERSION)?,
        usb: usb_speed(&info(api, device, CAMERA_INFO_USB_TYPE)?),
    })
}

/// A text of the device; empty if it has none.
fn info(api: &RealSenseApi, device: &Handle<Device>, number: c_int) -> Result<String, RealSenseError> {
    // SAFETY: the device is valid.
    let is_there =
        api.call(|error| unsafe { (api.rs2_supports_device_info)(device.get(), number, error) })?;
    if is_there == 0 {
        return Ok(String::new());
    }
    // SAFETY: the device is valid.
    let value = api.call(|error| unsafe { (api.rs2_get_device_info)(device.get(), number, error) })?;
    // SAFETY: the text belongs to the device and ends with a zero.
    Ok(unsafe { text(value) })
}

/// The speed for a text as `3.2`.
fn usb_speed(version: &str) -> Option<UsbSpeed> {
    match version.split('.').next()? {
        "1" => Some(UsbSpeed::Full),
        "2" => Some(UsbSpeed::High),
        "3" => Some(UsbSpeed::Super),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn usb_versions_become_speeds() {
        assert_eq!(usb_speed("3.2"), Some(UsbSpeed::Super));
        assert_eq!(usb_speed("2.1"), Some(UsbSpeed::High));
        assert_eq!(usb_speed(""), None);
    }
}
