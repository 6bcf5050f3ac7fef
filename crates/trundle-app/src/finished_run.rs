//! A run that has ended, and the cost of its recording.

use crate::{BestView, RunLog};
use std::time::Duration;
use trundle_io::IoError;
use trundle_runtime::{Histogram, Robot, TaskRecord};

/// A run that has ended.
pub struct FinishedRun {
    /// The robot, with its map and plan.
    pub robot: Robot,
    /// The log.
    pub log: RunLog,
    /// The tasks that ended in missions that an operator replaced, in order.
    pub earlier_tasks: Vec<TaskRecord>,
    /// The view with the largest number of tracked features.
    pub view: BestView,
    /// Wall-clock time of the run \[s\].
    pub seconds: f64,
    /// The cost of recording.
    pub recording: RecordingCost,
    /// Place at which the replayed recording is cut, in a sentence; `None` for a complete recording and for a live run.
    pub cut: Option<String>,
}

impl FinishedRun {
    /// The tasks that ended, in order.
    pub fn tasks(&self) -> impl Iterator<Item = &TaskRecord> {
        self.earlier_tasks.iter().chain(self.robot.tasks_ended())
    }
}

/// The cost of recording a run.
#[derive(Debug, Default)]
pub struct RecordingCost {
    /// Lines that waited for the disk, counted each time a line was written.
    pub queue_lengths: Histogram,
    /// Lines left out because the disk could not follow.
    pub lines_lost: u64,
    /// Processor time of the recorder's thread; 0 without a thread.
    pub cpu_time: Duration,
    /// The reason for an incomplete recording; `None` for a complete one.
    pub error: Option<IoError>,
    /// Names of the incomplete files.
    pub failed_files: Vec<String>,
    /// The reason for a missing last checkpoint; `None` if the checkpoint was written.
    pub checkpoint_error: Option<IoError>,
}
