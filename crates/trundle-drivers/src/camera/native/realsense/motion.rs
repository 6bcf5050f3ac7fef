//! Samples of the gyro of a D435i or D455.

use crate::camera::GyroSample;
use std::collections::VecDeque;
use trundle_core::Stamp;

/// Maximum number of stored samples; older ones are dropped. Source: ours; 0.5 s at 400 Hz.
const MAX_SAMPLES: usize = 200;

/// The samples that the reader has not taken.
#[derive(Debug, Default)]
pub(super) struct GyroSamples {
    samples: VecDeque<GyroSample>,
    last: Option<Stamp>,
}

impl GyroSamples {
    /// Appends a sample. A sample with the stamp of the previous one is skipped: frame sets repeat samples.
    pub(super) fn push(&mut self, sample: GyroSample) {
        if self.last == Some(sample.device_stamp) {
            return;
        }
        self.last = Some(sample.device_stamp);
        if self.samples.len() >= MAX_SAMPLES {
            self.samples.pop_front();
        }
        self.samples.push_back(sample);
    }

    /// Stamp of the newest sample, also of one that was taken.
    pub(super) fn newest(&self) -> Option<Stamp> {
        self.last
    }

    /// All samples, oldest first.
    pub(super) fn take(&mut self) -> Vec<GyroSample> {
        self.samples.drain(..).collect()
    }
}
