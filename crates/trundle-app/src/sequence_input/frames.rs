//! The images of a sequence, one after the other, decoded on request.

use crate::AppError;
use std::path::Path;
use trundle_core::{RgbdImage, Stamp};
use trundle_io::{
    CodecError, EncodedEvent, EncodedRgbd, FrameError, IoError, RecordedMessage, RecordingReader, RosFrame,
    RosFrames, TumSequence,
};

/// An image that is not yet decoded.
pub struct PendingFrame<'a> {
    index: usize,
    content: Content<'a>,
}

enum Content<'a> {
    /// Listed in a folder.
    Listed(&'a TumSequence),
    /// Read from the recording at this path, whose camera has this size, px.
    Recorded { path: &'a Path, image: EncodedRgbd, size: (usize, usize) },
    /// Read from the bag at this path, whose camera has this size, px.
    Bagged { path: &'a Path, image: RosFrame, size: (usize, usize) },
}

impl PendingFrame<'_> {
    /// Stamp of the image.
    #[must_use]
    pub fn stamp(&self) -> Stamp {
        match &self.content {
            Content::Listed(sequence) => sequence.stamp(self.index),
            Content::Recorded { image, .. } => image.stamp,
            Content::Bagged { image, .. } => image.stamp(),
        }
    }

    /// The image.
    ///
    /// # Errors
    /// When the image is damaged or not of the camera's size: the caller may continue with the next image.
    pub fn decode(&self) -> Result<RgbdImage, FrameError> {
        match &self.content {
            Content::Listed(sequence) => sequence.load(self.index),
            Content::Recorded { path, image, size } => self.sized(path, image.decode(), *size),
            Content::Bagged { path, image, size } => self.sized(path, image.decode(), *size),
        }
    }

    /// The decoded image, checked against the camera's size.
    fn sized(
        &self,
        path: &Path,
        decoded: Result<RgbdImage, CodecError>,
        size: (usize, usize),
    ) -> Result<RgbdImage, FrameError> {
        let refused = |source| FrameError { index: self.index, stamp: self.stamp(), source };
        let decoded = decoded.map_err(|problem| refused(IoError::bad_image(path, problem)))?;
        let found = (decoded.color().width(), decoded.color().height());
        if found != size {
            return Err(refused(IoError::wrong_image_size(path, found, size)));
        }
        Ok(decoded)
    }

    /// The bytes to record for the decoded `image`: the bytes that were read, if their encoding is that of recordings.
    ///
    /// # Errors
    /// When the image cannot be encoded.
    pub fn encoded(self, image: &RgbdImage) -> Result<EncodedRgbd, CodecError> {
        match self.content {
            Content::Listed(_) => EncodedRgbd::encode(image),
            Content::Recorded { image, .. } => Ok(image),
            Content::Bagged { image: read, .. } => read.encoded(image),
        }
    }
}

/// The images of a folder, a recording or a bag.
pub(super) enum SequenceFrames<'a> {
    Folder { sequence: &'a TumSequence, next: usize },
    Recording { path: &'a Path, reader: Box<RecordingReader>, size: (usize, usize), delay: f64, next: usize },
    Bag { path: &'a Path, frames: Box<RosFrames<'a>>, size: (usize, usize), next: usize },
}

impl<'a> SequenceFrames<'a> {
    pub(super) fn of_folder(sequence: &'a TumSequence) -> Self {
        Self::Folder { sequence, next: 0 }
    }

    /// `size` of the camera, px.
    pub(super) fn of_bag(path: &'a Path, frames: RosFrames<'a>, size: (usize, usize)) -> Self {
        Self::Bag { path, frames: Box::new(frames), size, next: 0 }
    }

    /// `size` of the camera, px; `delay` of the images' stamps, s, which is subtracted.
    pub(super) fn of_recording(
        path: &'a Path,
        reader: RecordingReader,
        size: (usize, usize),
        delay: f64,
    ) -> Self {
        Self::Recording { path, reader: Box::new(reader), size, delay, next: 0 }
    }
}

impl<'a> Iterator for SequenceFrames<'a> {
    type Item = Result<PendingFrame<'a>, AppError>;

    fn next(&mut self) -> Option<Self::Item> {
        match self {
            Self::Folder { sequence, next } => {
                let index = (*next < sequence.len()).then_some(*next)?;
                *next += 1;
                Some(Ok(PendingFrame { index, content: Content::Listed(sequence) }))
            }
            Self::Bag { path, frames, size, next } => {
                let image = match frames.next()? {
                    Ok(image) => image,
                    Err(error) => return Some(Err(error.into())),
                };
                let content = Content::Bagged { path, image, size: *size };
                *next += 1;
                Some(Ok(PendingFrame { index: *next - 1, content }))
            }
            Self::Recording { path, reader, size, delay, next } => {
                let mut image = match next_image(reader) {
                    Ok(image) => image?,
                    Err(error) => return Some(Err(error)),
                };
                image.stamp = image.stamp.after(-*delay);
                let frame =
                    PendingFrame { index: *next, content: Content::Recorded { path, image, size: *size } };
                *next += 1;
                Some(Ok(frame))
            }
        }
    }
}

/// The next image of a recording; `None` at its end.
fn next_image(reader: &mut RecordingReader) -> Result<Option<EncodedRgbd>, AppError> {
    while let Some(message) = reader.next_message()? {
        if let RecordedMessage::Event(EncodedEvent::Rgbd(image)) = message {
            return Ok(Some(image));
        }
    }
    Ok(None)
}
