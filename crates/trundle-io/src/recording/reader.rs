//! Reader of a recording, message by message.

use super::channels::{Encoding, RawMessage};
use super::cut::RecordingCut;
use super::images::{self, ImageBytes, WaitingImages};
use super::messages::{
    self, BodyEventMessage, CliffMessage, GyroRateMessage, ImageMessage, JsonImage, OdometryMessage,
    ScanMessage, TouchMessage, WheelTicksMessage,
};
use super::poses::PoseInFrame;
use super::stream::MessageStream;
use super::topics;
use crate::ros::{CdrReader, Wire};
use crate::{EncodedEvent, Expected, IoError};
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::path::Path;
use trundle_core::{Invalid, Stamp};

/// A message of a recording.
#[derive(Debug, Clone, PartialEq)]
pub enum RecordedMessage {
    /// A sensor event.
    Event(EncodedEvent),
    /// Anything else.
    Json {
        /// Topic of the message.
        topic: String,
        /// Name of the schema.
        schema: String,
        /// Stamp of the message.
        stamp: Stamp,
        /// The message.
        value: Value,
    },
}

/// Reads a recording message by message, in the order of writing; only a few messages are in memory.
pub struct RecordingReader {
    stream: MessageStream,
    config: Option<Value>,
    /// A message read ahead while looking for the configuration.
    ahead: Option<RawMessage>,
    images: WaitingImages,
}

impl RecordingReader {
    /// Opens a recording and reads the configuration of its run if that is the first message.
    ///
    /// # Errors
    /// When the file cannot be read or is not an MCAP recording.
    pub fn open(path: &Path) -> Result<Self, IoError> {
        Expected::Recording.check(path)?;
        Self::of(MessageStream::open(path, Encoding::Own)?)
    }

    /// Opens a recording that may be cut at any byte, as by a power failure, and reads its messages up to the cut.
    ///
    /// # Errors
    /// When the file cannot be read, is not an MCAP recording, or is cut before its first message.
    pub fn open_to_cut(path: &Path) -> Result<Self, IoError> {
        Expected::Recording.check(path)?;
        let reader = Self::of(MessageStream::open_to_cut(path, Encoding::Own)?)?;
        match reader.cut() {
            Some(cut) if reader.config.is_none() && reader.ahead.is_none() => {
                let problem = format!("the recording {}, before its first message", cut.place());
                Err(IoError::malformed(path, problem))
            }
            _ => Ok(reader),
        }
    }

    fn of(stream: MessageStream) -> Result<Self, IoError> {
        let mut reader = Self { stream, config: None, ahead: None, images: WaitingImages::default() };
        match reader.next_own()? {
            Some(raw) if raw.schema == "trundle.Config" => {
                reader.config = Some(json(reader.stream.path(), &raw)?);
            }
            other => reader.ahead = other,
        }
        Ok(reader)
    }

    /// The configuration of the run, as JSON.
    pub fn config(&self) -> Option<&Value> {
        self.config.as_ref()
    }

    /// Position of the cut, once reading has reached it.
    pub fn cut(&self) -> Option<RecordingCut> {
        self.stream.cut()
    }

    /// Share of the file that was read, 0 to 1.
    pub fn progress(&self) -> f64 {
        self.stream.progress()
    }

    /// The next message that is not the configuration; `None` at the end.
    ///
    /// # Errors
    /// When the file is truncated or broken here, or a message does not match its topic. Further reading is impossible then.
    pub fn next_message(&mut self) -> Result<Option<RecordedMessage>, IoError> {
        let Some(raw) = self.next_raw()? else { return Ok(None) };
        let path = self.stream.path();
        let event = match raw.topic.as_str() {
            topics::WHEELS => sensor::<WheelTicksMessage>(path, &raw)?,
            topics::GYRO => sensor::<GyroRateMessage>(path, &raw)?,
            topics::TOUCH => sensor::<TouchMessage>(path, &raw)?,
            topics::CLIFF => sensor::<CliffMessage>(path, &raw)?,
            topics::SCAN => sensor::<ScanMessage>(path, &raw)?,
            topics::ODOMETRY => sensor::<OdometryMessage>(path, &raw)?,
            topics::BODY => sensor::<BodyEventMessage>(path, &raw)?,
            topics::TRUTH => sensor::<PoseInFrame>(path, &raw)?,
            topics::IMAGE => {
                let path = path.to_owned();
                let stamp = json::<ImageMessage>(&path, &raw)?.stamp();
                let image =
                    stamp.map_err(|invalid| invalid.to_string()).and_then(|stamp| self.images.pop(stamp));
                EncodedEvent::Rgbd(image.map_err(|problem| wrong(&path, &raw, &problem))?)
            }
            topics::OLD_COLOR => return self.image(&raw),
            topics::OLD_DEPTH => {
                return Err(wrong(path, &raw, "a depth image without its colour image before it"));
            }
            _ => {
                let value = json(path, &raw)?;
                let RawMessage { topic, schema, stamp, .. } = raw;
                return Ok(Some(RecordedMessage::Json { topic, schema, stamp, value }));
            }
        };
        Ok(Some(RecordedMessage::Event(event)))
    }

    /// The sensor events only, in the order in which the robot got them. Ends after the first error.
    pub fn events(self) -> impl Iterator<Item = Result<EncodedEvent, IoError>> {
        self.filter_map(|message| match message {
            Ok(RecordedMessage::Event(event)) => Some(Ok(event)),
            Ok(RecordedMessage::Json { .. }) => None,
            Err(error) => Some(Err(error)),
        })
    }

    fn next_raw(&mut self) -> Result<Option<RawMessage>, IoError> {
        match self.ahead.take() {
            Some(raw) => Ok(Some(raw)),
            None => self.next_own(),
        }
    }

    /// The next message of ours, its JSON unwrapped. Images wait for their place; other messages of ROS 2 are skipped.
    fn next_own(&mut self) -> Result<Option<RawMessage>, IoError> {
        while let Some(raw) = self.stream.next_message()? {
            let path = self.stream.path();
            if let Some(topic) = raw.topic.strip_prefix(topics::PRIVATE).filter(|rest| rest.starts_with('/'))
            {
                let text = CdrReader::new("std_msgs/msg/String", &raw.data, Wire::Cdr)
                    .and_then(|mut reader| reader.string("data"));
                let text = text.map_err(|error| wrong(path, &raw, &error.to_string()))?;
                return Ok(Some(RawMessage { topic: topic.to_owned(), data: text.into_bytes(), ..raw }));
            }
            match raw.topic.as_str() {
                topics::COLOR | topics::DEPTH => {
                    let image = images::decode(&raw.data);
                    let kept = image.and_then(|image| self.images.push(image, raw.topic == topics::COLOR));
                    kept.map_err(|problem| wrong(path, &raw, &problem))?;
                }
                _ if raw.is_json || raw.topic == topics::OLD_COLOR || raw.topic == topics::OLD_DEPTH => {
                    return Ok(Some(raw));
                }
                _ => {}
            }
        }
        Ok(None)
    }

    /// The image of a colour message and the following depth message; `None` if the recording was cut between both.
    fn image(&mut self, color: &RawMessage) -> Result<Option<RecordedMessage>, IoError> {
        let next = self.stream.next_message()?;
        if next.is_none() && self.cut().is_some() {
            return Ok(None);
        }
        let depth = next.filter(|raw| raw.topic == topics::OLD_DEPTH);
        let path = self.stream.path();
        let depth =
            depth.ok_or_else(|| wrong(path, color, "a colour image without its depth image behind it"))?;
        let (c, d) = (compressed_image(path, color)?, compressed_image(path, &depth)?);
        let image = messages::rgbd(c, d).map_err(|problem| wrong(path, color, &problem))?;
        Ok(Some(RecordedMessage::Event(image)))
    }
}

/// All messages but the configuration; ends after the first error.
impl Iterator for RecordingReader {
    type Item = Result<RecordedMessage, IoError>;

    fn next(&mut self) -> Option<Self::Item> {
        let next = self.next_message();
        if next.is_err() {
            self.stream.stop();
        }
        next.transpose()
    }
}

fn sensor<M>(path: &Path, raw: &RawMessage) -> Result<EncodedEvent, IoError>
where
    M: DeserializeOwned,
    EncodedEvent: TryFrom<M, Error = Invalid>,
{
    EncodedEvent::try_from(json::<M>(path, raw)?).map_err(|invalid| wrong(path, raw, &invalid.to_string()))
}

fn compressed_image(path: &Path, raw: &RawMessage) -> Result<ImageBytes, IoError> {
    let image = match raw.schema.as_str() {
        images::SCHEMA => images::decode(&raw.data),
        _ => json::<JsonImage>(path, raw)?.image(),
    };
    image.map_err(|problem| wrong(path, raw, &problem))
}

fn json<T: DeserializeOwned>(path: &Path, raw: &RawMessage) -> Result<T, IoError> {
    serde_json::from_slice(&raw.data).map_err(|error| wrong(path, raw, &error.to_string()))
}

fn wrong(path: &Path, raw: &RawMessage, problem: &str) -> IoError {
    IoError::malformed(path, format!("message on {} at {} s: {problem}", raw.topic, raw.stamp))
}
