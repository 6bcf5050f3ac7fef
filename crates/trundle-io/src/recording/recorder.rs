//! Writer of a recording: an MCAP file of ROS 2 messages.

use super::container::{Container, Group};
use super::messages::EventMessages;
use super::topics;
use crate::ros::definition;
use crate::ros::message::{self as ros_message, RosMessage};
use crate::{EncodedEvent, EncodedRgbd, IoError};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use trundle_core::{FrameId, Invalid, PinholeCamera, Pose2, Pose3, Scan, Stamp};

/// Writes a recording: MCAP with the profile `ros2`, every message in CDR.
///
/// The data of a replay are on topics below `/trundle` as JSON in `std_msgs/msg/String`, exact to the last bit. Messages of ROS 2 for other
/// programs are recorded in addition. The bytes depend only on the recorded data: no clock, no random numbers; log time and publish time
/// are the stamp.
pub struct Recorder<W: Write> {
    container: Container<W>,
    path: PathBuf,
    channels: BTreeMap<String, Channel>,
    /// Numbers of the schemas, by name.
    schemas: BTreeMap<&'static str, u16>,
    camera: Option<PinholeCamera>,
}

/// The name of the writer in the header of a bag that is not a recording.
const BAG_LIBRARY: &str = "trundle convert";

struct Channel {
    id: u16,
    schema: String,
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

impl<W: Write> Recorder<W> {
    /// A recording into `writer`, called `path` in errors.
    ///
    /// # Errors
    /// When the writer fails.
    pub fn new(writer: W, path: &Path) -> Result<Self, IoError> {
        Self::named(writer, path, super::LIBRARY)
    }

    /// A ROS 2 bag that is not a recording of a run, into `writer`, called `path` in errors.
    ///
    /// # Errors
    /// When the writer fails.
    pub fn bag(writer: W, path: &Path) -> Result<Self, IoError> {
        Self::named(writer, path, BAG_LIBRARY)
    }

    fn named(writer: W, path: &Path, library: &str) -> Result<Self, IoError> {
        let container = Container::new(writer, "ros2", library).map_err(IoError::system(path, "write"))?;
        let path = path.to_owned();
        Ok(Self { container, path, channels: BTreeMap::new(), schemas: BTreeMap::new(), camera: None })
    }

    /// The camera of the images that follow: its camera_info is recorded with each.
    pub fn set_camera(&mut self, camera: PinholeCamera) {
        self.camera = Some(camera);
    }

    /// Records a sensor event, exact, and the message of ROS 2 that shows it.
    ///
    /// # Errors
    /// When the stamp is before the epoch, a number is not finite, or the writer fails.
    pub fn record_event(&mut self, event: &EncodedEvent) -> Result<(), IoError> {
        check_finite(event).map_err(IoError::field(&self.path))?;
        let stamp = event.stamp();
        if let EncodedEvent::Rgbd(image) = event {
            // Images precede their place in the order, so a flush in between does not delay them.
            self.record_images(image)?;
        }
        match EventMessages::of(event) {
            EventMessages::Wheels(m) => self.record_json(topics::WHEELS, "trundle.WheelTicks", stamp, &m),
            EventMessages::Gyro(m) => self.record_json(topics::GYRO, "trundle.GyroRate", stamp, &m),
            EventMessages::Touch(m) => self.record_json(topics::TOUCH, "trundle.Touch", stamp, &m),
            EventMessages::Cliff(m) => self.record_json(topics::CLIFF, "trundle.Cliff", stamp, &m),
            EventMessages::Scan(m) => self.record_json(topics::SCAN, "trundle.Scan", stamp, &m),
            EventMessages::Odometry(m) => self.record_json(topics::ODOMETRY, "trundle.Odometry", stamp, &m),
            EventMessages::Body(m) => self.record_json(topics::BODY, "trundle.BodyEvent", stamp, &m),
            EventMessages::Truth(m) => self.record_json(topics::TRUTH, "trundle.Truth", stamp, &m),
            EventMessages::Image(m) => self.record_json(topics::IMAGE, "trundle.Image", stamp, &m),
        }?;
        self.show(event)
    }

    /// Records the messages for other programs, except images.
    fn show(&mut self, event: &EncodedEvent) -> Result<(), IoError> {
        let base = FrameId::Base.to_string();
        match event {
            EncodedEvent::Gyro(rate) => {
                self.record_message("/imu", rate.stamp, &ros_message::gyro(&base, rate))
            }
            EncodedEvent::Scan(scan) => self.record_scan("/laser/scan", "laser", scan),
            EncodedEvent::Truth { stamp, pose } => {
                let (world, pose) = (FrameId::World.to_string(), Pose3::from_pose2(*pose));
                let message = ros_message::odometry_pose(*stamp, &world, &base, pose);
                self.record_message("/ground_truth", *stamp, &message)
            }
            _ => Ok(()),
        }
    }

    /// Records a sweep for other programs: its message on `topic`, and the pose of its `frame`, which is at the sweep's origin.
    ///
    /// # Errors
    /// When the writer fails.
    pub fn record_scan(&mut self, topic: &str, frame: &str, scan: &Scan) -> Result<(), IoError> {
        let stamp = scan.stamp();
        let origin = Pose3::from_pose2(Pose2::new(scan.origin().x, scan.origin().y, 0.0));
        let base = FrameId::Base.to_string();
        self.record_message("/tf", stamp, &ros_message::transforms(&[(stamp, &base, frame, origin)]))?;
        self.record_message(topic, stamp, &ros_message::scan(frame, scan))
    }

    /// Records any message as JSON below `/trundle`: f64 exactly, NaN and infinity as `null`. A topic has one schema.
    ///
    /// The run's configuration is a `trundle.Config`, recorded first (see [`crate::RecordingReader::config`]).
    ///
    /// # Errors
    /// When the stamp is before the epoch, the topic had another schema before, the message is not JSON, or it cannot
    /// be written.
    pub fn record_json(
        &mut self,
        topic: &str,
        schema_name: &str,
        stamp: Stamp,
        message: &impl Serialize,
    ) -> Result<(), IoError> {
        let text = serde_json::to_string(message)
            .map_err(|error| IoError::malformed(&self.path, format!("message on {topic}: {error}")))?;
        let name = format!("{}{topic}", topics::PRIVATE);
        self.write_message((&name, topic), schema_name, stamp, &ros_message::text(&text), Group::Rest)
    }

    /// Records a message of ROS 2.
    ///
    /// # Errors
    /// As [`Recorder::record_json`].
    pub fn record_message(&mut self, topic: &str, stamp: Stamp, message: &RosMessage) -> Result<(), IoError> {
        self.write_message((topic, topic), message.kind(), stamp, message, Group::Rest)
    }

    /// Records colour, depth and the camera's intrinsics, without their place among the events of a run.
    ///
    /// # Errors
    /// As [`Recorder::record_json`].
    pub fn record_images(&mut self, image: &EncodedRgbd) -> Result<(), IoError> {
        let (stamp, frame) = (image.stamp, FrameId::Camera.to_string());
        let color = ros_message::color_image(stamp, &frame, &image.color_jpeg);
        let depth = ros_message::depth_image(stamp, &frame, &image.depth);
        for (topic, message, group) in
            [(topics::COLOR, color, Group::Color), (topics::DEPTH, depth, Group::Depth)]
        {
            self.write_message((topic, topic), message.kind(), stamp, &message, group)?;
        }
        if let Some(camera) = self.camera {
            let info = ros_message::camera_info(stamp, &frame, &camera);
            for topic in [topics::COLOR_INFO, topics::DEPTH_INFO] {
                self.record_message(topic, stamp, &info)?;
            }
        }
        Ok(())
    }

    fn write_message(
        &mut self,
        (topic, named): (&str, &str),
        schema: &str,
        stamp: Stamp,
        message: &RosMessage,
        group: Group,
    ) -> Result<(), IoError> {
        let time = u64::try_from(stamp.nanos).map_err(|_| {
            IoError::field(&self.path)(Invalid::new(format!("stamp on {named}"), stamp, "s", "0 or later"))
        })?;
        let channel = self.channel((topic, named), schema, message.kind(), group)?;
        let written = self.container.write_message(channel, time, message.bytes());
        written.map_err(|error| failed(&self.path, error))
    }

    /// Writes the index and gives the writer back.
    ///
    /// # Errors
    /// When the writer fails.
    pub fn finish(self) -> Result<W, IoError> {
        let Self { container, path, .. } = self;
        container.finish().map_err(|error| failed(&path, error))
    }

    /// The channel of a topic, made at its first message.
    fn channel(
        &mut self,
        (topic, named): (&str, &str),
        schema: &str,
        kind: &'static str,
        group: Group,
    ) -> Result<u16, IoError> {
        if let Some(channel) = self.channels.get(topic) {
            if channel.schema != schema {
                let problem = Invalid::new(format!("schema of {named}"), schema, "", channel.schema.clone());
                return Err(IoError::field(&self.path)(problem));
            }
            return Ok(channel.id);
        }
        let container = &mut self.container;
        let known = self.schemas.entry(kind);
        let schema_id = *known.or_insert_with(|| container.add_schema(kind, "ros2msg", &definition(kind)));
        let mut metadata = BTreeMap::from([("offered_qos_profiles".to_owned(), String::new())]);
        if schema != kind {
            metadata.insert(topics::SCHEMA_KEY.to_owned(), schema.to_owned());
        }
        let id = container.add_channel(topic, schema_id, &metadata, group);
        self.channels.insert(topic.to_owned(), Channel { id, schema: schema.to_owned() });
        Ok(id)
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

fn failed(path: &Path, error: io::Error) -> IoError {
    IoError::system(path, "write")(error)
}
