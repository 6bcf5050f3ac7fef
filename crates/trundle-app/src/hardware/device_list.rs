//! Devices that are plugged in, missing parts and how to get them.

use std::path::Path;
use trundle_drivers::camera::kinect2::usb::KINECT2_USB_STATE;
use trundle_drivers::camera::kinect2::usb::ids::KINECT2_UDEV_RULE;
use trundle_drivers::camera::native::{LibraryReport, LibraryState, NativeKind, list_devices, reports};
use trundle_drivers::{KOBUKI_UDEV_PORT, KOBUKI_UDEV_RULE, PortAccess, SerialDevice, serial_devices};

/// Udev rule of RealSense cameras, by their product's name: other devices have the vendor's number as well. Source: the names that
/// librealsense lists ("Intel(R) RealSense(TM) Depth Camera 435").
const REALSENSE_UDEV_RULE: &str = "SUBSYSTEM==\"usb\", ATTR{idVendor}==\"8086\", ATTR{product}==\"*RealSense*\", MODE=\"0660\", \
    GROUP=\"plugdev\", TAG+=\"uaccess\"";
/// Udev rule of Orbbec's cameras, by the vendor's number. Source: the USB ID database.
const ORBBEC_UDEV_RULE: &str =
    "SUBSYSTEM==\"usb\", ATTR{idVendor}==\"2bc5\", MODE=\"0660\", GROUP=\"plugdev\", TAG+=\"uaccess\"";
/// Udev rule of the Xtion and of other cameras with a PrimeSense sensor, by the vendor's number. Source: the USB ID database.
const XTION_UDEV_RULE: &str =
    "SUBSYSTEM==\"usb\", ATTR{idVendor}==\"1d27\", MODE=\"0660\", GROUP=\"plugdev\", TAG+=\"uaccess\"";
/// Product numbers of the Kinect v1 for the Xbox and for Windows: motor, audio, camera each. Newer models reach the motor through the audio
/// device. Source: libfreenect's `51-kinect.rules`.
const KINECT1_PRODUCT_IDS: [&str; 6] = ["02b0", "02ad", "02ae", "02c2", "02be", "02bf"];

/// Udev rules of the Kinect v1, whose vendor Microsoft has other devices as well.
fn kinect1_udev_rules() -> String {
    let rule = |product: &str| {
        format!(
            "SUBSYSTEM==\"usb\", ATTR{{idVendor}}==\"045e\", ATTR{{idProduct}}==\"{product}\", MODE=\"0660\", GROUP=\"plugdev\", \
             TAG+=\"uaccess\""
        )
    };
    KINECT1_PRODUCT_IDS.map(rule).join("\n")
}

/// The udev rules that give the devices their names and rights.
#[must_use]
pub fn udev_rules() -> String {
    format!(
        "# Written by `trundle devices --udev`. Install: save as /etc/udev/rules.d/60-trundle.rules, then\n\
         # sudo udevadm control --reload && sudo udevadm trigger\n\
         # Kobuki: {KOBUKI_UDEV_PORT}\n{KOBUKI_UDEV_RULE}\n\
         # Depth cameras: members of the group plugdev may open them\n\
         # Kinect v1\n{}\n\
         # Kinect V2\n{KINECT2_UDEV_RULE}\n\
         # RealSense\n{REALSENSE_UDEV_RULE}\n\
         # Orbbec\n{ORBBEC_UDEV_RULE}\n\
         # Xtion\n{XTION_UDEV_RULE}",
        kinect1_udev_rules()
    )
}

/// The devices and libraries, one row each: kind, state.
#[must_use]
pub fn device_rows() -> Vec<Vec<String>> {
    let devices = serial_devices();
    let mut rows: Vec<Vec<String>> = devices.iter().map(serial_row).collect();
    if !devices.iter().any(SerialDevice::is_kobuki) {
        let what = "not found: connect its USB cable and switch it on; other serial devices may still be one";
        rows.push(vec!["base Kobuki".to_owned(), what.to_owned()]);
    }
    let rule = if Path::new(KOBUKI_UDEV_PORT).exists() {
        format!("{KOBUKI_UDEV_PORT} is there")
    } else {
        format!("{KOBUKI_UDEV_PORT} is not there: install the rule of `trundle devices --udev`")
    };
    rows.push(vec!["udev rule".to_owned(), rule]);
    rows.extend(NativeKind::ALL.iter().zip(reports()).flat_map(|(kind, report)| camera_rows(*kind, &report)));
    let any = "any camera by --camera stream:PATH (docs/camera-stream.md)".to_owned();
    rows.push(vec!["camera stream".to_owned(), any]);
    rows.push(vec!["camera Kinect V2".to_owned(), KINECT2_USB_STATE.to_owned()]);
    rows
}

/// The library for a kind of camera, and the cameras that the library lists.
fn camera_rows(kind: NativeKind, report: &LibraryReport) -> Vec<Vec<String>> {
    let name = format!("camera {kind}");
    let row = |value: String| vec![name.clone(), value];
    match &report.state {
        LibraryState::Unusable { problem } => vec![row(problem.clone())],
        LibraryState::Usable { file, version } => {
            let version = version.map_or_else(String::new, |version| format!(" {version}"));
            let mut rows = vec![row(format!("library{version}: {}", file.display()))];
            match list_devices(kind) {
                Ok(devices) if devices.is_empty() => {
                    rows.push(row(format!("no {} is plugged in", kind.cameras())));
                }
                Ok(devices) => rows.extend(devices.iter().map(|device| {
                    let usb = device.usb.map_or_else(String::new, |usb| format!(", {usb}"));
                    row(format!("{} {}, firmware {}{usb}", device.name, device.serial, device.firmware))
                })),
                Err(error) => rows.push(row(error.to_string())),
            }
            rows
        }
    }
}

fn serial_row(device: &SerialDevice) -> Vec<String> {
    let access = match device.access {
        PortAccess::Free => "can be opened",
        PortAccess::Permitted => "not opened, the right is there",
        PortAccess::Busy => "in use by another program",
        PortAccess::NoRights => "no right to open it: sudo usermod -aG dialout $USER, then log in again",
        PortAccess::Broken => "does not answer: plug it in again",
    };
    let kind = if device.is_kobuki() { "base Kobuki" } else { "serial device" };
    vec![kind.to_owned(), format!("{} {}: {access}", device.path.display(), device.id)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_udev_rules_name_the_kobuki_and_the_cameras() {
        let rules = udev_rules();
        for part in [
            "SYMLINK+=\"kobuki\"",
            "\"045e\", ATTR{idProduct}==\"02c4\"",
            "\"045e\", ATTR{idProduct}==\"02d8\"",
            "\"045e\", ATTR{idProduct}==\"02ae\"",
            "\"045e\", ATTR{idProduct}==\"02bf\"",
            "\"1d27\"",
            "\"8086\", ATTR{product}==\"*RealSense*\"",
            "\"2bc5\"",
        ] {
            assert!(rules.contains(part), "{part} in {rules}");
        }
        let is_rule = |line: &str| line.starts_with('#') || line.starts_with("SUBSYSTEM==");
        assert!(rules.lines().all(is_rule), "{rules}");
    }

    #[test]
    fn a_row_states_that_the_kinect_v2_was_not_tested_with_a_device() {
        let rows = device_rows();
        let texts: Vec<&str> =
            rows.iter().filter(|row| row[0] == "camera Kinect V2").map(|row| row[1].as_str()).collect();
        let state =
            if cfg!(feature = "kinect2-usb") { "not tested with a device" } else { "--features kinect2-usb" };
        assert!(texts.len() == 1 && texts[0].contains(state), "{texts:?}");
        let is_listed = rows.iter().any(|row| row[0] == "camera kinect2");
        assert_eq!(is_listed, cfg!(feature = "kinect2-usb"), "its library and its devices");
    }
}
