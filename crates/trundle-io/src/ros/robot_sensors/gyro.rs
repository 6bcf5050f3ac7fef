//! The gyro of a bag: turn rates around the base's vertical, of one topic with `sensor_msgs/Imu`.

use super::mount::BasePlace;
use crate::Warnings;
use crate::laser_log::{chosen, insert_in_order};
use crate::ros::cdr::{CdrError, Wire};
use crate::ros::imu::{ImuReading, read_imu};
use crate::ros::messages::types;
use nalgebra::UnitQuaternion;
use std::collections::BTreeMap;
use trundle_core::{GyroRate, Vector3};

/// The readings of all IMUs of a bag, by topic.
#[derive(Default)]
pub(in crate::ros) struct ImuTopics(BTreeMap<String, ImuTopic>);

/// The readings of a topic: number of the message, index of its frame, reading.
#[derive(Default)]
struct ImuTopic {
    frames: Vec<String>,
    readings: Vec<(usize, usize, ImuReading)>,
}

impl ImuTopics {
    /// Adds a message.
    ///
    /// # Errors
    /// When the bytes are no such message.
    pub(in crate::ros) fn take(
        &mut self,
        number: usize,
        topic: &str,
        bytes: &[u8],
        wire: Wire,
    ) -> Result<(), CdrError> {
        let (frame, reading) = read_imu(bytes, wire)?;
        let imu = self.0.entry(topic.to_owned()).or_default();
        let known = imu.frames.iter().position(|known| *known == frame);
        let index = known.unwrap_or_else(|| {
            imu.frames.push(frame);
            imu.frames.len() - 1
        });
        imu.readings.push((number, index, reading));
        Ok(())
    }

    fn counts(&self) -> BTreeMap<String, usize> {
        self.0.iter().map(|(topic, imu)| (topic.clone(), imu.readings.len())).collect()
    }
}

/// The topic and the rates of the requested gyro, or of the one with the largest number of usable readings; `None` if no reading is
/// usable. Each kind of unusable readings gives a warning.
///
/// # Errors
/// When the requested topic does not exist.
pub(in crate::ros) fn choose_gyro(
    imus: &ImuTopics,
    asked: Option<&str>,
    place: &BasePlace<'_>,
    warnings: &mut Warnings,
) -> Result<Option<(String, Vec<GyroRate>)>, String> {
    let asked = asked.map(|asked| chosen(&imus.counts(), Some(asked), types::IMU)).transpose()?;
    let candidates = imus.0.iter().filter(|(topic, _)| asked.as_ref().is_none_or(|asked| asked == *topic));
    let read: Vec<_> = candidates.map(|(topic, imu)| (topic, imu.rates(topic, place))).collect();
    let most = read.iter().map(|(_, (rates, _))| rates.len()).max().unwrap_or(0);
    let found = read.iter().position(|(_, (rates, _))| most > 0 && rates.len() == most);
    for (i, (topic, (rates, problems))) in read.into_iter().enumerate() {
        if found.is_none_or(|found| found == i) {
            warnings.extend(problems);
        }
        if found == Some(i) {
            return Ok(Some((topic.clone(), rates)));
        }
    }
    Ok(None)
}

impl ImuTopic {
    /// The usable rates by rising stamps, and the problems of the others.
    fn rates(&self, topic: &str, place: &BasePlace<'_>) -> (Vec<GyroRate>, Warnings) {
        let (mut rates, mut warnings) = (Vec::new(), Warnings::default());
        let mounts: Vec<_> =
            self.frames.iter().map(|frame| place.base_from(frame).map(|pose| pose.rotation)).collect();
        if self.readings.iter().all(|(.., reading)| reading.angular_velocity == Vector3::zeros()) {
            let problem = format!(
                "gyro on {topic}: all {} turn rates are 0 0 0 rad/s, expected those of a gyro; the gyro is unused",
                self.readings.len()
            );
            warnings.add(&problem, "");
            return (rates, warnings);
        }
        for (number, frame, reading) in &self.readings {
            let added = add(&mut rates, reading, &mounts[*frame], place);
            if let Err(problem) = added {
                let problem = format!("gyro on {topic}: {problem}; the reading is left out");
                warnings.add(&problem, &format!("message {number}"));
            }
        }
        (rates, warnings)
    }
}

/// Adds the rate of a reading.
fn add(
    rates: &mut Vec<GyroRate>,
    reading: &ImuReading,
    mount: &Result<UnitQuaternion<f64>, String>,
    place: &BasePlace<'_>,
) -> Result<(), String> {
    place.require_clock(reading.stamp)?;
    let base_from_imu = mount.as_ref().map_err(String::clone)?;
    let rate = reading.gyro_rate(base_from_imu).map_err(|invalid| invalid.to_string())?;
    insert_in_order(rates, rate, |rate| rate.stamp)
}
