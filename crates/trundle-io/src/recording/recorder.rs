//! Writer of a recording: an MCAP file with JSON messages, and images as ROS 2 has them.

use super::messages::EventMessages;
use super::poses::PoseInFrame;
use super::ros_image;
use super::schemas::json_schema;
use super::topics;
use crate::{EncodedEvent, EncodedRgbd, IoError};
use mcap::records::MessageHeader;
use mcap::{McapError, WriteOptions, Writer};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufWriter, Seek, Write};
use std::path::{Path, PathBuf};
use trundle_core::{Invalid, Stamp};

/// Size of a chunk, bytes. The recorder keeps the chunks for the index at the end: an hour of 30 images a second is 9,000 chunks
/// and some 2 MB of index. A program that is killed loses the chunk that it was writing.
const CHUNK_BYTES: u64 = 4 << 20;

/// Writes a recording: MCAP in uncompressed chunks (images are compressed already), messages in JSON, images in CDR.
///
/// The bytes depend on nothing but what is recorded: no clock, no chance; log time and publish time are the stamp.
pub struct Recorder<W: Write + Seek> {
    writer: Writer<W>,
    path: PathBuf,
    channels: BTreeMap<String, Channel>,
    buffer: Vec<u8>,
}

struct Channel {
    id: u16,
    schema: String,
    messages: u32,
}

impl Recorder<BufWriter<File>> {
    /// A recording into a new file at `path`; see [`crate::OutputFolder::recorder`] for one that appears only whole.
    ///
    /// # Errors
    /// When the file cannot be created.
    pub fn create(path: &Path) -> Result<Self, IoError> {
        let file = File::create(path).map_err(IoError::system(path, "create"))?;
        Self::new(BufWriter::with_capacity(1 << 20, file), path)
    }
}

impl<W: Write + Seek> Recorder<W> {
    /// A recording into `writer`, called `path` in errors.
    ///
    /// # Errors
    /// When nothing can be written.
    pub fn new(writer: W, path: &Path) -> Result<Self, IoError> {
        let options = WriteOptions::new()
            .chunk_size(Some(CHUNK_BYTES))
            .compression(None)
            .profile("")
            .library("trundle");
        let writer = options.create(writer).map_err(|error| failed(path, error))?;
        Ok(Self { writer, path: path.to_owned(), channels: BTreeMap::new(), buffer: Vec::new() })
    }

    /// Records a sensor event; an image as two messages, colour and depth.
    ///
    /// # Errors
    /// When its stamp is before the epoch, a number is not finite, or it cannot be written.
    pub fn record_event(&mut self, event: &EncodedEvent) -> Result<(), IoError> {
        check_finite(event).map_err(IoError::field(&self.path))?;
        let stamp = event.stamp();
        let messages = match event {
            EncodedEvent::Rgbd(image) => return self.record_images(image),
            other => EventMessages::of(other),
        };
        let Some(messages) = messages else { return Ok(()) };
        match messages {
            EventMessages::Wheels(m) => self.record_json(topics::WHEELS, "trundle.WheelTicks", stamp, &m),
            EventMessages::Gyro(m) => self.record_json(topics::GYRO, "trundle.GyroRate", stamp, &m),
            EventMessages::Touch(m) => self.record_json(topics::TOUCH, "trundle.Touch", stamp, &m),
            EventMessages::Cliff(m) => self.record_json(topics::CLIFF, "trundle.Cliff", stamp, &m),
            EventMessages::Scan(m) => self.record_json(topics::SCAN, "trundle.Scan", stamp, &m),
            EventMessages::Odometry(m) => self.record_json(topics::ODOMETRY, "trundle.Odometry", stamp, &m),
            EventMessages::Body(m) => self.record_json(topics::BODY, "trundle.BodyEvent", stamp, &m),
            EventMessages::Truth(m) => self.record_json(topics::TRUTH, PoseInFrame::SCHEMA, stamp, &m),
        }
    }

    /// Records any message as JSON: f64 exactly, NaN and infinity as `null`. A topic has one schema.
    ///
    /// The run's configuration is a `trundle.Config`, recorded first (see [`crate::RecordingReader::config`]).
    ///
    /// # Errors
    /// When the stamp is before the epoch, the topic had another schema before, the message is no JSON, or it cannot
    /// be written.
    pub fn record_json(
        &mut self,
        topic: &str,
        schema_name: &str,
        stamp: Stamp,
        message: &impl Serialize,
    ) -> Result<(), IoError> {
        self.buffer.clear();
        serde_json::to_writer(&mut self.buffer, message)
            .map_err(|error| IoError::malformed(&self.path, format!("message on {topic}: {error}")))?;
        self.record_buffer(topic, schema_name, stamp)
    }

    /// Records an image as two messages, colour and behind it depth.
    fn record_images(&mut self, image: &EncodedRgbd) -> Result<(), IoError> {
        for (topic, bytes) in [(topics::COLOR, &image.color_jpeg), (topics::DEPTH, &image.depth_png)] {
            self.buffer = ros_image::encode(image.stamp, bytes).map_err(IoError::field(&self.path))?;
            self.record_buffer(topic, ros_image::SCHEMA, image.stamp)?;
        }
        Ok(())
    }

    fn record_buffer(&mut self, topic: &str, schema_name: &str, stamp: Stamp) -> Result<(), IoError> {
        let time = u64::try_from(stamp.nanos).map_err(|_| {
            IoError::field(&self.path)(Invalid::new(format!("stamp on {topic}"), stamp, "s", "0 or later"))
        })?;
        let (channel_id, sequence) = self.channel(topic, schema_name)?;
        let header = MessageHeader { channel_id, sequence, log_time: time, publish_time: time };
        self.writer.write_to_known_channel(&header, &self.buffer).map_err(|error| failed(&self.path, error))
    }

    /// Writes the index and gives the writer back.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn finish(mut self) -> Result<W, IoError> {
        self.writer.finish().map_err(|error| failed(&self.path, error))?;
        let mut writer = self.writer.into_inner();
        writer.flush().map_err(IoError::system(&self.path, "write"))?;
        Ok(writer)
    }

    /// The channel of a topic, made at its first message, and the number of that message.
    fn channel(&mut self, topic: &str, schema: &str) -> Result<(u16, u32), IoError> {
        if !self.channels.contains_key(topic) {
            let id = self.add_channel(topic, schema).map_err(|error| failed(&self.path, error))?;
            self.channels.insert(topic.to_owned(), Channel { id, schema: schema.to_owned(), messages: 0 });
        }
        let channel = self.channels.get_mut(topic).expect("invariant: made above");
        if channel.schema != schema {
            let problem = Invalid::new(format!("schema of {topic}"), schema, "", channel.schema.clone());
            return Err(IoError::field(&self.path)(problem));
        }
        channel.messages = channel.messages.wrapping_add(1);
        Ok((channel.id, channel.messages))
    }

    fn add_channel(&mut self, topic: &str, schema: &str) -> Result<u16, McapError> {
        if schema == ros_image::SCHEMA {
            let definition = ros_image::DEFINITION.as_bytes();
            let schema = self.writer.add_schema(schema, ros_image::SCHEMA_ENCODING, definition)?;
            return self.writer.add_channel(schema, topic, "cdr", &BTreeMap::new());
        }
        let schema = self.writer.add_schema(schema, "jsonschema", json_schema(schema).as_bytes())?;
        self.writer.add_channel(schema, topic, "json", &BTreeMap::new())
    }
}

fn check_finite(event: &EncodedEvent) -> Result<(), Invalid> {
    match event {
        EncodedEvent::Gyro(rate) => trundle_core::require_finite("gyro omega", rate.omega, "rad/s").map(drop),
        EncodedEvent::Truth { pose, .. } if !pose.is_finite() => {
            Err(Invalid::new("true pose", format!("{pose:?}"), "", "finite numbers"))
        }
        EncodedEvent::Odometry(odometry) => odometry.checked().map(drop),
        EncodedEvent::Body(event) => event.checked().map(drop),
        _ => Ok(()),
    }
}

fn failed(path: &Path, error: McapError) -> IoError {
    match error {
        McapError::Io(error) => IoError::system(path, "write")(error),
        other => IoError::malformed(path, other.to_string()),
    }
}
