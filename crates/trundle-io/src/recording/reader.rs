//! Reader of a recording, message by message.

use super::messages::{
    self, BodyEventMessage, CliffMessage, GyroRateMessage, JsonImage, OdometryMessage, ScanMessage,
    TouchMessage, WheelTicksMessage,
};
use super::poses::PoseInFrame;
use super::ros_image::{self, ImageBytes};
use super::stream::{Encoding, MessageStream, RawMessage, RecordingCut};
use super::topics;
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
        /// Where it was recorded.
        topic: String,
        /// The name of its schema.
        schema: String,
        /// When.
        stamp: Stamp,
        /// The message.
        value: Value,
    },
}

/// Reads a recording message by message, in the order in which it was written; a few messages are in memory at a time.
pub struct RecordingReader {
    stream: MessageStream,
    config: Option<Value>,
    /// A message read ahead while looking for the configuration.
    ahead: Option<RawMessage>,
}

impl RecordingReader {
    /// Opens a recording and reads the configuration of its run, where that is its first message.
    ///
    /// # Errors
    /// When the file cannot be read or is no MCAP recording.
    pub fn open(path: &Path) -> Result<Self, IoError> {
        Expected::Recording.check(path)?;
        Self::of(MessageStream::open(path, Encoding::Json)?)
    }

    /// The same of a recording that may be cut at any byte, as by a power failure: its messages up to there.
    ///
    /// # Errors
    /// When the file cannot be read, is no MCAP recording, or is cut before its first message.
    pub fn open_to_cut(path: &Path) -> Result<Self, IoError> {
        Expected::Recording.check(path)?;
        let reader = Self::of(MessageStream::open_to_cut(path, Encoding::Json)?)?;
        match reader.cut() {
            Some(cut) if reader.config.is_none() && reader.ahead.is_none() => {
                let problem = format!("the recording was cut at byte {}, before its first message", cut.byte);
                Err(IoError::malformed(path, problem))
            }
            _ => Ok(reader),
        }
    }

    fn of(mut stream: MessageStream) -> Result<Self, IoError> {
        let first = stream.next_message()?;
        let (config, ahead) = match first {
            Some(raw) if raw.schema == "trundle.Config" => (Some(json(stream.path(), &raw)?), None),
            other => (None, other),
        };
        Ok(Self { stream, config, ahead })
    }

    /// The configuration of the run, as JSON.
    pub fn config(&self) -> Option<&Value> {
        self.config.as_ref()
    }

    /// Where the recording was cut, when it is read to there.
    pub fn cut(&self) -> Option<RecordingCut> {
        self.stream.cut()
    }

    /// How much of the file has been read, 0 to 1.
    pub fn progress(&self) -> f64 {
        self.stream.progress()
    }

    /// The next message that is not the configuration; `None` at the end.
    ///
    /// # Errors
    /// When the file is truncated or broken here, or a message is not what its topic promises. Reading on makes no
    /// sense then.
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
            topics::COLOR => return self.image(&raw),
            topics::DEPTH => {
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
            None => self.stream.next_message(),
        }
    }

    /// The image of a colour message and the depth message behind it; `None` where the recording was cut between both.
    fn image(&mut self, color: &RawMessage) -> Result<Option<RecordedMessage>, IoError> {
        let next = self.stream.next_message()?;
        if next.is_none() && self.cut().is_some() {
            return Ok(None);
        }
        let depth = next.filter(|raw| raw.topic == topics::DEPTH);
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
        ros_image::SCHEMA => ros_image::decode(&raw.data),
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
