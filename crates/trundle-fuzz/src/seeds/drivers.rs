//! Streams of devices, and mission files.

use super::texts;
use trundle::core::{Distortion, PinholeCamera, Stamp};
use trundle::drivers::camera::kinect2::layout::{IMAGE_BYTES, IMAGE_COUNT};
use trundle::drivers::camera::kinect2::usb::color_packets::{FOOTER_MAGIC, HEADER_MAGIC};
use trundle::drivers::camera::kinect2::usb::reply::COMPLETION_MAGIC;
use trundle::drivers::camera::pipe::StreamWriter;
use trundle::drivers::camera::{CameraFrame, CameraInfo, PixelFormat, RawImage, StreamInfo};
use trundle::drivers::kobuki::protocol::KobukiCommand;
use trundle::drivers::kobuki::{EmulatedKobuki, KobukiState};

/// Packets of a base, and commands.
pub fn kobuki() -> Vec<Vec<u8>> {
    let mut base = EmulatedKobuki::default();
    let request = KobukiCommand::RequestExtra { hardware: true, firmware: true, unique_id: true }.encode();
    base.on_bytes(&request);
    let packets: Vec<u8> = (0..3).flat_map(|_| base.feedback(&KobukiState::default())).collect();
    vec![packets, request, KobukiCommand::GetGains.encode()]
}

/// Two frames of 4 x 2 pixels.
pub fn camera_stream() -> Vec<Vec<u8>> {
    [(PixelFormat::Rgb8, 24), (PixelFormat::Yuyv, 16)]
        .into_iter()
        .filter_map(|(format, bytes)| stream(format, bytes))
        .collect()
}

fn stream(format: PixelFormat, bytes: usize) -> Option<Vec<u8>> {
    let camera = PinholeCamera::new((4, 2), (4.0, 4.0), (1.5, 0.5), Distortion::default()).ok()?;
    let stream = |format| StreamInfo { format, camera, rate_hz: 30.0 };
    let info = CameraInfo {
        name: "seed".to_owned(),
        serial: String::new(),
        firmware: String::new(),
        usb: None,
        color: stream(format),
        depth: stream(PixelFormat::Depth16),
        depth_unit_m: 0.001,
        color_from_depth: None,
        delay_s: 0.01,
        is_live: true,
    };
    let mut writer = StreamWriter::new(Vec::new(), &info).ok()?;
    for i in 0..2 {
        let stamp = Stamp::from_nanos(33_000_000 * i);
        let image = |format, bytes: usize| RawImage::packed(format, (4, 2), vec![100; bytes], stamp);
        writer
            .write(&CameraFrame { color: image(format, bytes), depth: image(PixelFormat::Depth16, 16) })
            .ok()?;
    }
    Some(writer.into_inner())
}

/// The head of a dump; its frames are too large for a seed.
pub fn kinect2_dump() -> Vec<Vec<u8>> {
    texts(&[
        r#"{"magic":"trundle-kinect2","version":1,"camera":{"width":512,"height":424,"fx":365.0,"fy":365.0,"cx":255.5,"cy":211.5}}"#,
    ])
}

/// A frame of depth, a colour image, a reply and a configuration descriptor, as arrivals.
pub fn kinect2_usb() -> Vec<Vec<u8>> {
    let arrival = |kind: u8, bytes: &[u8]| [&[kind], &(bytes.len() as u16).to_le_bytes()[..], bytes].concat();
    let words = |words: &[u32]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
    let image = |subsequence| {
        let mut footer = words(&[0, 9, 1, 1, subsequence, IMAGE_BYTES as u32]);
        footer.extend([0; 128]);
        let zeros = (IMAGE_BYTES / 8) as u16;
        [&[4], &zeros.to_le_bytes()[..], &arrival(0, &footer)].concat()
    };
    let frame: Vec<u8> = (0..IMAGE_COUNT as u32).flat_map(image).collect();
    let mut color = words(&[1, HEADER_MAGIC]);
    color.extend([0xff, 0xd8, 0xff, 0xd9]);
    color.extend(words(&[FOOTER_MAGIC, 1, 0, 0, 0, 267, 0, 0, HEADER_MAGIC, 68, 0, 0, 0, 0]));
    let completion = words(&[COMPLETION_MAGIC, 1, 0, 0]);
    let reply = [arrival(2, b"data"), arrival(2, &completion)].concat();
    let descriptor = [9, 4, 1, 1, 1, 255, 0, 0, 0, 7, 5, 0x84, 1, 0, 4, 1, 6, 48, 0, 0, 0, 0x84];
    let numbers: Vec<u8> = [365.0_f32; 25].iter().flat_map(|number| number.to_le_bytes()).collect();
    vec![
        frame,
        arrival(1, &color),
        reply,
        arrival(7, &descriptor),
        arrival(5, &numbers),
        arrival(6, &numbers),
    ]
}

/// A mission with a task of each kind.
pub fn mission() -> Vec<Vec<u8>> {
    texts(&["[[task]]\nexplore = true\n[[task]]\ngo = [3.0, 1.0, 90.0]\n[[task]]\nreturn = true\n"])
}
