//! A sequence as a ROS 2 bag.

use super::Converted;
use super::images::{each_image, finished};
use crate::sequence_input::SequenceInput;
use crate::{AppError, StepProgress};
use std::io::Write;
use trundle_core::{FrameId, Pose2, Pose3, Scan, Stamp};
use trundle_io::ros_message::{self, RosMessage};
use trundle_io::{EncodedRgbd, OutputFolder, Recorder};

/// Name of the file in its folder.
const BAG_FILE: &str = "bag.mcap";
/// Frame of the laser.
const LASER_FRAME: &str = "laser";

/// Writes a sequence into `folder`.
pub(super) fn write(
    input: &SequenceInput,
    folder: &OutputFolder,
    progress: &dyn StepProgress,
) -> Result<Converted, AppError> {
    let mut bag = folder.bag(BAG_FILE)?;
    if !input.is_empty() {
        bag.set_camera(input.camera.model.camera);
    }
    if input.camera.model.camera.readout() > 0.0 {
        tracing::warn!(
            "camera_info holds no readout time: give the camera with --camera when the bag is read"
        );
    }
    let mut others = OtherMessages::of(input);
    let mut converted = each_image(input, progress, |frame, image| {
        others.write_until(&mut bag, image.stamp())?;
        let encoded: EncodedRgbd = frame.encoded(&image).map_err(AppError::input)?;
        Ok(bag.record_images(&encoded)?)
    })?;
    others.write_until(&mut bag, Stamp::from_nanos(i64::MAX))?;
    converted.scans = others.scans;
    bag.finish()?;
    finished(input, converted)
}

/// All messages but the images.
struct OtherMessages<'a> {
    input: &'a SequenceInput,
    /// The last one first.
    queue: Vec<(Stamp, Other)>,
    /// Whether the static transforms are written.
    has_static: bool,
    /// Number of scans that were written.
    scans: usize,
}

enum Other {
    Message(&'static str, RosMessage),
    /// A scan by its index.
    Scan(usize),
}

impl<'a> OtherMessages<'a> {
    fn of(input: &'a SequenceInput) -> Self {
        let base = FrameId::Base.to_string();
        let gyro = input
            .gyro()
            .iter()
            .map(|rate| (rate.stamp, Other::Message("/imu", ros_message::gyro(&base, rate))));
        let scans = input.scan_stamps().into_iter().enumerate();
        let scans = scans.map(|(index, stamp)| (stamp, Other::Scan(index)));
        let mut queue: Vec<_> = gyro.chain(poses(input, &base)).chain(scans).collect();
        queue.sort_by_key(|(stamp, _)| *stamp);
        queue.reverse();
        Self { input, queue, has_static: false, scans: 0 }
    }

    /// Writes the messages up to a time, the static transforms before the first.
    fn write_until<W: Write>(&mut self, bag: &mut Recorder<W>, until: Stamp) -> Result<(), AppError> {
        if !self.has_static {
            self.has_static = true;
            let begin = self.queue.last().map_or(until, |(stamp, _)| until.min(*stamp));
            self.write_static(bag, begin)?;
        }
        while let Some((stamp, other)) = self.queue.pop_if(|(stamp, _)| *stamp <= until) {
            match other {
                Other::Message(topic, message) => bag.record_message(topic, stamp, &message)?,
                Other::Scan(index) => {
                    let Some(scan) = self.input.scan(index) else { continue };
                    bag.record_message("/scan", stamp, &ros_message::sweep(LASER_FRAME, &scan))?;
                    self.scans += 1;
                }
            }
        }
        Ok(())
    }

    /// Writes the poses of camera and laser on the base, as far as they are known.
    fn write_static<W: Write>(&self, bag: &mut Recorder<W>, at: Stamp) -> Result<(), AppError> {
        let (base, camera) = (FrameId::Base.to_string(), FrameId::Camera.to_string());
        let laser = |scan: Scan| Pose3::from_pose2(Pose2::new(scan.origin().x, scan.origin().y, 0.0));
        let transforms: Vec<_> = [
            (camera.as_str(), self.input.level_from_first_camera()),
            (LASER_FRAME, self.input.scan(0).map(laser)),
        ]
        .into_iter()
        .filter_map(|(frame, pose)| Some((at, base.as_str(), frame, pose?)))
        .collect();
        if transforms.is_empty() {
            return Ok(());
        }
        Ok(bag.record_message("/tf_static", at, &ros_message::transforms(&transforms))?)
    }
}

/// Odometry and ground truth with their stamps. Without images the ground truth is that of the base.
fn poses<'a>(input: &'a SequenceInput, base: &'a str) -> impl Iterator<Item = (Stamp, Other)> + 'a {
    let (odom, world) = (FrameId::Odom.to_string(), FrameId::World.to_string());
    let body = if input.is_empty() { base.to_owned() } else { FrameId::Camera.to_string() };
    let odometry = input.odometry_of_base().into_iter().flatten().map(move |(stamp, pose)| {
        let message = ros_message::odometry_pose(*stamp, &odom, base, Pose3::from_pose2(*pose));
        (*stamp, Other::Message("/odom", message))
    });
    let truth = input.ground_truth().into_iter().flatten().map(move |(stamp, pose)| {
        (*stamp, Other::Message("/ground_truth", ros_message::odometry_pose(*stamp, &world, &body, *pose)))
    });
    odometry.chain(truth)
}
