//! The Kinect V2 by USB.
//!
//! **This part has never met a device.** Its state machines were tested with made byte streams, its calls with the real libusb and no device.
//!
//! | data | module | endpoint |
//! |---|---|---|
//! | requests, little endian: magic, sequence, longest reply, command, 0, parameters | [`command`] | bulk 0x02, out |
//! | replies: the data requested by the command, then a completion with the same sequence | [`reply`] | bulk 0x81, in |
//! | firmware, serial number, calibration from replies | [`answers`], [`calibration`] | |
//! | colour: header, JPEG file, filler, footer | [`color_packets`] | bulk 0x83, in |
//! | depth: packed images of 298,496 bytes, each with a footer of 152 bytes; an empty packet between images | [`depth_packets`] | isochronous 0x84, in |
//! | size of isochronous packets | [`descriptor`] | control |
//!
//! With the feature `kinect2-usb`, `camera` drives a device through libusb, which is loaded at run time. `functions` declares its
//! functions, `libusb` calls them, `device` implements the protocol, `stream_thread` collects packets, and `camera` makes frames.
//!
//! The protocol is not documented by the manufacturer. Unless stated otherwise, its numbers are facts read in \[Freenect2\]. Images come
//! mirrored left to right; `camera` turns them. Assumption: both time counters start together and count in steps of 0.125 ms.

pub mod answers;
pub mod calibration;
#[cfg(feature = "kinect2-usb")]
mod camera;
pub mod color_packets;
pub mod command;
pub mod depth_packets;
pub mod descriptor;
#[cfg(feature = "kinect2-usb")]
mod device;
#[cfg(all(test, feature = "kinect2-usb"))]
mod emulated;
#[cfg(feature = "kinect2-usb")]
mod functions;
pub mod ids;
#[cfg(feature = "kinect2-usb")]
mod libusb;
pub mod reply;
#[cfg(feature = "kinect2-usb")]
mod stream_thread;

#[cfg(feature = "kinect2-usb")]
pub use camera::{Kinect2UsbCamera, list_devices};
#[cfg(feature = "kinect2-usb")]
pub use functions::{LIBRARY, UsbApi};

/// State of this part, for users.
#[cfg(feature = "kinect2-usb")]
pub const KINECT2_USB_STATE: &str = "kinect2 by USB: this part has never met a device";
/// State of this part, for users: how to get it.
#[cfg(not(feature = "kinect2-usb"))]
pub const KINECT2_USB_STATE: &str = "kinect2 by USB is not built in: build the program with 'cargo build --release --features kinect2-usb'; \
    --camera kinect2-dump:FILE plays packets from a file; no device was met";
