//! The writing half of a camera stream.

use super::camera_file::header_line;
use super::frame_parser::{FRAME_MAGIC, FrameLimits};
use crate::camera::{CameraError, CameraFrame, CameraInfo, RawImage};
use std::io::Write;
use trundle_core::Invalid;

/// Writes the frames of a camera in the form of `docs/camera-stream.md`.
#[derive(Debug)]
pub struct StreamWriter<W: Write> {
    writer: W,
    info: CameraInfo,
    limits: FrameLimits,
}

impl<W: Write> StreamWriter<W> {
    /// Writes the header for the camera `info`.
    ///
    /// # Errors
    /// When the camera's numbers are out of range, or writing fails.
    pub fn new(mut writer: W, info: &CameraInfo) -> Result<Self, CameraError> {
        let place = || info.name.clone();
        let header =
            header_line(info).map_err(|problem| CameraError::BadHeader { place: place(), problem })?;
        let failed = |source| CameraError::Io { place: place(), source };
        writer.write_all(header.as_bytes()).and_then(|()| writer.flush()).map_err(failed)?;
        Ok(Self { writer, info: info.clone(), limits: FrameLimits::of(info) })
    }

    /// Writes a frame, with the time of its colour image. Padding at the end of rows is left out.
    ///
    /// # Errors
    /// When an image has not the format or size of the header, or writing fails.
    pub fn write(&mut self, frame: &CameraFrame) -> Result<(), CameraError> {
        let color = packed(&frame.color)?;
        let depth = packed(&frame.depth)?;
        self.check(&frame.color, &color, "colour")?;
        self.check(&frame.depth, &depth, "depth")?;
        let failed = |source| CameraError::Io { place: self.info.name.clone(), source };
        let header = [
            &FRAME_MAGIC[..],
            &frame.color.device_stamp.nanos.to_le_bytes(),
            &(color.len() as u32).to_le_bytes(),
            &(depth.len() as u32).to_le_bytes(),
        ]
        .concat();
        let mut write = |bytes: &[u8]| self.writer.write_all(bytes);
        write(&header).and_then(|()| write(&color)).and_then(|()| write(&depth)).map_err(failed)?;
        self.writer.flush().map_err(failed)
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
