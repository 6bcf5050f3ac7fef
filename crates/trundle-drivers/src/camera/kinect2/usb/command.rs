//! Requests to the device.

/// First word of a request. Source: \[Freenect2\].
pub const REQUEST_MAGIC: u32 = 0x0602_2009;
/// Longest reply of a page of calibration \[bytes\]. Source: \[Freenect2\].
const PAGE_BYTES: u32 = 0x1c_0000;

/// A page of the device's memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Page {
    /// The serial number.
    SerialNumber,
    /// The P0 tables.
    P0Tables,
    /// Intrinsics of the depth camera.
    DepthParameters,
    /// Intrinsics of the colour camera, and the map from depth to colour.
    ColorParameters,
}

/// A command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kinect2Command {
    /// Versions of the firmware.
    ReadFirmware,
    /// Version of the hardware.
    ReadHardware,
    /// Content of a page.
    ReadPage(Page),
    /// Whether the sensor is ready: bit 0 of the answer.
    ReadStatus,
    /// Prepares the streams.
    InitStreams,
    /// Starts or stops the streams.
    SetStreaming(bool),
    /// A mode whose meaning is unknown: on or off, and a number.
    SetMode(bool, u32),
    /// Stops the sensor.
    Stop,
    /// Ends the session.
    Shutdown,
}

impl Kinect2Command {
    /// The request on the wire.
    pub fn encode(self, sequence: u32) -> Vec<u8> {
        let (code, parameters) = self.code_and_parameters();
        let head = [REQUEST_MAGIC, sequence, self.reply_limit(), code, 0];
        head.iter().chain(&parameters).flat_map(|word| word.to_le_bytes()).collect()
    }

    /// Maximum length of the reply's data \[bytes\]; 0 for a completion only.
    pub fn reply_limit(self) -> u32 {
        match self {
            Self::ReadFirmware => 0x200,
            Self::ReadHardware => 0x5c,
            Self::ReadPage(Page::SerialNumber) => 0x80,
            Self::ReadPage(_) => PAGE_BYTES,
            Self::ReadStatus => 4,
            Self::InitStreams | Self::SetStreaming(_) | Self::SetMode(..) | Self::Stop | Self::Shutdown => 0,
        }
    }

    fn code_and_parameters(self) -> (u32, Vec<u32>) {
        match self {
            Self::Shutdown => (0x00, vec![]),
            Self::ReadFirmware => (0x02, vec![]),
            Self::InitStreams => (0x09, vec![]),
            Self::Stop => (0x0a, vec![]),
            Self::ReadHardware => (0x14, vec![]),
            Self::ReadStatus => (0x16, vec![0x0009_0000]),
            Self::ReadPage(page) => (0x22, vec![page.number()]),
            Self::SetStreaming(is_on) => (0x2b, vec![u32::from(is_on)]),
            Self::SetMode(is_on, value) => (0x4b, vec![u32::from(is_on), value, 0, 0]),
        }
    }
}

impl Page {
    fn number(self) -> u32 {
        match self {
            Self::SerialNumber => 1,
            Self::P0Tables => 2,
            Self::DepthParameters => 3,
            Self::ColorParameters => 4,
        }
    }
}

/// Number of the mode before the streams start and after they stop. Source: \[Freenect2\].
pub const STREAM_MODE: u32 = 0x0064_0064;

#[cfg(test)]
mod tests {
    use super::*;

    fn words(command: Kinect2Command) -> Vec<u32> {
        let bytes = command.encode(7);
        bytes.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)).collect()
    }

    #[test]
    fn a_request_has_magic_sequence_limit_code_and_parameters() {
        assert_eq!(words(Kinect2Command::ReadFirmware), [0x0602_2009, 7, 0x200, 2, 0]);
        let p0 = Kinect2Command::ReadPage(Page::P0Tables);
        assert_eq!(words(p0), [0x0602_2009, 7, 0x1c_0000, 0x22, 0, 2]);
        assert_eq!(words(Kinect2Command::ReadStatus), [0x0602_2009, 7, 4, 0x16, 0, 0x9_0000]);
        let mode = Kinect2Command::SetMode(true, STREAM_MODE);
        assert_eq!(words(mode), [0x0602_2009, 7, 0, 0x4b, 0, 1, 0x64_0064, 0, 0]);
        assert_eq!(&p0.encode(0)[..4], [0x09, 0x20, 0x02, 0x06], "little endian");
    }
}
