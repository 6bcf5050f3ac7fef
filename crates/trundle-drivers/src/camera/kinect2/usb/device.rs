//! An open Kinect V2: its commands, and its streams on and off. Source of the order of all steps: \[Freenect2\].

use super::calibration::{color_camera, depth_camera, p0_tables};
use super::command::{Kinect2Command, Page, STREAM_MODE};
use super::ids::{self, KINECT2_NAME};
use super::libusb::{Found, TransferPlan, UsbConnection, UsbSession};
use super::reply::{COMPLETION_BYTES, ReplyFault, ReplyReader};
use super::{answers, depth_packets, descriptor};
use crate::camera::kinect2::Kinect2Calibration;
use crate::camera::native::Selection;
use crate::camera::{CameraError, UsbSpeed};
use std::sync::Arc;
use std::time::{Duration, Instant};
use trundle_core::{Invalid, PinholeCamera, Pose3};

/// Longest wait for the sensor to become ready \[s\]. Source: ours; less than 1 s by reports of users.
const READY_TIMEOUT_S: u64 = 5;
/// Period of queries of the ready state \[ms\]. Source: ours.
const READY_POLL_MS: u64 = 100;
/// Maximum number of transfers of one reply. Source: ours; two, and some completions of earlier requests.
const MAX_REPLY_TRANSFERS: usize = 16;
/// Control requests. Source: USB 3.1 specification, 9.4.9 and 9.4.11.
const TO_DEVICE: u8 = 0x00;
const TO_INTERFACE: u8 = 0x01;
const SET_FEATURE: u8 = 3;
const SET_ISOCHRONOUS_DELAY: u8 = 0x31;
const U1_ENABLE: u16 = 48;
const U2_ENABLE: u16 = 49;
const FUNCTION_SUSPEND: u16 = 0;
/// Suspend with remote wake, in the upper byte of the index. Source: USB 3.1 specification, 9.4.9.
const SUSPENDED_INDEX: u16 = 3 << 8;
/// Delay without hubs in between \[ns\]. Source: \[Freenect2\].
const ISOCHRONOUS_DELAY_NS: u16 = 40;
/// Number of colour transfers that wait at the same time. Source: \[Freenect2\].
const COLOR_TRANSFER_COUNT: usize = 20;
/// Size of a colour transfer \[bytes\]. Source: \[Freenect2\].
const COLOR_TRANSFER_BYTES: usize = 0x4000;
/// Number of depth transfers that wait at the same time: 60 ms of packets of 0.125 ms. Source: \[Freenect2\].
const DEPTH_TRANSFER_COUNT: usize = 60;
/// Number of packets of a depth transfer. Source: \[Freenect2\].
const PACKETS_PER_DEPTH_TRANSFER: usize = 8;

/// The device's own description.
#[derive(Debug)]
pub(super) struct Identity {
    pub(super) serial: String,
    pub(super) firmware: String,
    /// For the decoder: of the mirrored images.
    pub(super) calibration: Kinect2Calibration,
    /// The colour camera of the image turned back.
    pub(super) color: PinholeCamera,
    pub(super) color_from_depth: Pose3,
}

/// An open device. A drop stops the device.
#[derive(Debug)]
pub(super) struct Kinect2Device {
    handle: UsbConnection,
    sequence: u32,
    packet_bytes: usize,
    speed: Option<UsbSpeed>,
    is_streaming: bool,
}

impl Kinect2Device {
    /// Opens a device and claims its interfaces.
    pub(super) fn open(session: &Arc<UsbSession>, selection: &Selection) -> Result<Self, CameraError> {
        let found = choose(session.kinects()?, selection)?;
        let speed = found.speed;
        let handle = found.opened?;
        if let Some(speed) = speed.filter(|speed| *speed < UsbSpeed::Super) {
            return Err(CameraError::UsbTooSlow { device: KINECT2_NAME.into(), speed });
        }
        handle.set_configuration(ids::CONFIGURATION_NUMBER)?;
        handle.claim(ids::CONTROL_INTERFACE)?;
        handle.claim(ids::DEPTH_INTERFACE)?;
        let mut device = Self { handle, sequence: 0, packet_bytes: 0, speed, is_streaming: false };
        device.prepare()?;
        Ok(device)
    }

    /// Speed of the connection.
    pub(super) fn speed(&self) -> Option<UsbSpeed> {
        self.speed
    }

    /// The handle, for transfers.
    pub(super) fn handle(&self) -> &UsbConnection {
        &self.handle
    }

    /// The transfers of colour and depth.
    pub(super) fn plans(&self) -> [TransferPlan; 2] {
        let (count, bytes) = (COLOR_TRANSFER_COUNT, COLOR_TRANSFER_BYTES);
        let color = TransferPlan { endpoint: ids::COLOR_ENDPOINT, count, packets: 0, bytes };
        let (count, packets) = (DEPTH_TRANSFER_COUNT, PACKETS_PER_DEPTH_TRANSFER);
        [color, TransferPlan { endpoint: ids::DEPTH_ENDPOINT, count, packets, bytes: self.packet_bytes }]
    }

    fn prepare(&mut self) -> Result<(), CameraError> {
        self.handle.control(TO_DEVICE, SET_ISOCHRONOUS_DELAY, ISOCHRONOUS_DELAY_NS, 0)?;
        self.handle.set_alternate(ids::DEPTH_INTERFACE, 0)?;
        self.handle.control(TO_DEVICE, SET_FEATURE, U1_ENABLE, 0)?;
        self.handle.control(TO_DEVICE, SET_FEATURE, U2_ENABLE, 0)?;
        self.handle.control(TO_INTERFACE, SET_FEATURE, FUNCTION_SUSPEND, SUSPENDED_INDEX)?;
        let bytes = self.handle.configuration_descriptor()?;
        let size = descriptor::bytes_per_interval(&bytes, ids::DEPTH_INTERFACE, 1, ids::DEPTH_ENDPOINT);
        self.packet_bytes =
            size.filter(|size| *size >= depth_packets::MIN_PACKET_BYTES).ok_or_else(|| {
                CameraError::StreamsUnavailable {
                    device: KINECT2_NAME.into(),
                    wanted: format!("isochronous packets of {} bytes", depth_packets::MIN_PACKET_BYTES),
                    remedy: "use a USB 3 port of another controller: Intel, NEC and Renesas controllers suit"
                        .into(),
                }
            })?;
        Ok(())
    }

    /// Reads the device's identity, and starts its streams.
    pub(super) fn start(&mut self) -> Result<Identity, CameraError> {
        self.is_streaming = true;
        self.handle.control(TO_INTERFACE, SET_FEATURE, FUNCTION_SUSPEND, 0)?;
        let identity = self.identity()?;
        self.execute(Kinect2Command::SetMode(true, STREAM_MODE))?;
        self.execute(Kinect2Command::SetMode(false, 0))?;
        self.wait_until_ready()?;
        self.execute(Kinect2Command::InitStreams)?;
        self.handle.set_alternate(ids::DEPTH_INTERFACE, 1)?;
        self.execute(Kinect2Command::ReadStatus)?;
        self.execute(Kinect2Command::SetStreaming(true))?;
        Ok(identity)
    }

    fn identity(&mut self) -> Result<Identity, CameraError> {
        let unusable = |stream| move |problem: Invalid| CameraError::IntrinsicsUnusable { stream, problem };
        let firmware = answers::firmware(&self.execute(Kinect2Command::ReadFirmware)?).unwrap_or_default();
        self.execute(Kinect2Command::ReadHardware)?;
        let serial = answers::serial_number(&self.read(Page::SerialNumber)?);
        let camera = depth_camera(&self.read(Page::DepthParameters)?).map_err(unusable("depth"))?;
        let p0 = p0_tables(&self.read(Page::P0Tables)?).map_err(unusable("depth"))?;
        let (color, color_from_depth) =
            color_camera(&self.read(Page::ColorParameters)?).map_err(unusable("colour"))?;
        let calibration = Kinect2Calibration { p0, camera, range_offset_m: 0.0 };
        Ok(Identity { serial, firmware, calibration, color, color_from_depth })
    }

    fn wait_until_ready(&mut self) -> Result<(), CameraError> {
        let start = Instant::now();
        while answers::is_ready(&self.execute(Kinect2Command::ReadStatus)?) != Some(true) {
            if start.elapsed() > Duration::from_secs(READY_TIMEOUT_S) {
                return Err(unanswered(format!("the sensor is not ready after {READY_TIMEOUT_S} s")));
            }
            std::thread::sleep(Duration::from_millis(READY_POLL_MS));
        }
        Ok(())
    }

    fn read(&mut self, page: Page) -> Result<Vec<u8>, CameraError> {
        self.execute(Kinect2Command::ReadPage(page))
    }

    /// Sends a command and waits for its reply; returns the reply's data.
    fn execute(&mut self, command: Kinect2Command) -> Result<Vec<u8>, CameraError> {
        let mut request = command.encode(self.sequence);
        let mut reader = ReplyReader::new(self.sequence, command.reply_limit());
        self.sequence = self.sequence.wrapping_add(1);
        let sent = self.handle.bulk(ids::REQUEST_ENDPOINT, &mut request)?;
        if sent != request.len() {
            return Err(unanswered(format!("{sent} of {} bytes of a request were sent", request.len())));
        }
        let mut buffer = vec![0; COMPLETION_BYTES.max(command.reply_limit() as usize)];
        for _ in 0..MAX_REPLY_TRANSFERS {
            let length = self.handle.bulk(ids::REPLY_ENDPOINT, &mut buffer)?;
            let of_command = |fault: ReplyFault| unanswered(format!("{command:?}: {fault}"));
            if let Some(data) = reader.push(&buffer[..length]).map_err(of_command)? {
                return Ok(data);
            }
        }
        Err(unanswered(format!("{command:?}: no end of the reply in {MAX_REPLY_TRANSFERS} transfers")))
    }

    /// Stops the streams, and ends the session with the device. Errors are ignored: the device is closed anyway.
    fn stop(&mut self) -> Result<(), CameraError> {
        self.handle.set_alternate(ids::DEPTH_INTERFACE, 0)?;
        let quiet = [Kinect2Command::SetMode(true, STREAM_MODE), Kinect2Command::SetMode(false, 0)];
        let end = [Kinect2Command::Stop, Kinect2Command::SetStreaming(false)];
        let shut =
            [Kinect2Command::SetMode(true, 0), Kinect2Command::SetMode(false, 0), Kinect2Command::Shutdown];
        for command in quiet.into_iter().chain(end).chain(shut) {
            self.execute(command)?;
        }
        self.handle.control(TO_INTERFACE, SET_FEATURE, FUNCTION_SUSPEND, SUSPENDED_INDEX)
    }
}

impl Drop for Kinect2Device {
    fn drop(&mut self) {
        if self.is_streaming
            && let Err(error) = self.stop()
        {
            tracing::debug!("the {KINECT2_NAME} was not stopped: {error}");
        }
        self.handle.release(ids::DEPTH_INTERFACE);
        self.handle.release(ids::CONTROL_INTERFACE);
    }
}

/// The first device, or the one with the serial number of `selection`.
fn choose(found: Vec<Found>, selection: &Selection) -> Result<Found, CameraError> {
    let is_wanted = |found: &Found| match selection {
        Selection::Serial(serial) => found.serial() == *serial,
        _ => true,
    };
    let is_unreadable = found.iter().position(|found| found.opened.is_err());
    let mut found = found;
    match found.iter().position(is_wanted).or(is_unreadable) {
        Some(index) => Ok(found.swap_remove(index)),
        None => Err(CameraError::NoDevice { kind: selection.describe(KINECT2_NAME) }),
    }
}

fn unanswered(message: String) -> CameraError {
    CameraError::LibraryFailed {
        library: KINECT2_NAME.into(),
        function: "its command protocol".into(),
        message,
        remedy: "unplug the camera from USB and power, and plug it in again".into(),
    }
}
