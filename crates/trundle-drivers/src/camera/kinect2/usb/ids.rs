//! Numbers of the device.

/// Vendor number of Microsoft. Source: the USB vendor list.
pub const VENDOR_ID: u16 = 0x045e;
/// Product numbers: the Kinect V2 as sold, and its preview version. Source: \[Freenect2\].
pub const PRODUCT_IDS: [u16; 2] = [0x02d8, 0x02c4];
/// Name of the camera in messages.
pub const KINECT2_NAME: &str = "Kinect V2";
/// Bulk endpoint of requests. Source: \[Freenect2\].
pub const REQUEST_ENDPOINT: u8 = 0x02;
/// Bulk endpoint of replies. Source: \[Freenect2\].
pub const REPLY_ENDPOINT: u8 = 0x81;
/// Bulk endpoint of colour. Source: \[Freenect2\].
pub const COLOR_ENDPOINT: u8 = 0x83;
/// Isochronous endpoint of depth. Source: \[Freenect2\].
pub const DEPTH_ENDPOINT: u8 = 0x84;
/// Interface of requests, replies and colour. Source: \[Freenect2\].
pub const CONTROL_INTERFACE: u8 = 0;
/// Interface of depth. Its alternate setting 0 has no isochronous endpoint; setting 1 has one. Source: \[Freenect2\].
pub const DEPTH_INTERFACE: u8 = 1;
/// Configuration with both interfaces. Source: \[Freenect2\].
pub const CONFIGURATION_NUMBER: u8 = 1;

/// Udev rule that gives access to a Kinect V2 to the group `plugdev`.
pub const KINECT2_UDEV_RULE: &str = "SUBSYSTEM==\"usb\", ATTR{idVendor}==\"045e\", ATTR{idProduct}==\"02c4\", MODE=\"0660\", GROUP=\"plugdev\", \
    TAG+=\"uaccess\"\n\
    SUBSYSTEM==\"usb\", ATTR{idVendor}==\"045e\", ATTR{idProduct}==\"02d8\", MODE=\"0660\", GROUP=\"plugdev\", TAG+=\"uaccess\"";

/// Whether these are the numbers of a Kinect V2.
pub fn is_kinect2(vendor: u16, product: u16) -> bool {
    vendor == VENDOR_ID && PRODUCT_IDS.contains(&product)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_udev_rule_has_every_product() {
        for product in PRODUCT_IDS {
            assert!(is_kinect2(VENDOR_ID, product));
            assert!(
                KINECT2_UDEV_RULE
                    .contains(&format!("{VENDOR_ID:04x}\", ATTR{{idProduct}}==\"{product:04x}\""))
            );
        }
        assert!(!is_kinect2(VENDOR_ID, 0x02ae), "the Kinect v1 is another device");
    }
}
