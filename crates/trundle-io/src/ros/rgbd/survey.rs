//! The first pass over a bag: all content except the pixels of images.

use super::camera_info::CameraInfo;
use super::image_message::{BagImage, ImageKind};
use super::topic_choice::ImageTopic;
use crate::recording::RawMessage;
use crate::ros::bag::Bag;
use crate::ros::cdr::Wire;
use crate::ros::contents::Contents;
use crate::ros::messages::{Odometry, Transform, types};
use crate::ros::robot_sensors::{ImuTopics, ScanMessages};
use crate::{IoError, Warnings};
use std::collections::BTreeMap;
use std::path::Path;
use trundle_core::{Pose3, Stamp};

/// Content of a bag except the pixels of images.
#[derive(Default)]
pub(super) struct Survey {
    /// Odometry and transforms.
    pub(super) contents: Contents,
    images: BTreeMap<String, ImageStamps>,
    /// Readings of IMUs.
    pub(super) imus: ImuTopics,
    /// Whether the scans of lasers are kept.
    keeps_scans: bool,
    pub(super) scans: ScanMessages,
    /// The first camera_info message of each topic.
    pub(super) infos: BTreeMap<String, CameraInfo>,
    /// True poses: the frame whose pose it is, and the pose.
    pub(super) truth: Vec<(Stamp, String, Pose3)>,
    pub(super) warnings: Warnings,
}

struct ImageStamps {
    frame: String,
    kind: ImageKind,
    encoding: String,
    stamps: Vec<Stamp>,
}

/// Whether a topic contains true poses, by its name.
fn is_truth(topic: &str) -> bool {
    let name = topic.to_lowercase().replace('_', "");
    name.contains("groundtruth")
}

impl Survey {
    /// Reads a bag, with the scans of lasers if `keeps_scans`. A broken message gives one warning with its topic; a truncated bag is read up
    /// to its end.
    pub(super) fn read(path: &Path, keeps_scans: bool) -> Result<Self, IoError> {
        let (mut survey, mut bag) = (Self { keeps_scans, ..Self::default() }, Bag::open(path)?);
        for number in 1.. {
            match bag.next_message() {
                Ok(Some(message)) => {
                    if let Err(problem) = survey.take(number, &message, bag.wire()) {
                        survey.warnings.add(&format!("a message on {} is broken", message.topic), &problem);
                    }
                }
                Ok(None) => break,
                Err(error) if survey.has_sensors() => {
                    survey.warnings.add("the bag breaks off and is read up to there", &error.problem());
                    break;
                }
                Err(error) => return Err(error),
            }
        }
        for cut in bag.cuts {
            survey.warnings.add("the bag breaks off and is read up to there", &cut);
        }
        for parts in bag.skipped {
            survey.warnings.add("the bag is damaged", &parts);
        }
        Ok(survey)
    }

    fn take(&mut self, number: usize, message: &RawMessage, wire: Wire) -> Result<(), String> {
        let kind = types::canonical(&message.schema);
        if let Some(image) = BagImage::read(kind, &message.data, wire) {
            self.take_image(&message.topic, &image.map_err(|error| error.to_string())?);
            return Ok(());
        }
        match kind {
            types::CAMERA_INFO => {
                if !self.infos.contains_key(&message.topic) {
                    let info = CameraInfo::read(&message.data, wire).map_err(|error| error.to_string())?;
                    self.infos.insert(message.topic.clone(), info);
                }
                Ok(())
            }
            types::LASER_SCAN if !self.keeps_scans => Ok(()),
            types::LASER_SCAN => self.scans.take(number, message, wire).map_err(|error| error.to_string()),
            types::IMU => {
                let taken = self.imus.take(number, &message.topic, &message.data, wire);
                taken.map_err(|error| error.to_string())
            }
            types::ODOMETRY if is_truth(&message.topic) => {
                let odometry = Odometry::read(&message.data, wire).map_err(|error| error.to_string())?;
                self.truth.push((odometry.stamp, odometry.child, odometry.pose?));
                Ok(())
            }
            types::TRANSFORM if is_truth(&message.topic) => {
                let transform =
                    Transform::read_one(&message.data, wire).map_err(|error| error.to_string())?;
                self.truth.push((transform.stamp, transform.child, transform.parent_from_child?));
                Ok(())
            }
            _ => self.contents.take(number, message, wire),
        }
    }

    /// Whether images or scans were read.
    fn has_sensors(&self) -> bool {
        !self.images.is_empty() || !self.scans.is_empty()
    }

    fn take_image(&mut self, topic: &str, image: &BagImage) {
        let first = || ImageStamps {
            frame: image.frame.clone(),
            kind: image.kind(),
            encoding: image.encoding().to_owned(),
            stamps: Vec::new(),
        };
        self.images.entry(topic.to_owned()).or_insert_with(first).stamps.push(image.stamp);
    }

    /// The topics of images.
    pub(super) fn image_topics(&self) -> Vec<ImageTopic> {
        let topic = |(name, image): (&String, &ImageStamps)| ImageTopic {
            name: name.clone(),
            frame: image.frame.clone(),
            kind: image.kind,
            encoding: image.encoding.clone(),
            count: image.stamps.len(),
        };
        self.images.iter().map(topic).collect()
    }

    /// The stamps of a topic's images, sorted, each once.
    pub(super) fn stamps(&self, topic: &str) -> Vec<Stamp> {
        let mut stamps = self.images.get(topic).map_or_else(Vec::new, |image| image.stamps.clone());
        stamps.sort_unstable();
        stamps.dedup();
        stamps
    }
}
