//! Samples of the gyro of a D435i or D455.

use std::collections::VecDeque;
use trundle_core::{Stamp, Vector3};

/// Maximum number of stored samples; older ones are dropped. Source: ours; 3 s at 30 Hz.
const MAX_SAMPLES: usize = 90;

/// A sample of the gyro.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GyroSample {
    /// Time of the sample on the clock of the images.
    pub device_stamp: Stamp,
    /// Turn rate around the axes of the depth camera \[rad/s\].
    pub rate: Vector3,
}

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

    /// All samples, oldest first.
    pub(super) fn take(&mut self) -> Vec<GyroSample> {
        self.samples.drain(..).collect()
    }
}
