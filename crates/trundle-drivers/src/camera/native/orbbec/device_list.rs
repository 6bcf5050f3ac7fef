//! The connected Orbbec cameras.

use super::api::{Handle, OrbbecError, text};
use super::functions::{Context, DeviceList, OrbbecApi};
use crate::camera::native::DeviceEntry;
use crate::camera::{CameraError, UsbSpeed};
use std::sync::Arc;

/// The connected Orbbec cameras, as the library orders them.
///
/// # Errors
/// When the library refuses.
pub fn list_devices(api: &Arc<OrbbecApi>) -> Result<Vec<DeviceEntry>, CameraError> {
    let listed = api.context().and_then(|context| entries(api, &device_list(api, &context)?));
    listed.map_err(|error| error.of("any camera"))
}

/// The list of the library.
pub(super) fn device_list(
    api: &Arc<OrbbecApi>,
    context: &Handle<Context>,
) -> Result<Handle<DeviceList>, OrbbecError> {
    // SAFETY: the context is valid.
    api.owned(api.ob_delete_device_list, |error| unsafe { (api.ob_query_device_list)(context.get(), error) })
}

/// Facts about each camera in the library's list.
pub(super) fn entries(api: &OrbbecApi, list: &Handle<DeviceList>) -> Result<Vec<DeviceEntry>, OrbbecError> {
    // SAFETY: the list is valid.
    let count = api.call(|error| unsafe { (api.ob_device_list_get_count)(list.get(), error) })?;
    (0..count)
        .map(|index| {
            // SAFETY: the list is valid, the index is below its length, and its texts end with a zero.
            let name = api.call(|error| unsafe {
                text((api.ob_device_list_get_device_name)(list.get(), index, error))
            })?;
            // SAFETY: as above.
            let serial = api.call(|error| unsafe {
                text((api.ob_device_list_get_device_serial_number)(list.get(), index, error))
            })?;
            // SAFETY: as above.
            let connection = api.call(|error| unsafe {
                text((api.ob_device_list_get_device_connection_type)(list.get(), index, error))
            })?;
            Ok(DeviceEntry { name, serial, firmware: String::new(), usb: usb_speed(&connection) })
        })
        .collect()
}

/// The speed for a text as `USB3.2`.
fn usb_speed(connection: &str) -> Option<UsbSpeed> {
    match connection.strip_prefix("USB")?.chars().next()? {
        '1' => Some(UsbSpeed::Full),
        '2' => Some(UsbSpeed::High),
        '3' => Some(UsbSpeed::Super),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn connections_become_speeds() {
        assert_eq!(usb_speed("USB3.1"), Some(UsbSpeed::Super));
        assert_eq!(usb_speed("USB2.0"), Some(UsbSpeed::High));
        assert_eq!(usb_speed("Ethernet"), None);
    }
}
