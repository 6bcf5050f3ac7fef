//! The writing half of a camera stream.

use super::camera_file::header_line;
use super::frame_parser::{FRAME_MAGIC, FrameLimits};
use crate::camera::{CameraError, CameraFrame, CameraInfo, RawImage};
use std::io::Write;
use trundle_core::Invalid;

/// Number of frames after which the header is repeated, for readers that join midway. Source: ours; 1 s at 30 Hz.
const FRAMES_PER_HEADER: u64 = 30;

/// Writes the frames of a camera in the form of `docs/camera-stream.md`.
#[derive(Debug)]
pub struct StreamWriter<W: Write> {
    writer: W,
    info: CameraInfo,
    header: String,
    frames: u64,
    limits: FrameLimits,
}

impl<W: Write> StreamWriter<W> {
    /// Writes the header for the camera `info`.
    ///
    /// # Errors
    /// When the camera's numbers are out of range, or writing fails.
    pub fn new(writer: W, info: &CameraInfo) -> Result<Self, CameraError> {
        let bad = |problem| CameraError::BadHeader { place: info.name.clone(), problem };
        let header = header_line(info).map_err(bad)?;
        let mut stream =
            Self { writer, info: info.clone(), header, frames: 0, limits: FrameLimits::of(info) };
        let written = stream.writer.write_all(stream.header.as_bytes()).and_then(|()| stream.writer.flush());
        written.map_err(|source| stream.failed(source))?;
        Ok(stream)
    }

    /// Writes a frame, with the time of its colour image, and the header again every 30 frames. Padding at the end of rows is left out.
    ///
    /// # Errors
    /// When an image has not the format or size of the header, or writing fails.
    pub fn write(&mut self, frame: &CameraFrame) -> Result<(), CameraError> {
        let color = packed(&frame.color)?;
        let depth = packed(&frame.depth)?;
        self.check(&frame.color, &color, "colour")?;
        self.check(&frame.depth, &depth, "depth")?;
        let frame_header = [
            &FRAME_MAGIC[..],
            &frame.color.device_stamp.nanos.to_le_bytes(),
            &(color.len() as u32).to_le_bytes(),
            &(depth.len() as u32).to_le_bytes(),
        ]
        .concat();
        let repeats = self.frames > 0 && self.frames.is_multiple_of(FRAMES_PER_HEADER);
        let stream_header = if repeats { self.header.as_bytes() } else { &[] };
        let parts = [stream_header, &frame_header, &color, &depth];
        let written = parts.into_iter().try_for_each(|part| self.writer.write_all(part));
        written.and_then(|()| self.writer.flush()).map_err(|source| self.failed(source))?;
        self.frames += 1;
        Ok(())
    }

    fn failed(&self, source: std::io::Error) -> CameraError {
        CameraError::Io { place: self.info.name.clone(), source }
    }

    /// The writer, after the last frame.
    pub fn into_inner(self) -> W {
        self.writer
    }

    fn check(&self, image: &RawImage, bytes: &[u8], name: &'static str) -> Result<(), Invalid> {
        let (stream, (low, high)) = match name {
            "colour" => (&self.info.color, self.limits.color),
            _ => (&self.info.depth, self.limits.depth),
        };
        if image.format != stream.format {
            return Err(Invalid::new(format!("{name} format"), image.format, "", stream.format.to_string()));
        }
        if !(low..=high).contains(&bytes.len()) {
            let expected = format!("{low} to {high}");
            return Err(Invalid::new(format!("length of the {name} image"), bytes.len(), "bytes", expected));
        }
        Ok(())
    }
}

/// The bytes of an image without padding.
fn packed(image: &RawImage) -> Result<std::borrow::Cow<'_, [u8]>, Invalid> {
    let row = image.format.bytes_per_pixel().map(|bytes| bytes * image.width);
    match row {
        Some(row) if image.stride > row => {
            let missing = || Invalid::new("row of an image", "incomplete", "", format!("{row} bytes"));
            let rows = image.bytes.chunks(image.stride).take(image.height);
            let rows: Option<Vec<&[u8]>> = rows.map(|chunk| chunk.get(..row)).collect();
            Ok(rows.ok_or_else(missing)?.concat().into())
        }
        _ => Ok((&image.bytes[..]).into()),
    }
}
