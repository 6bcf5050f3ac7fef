//! Status of a running base: counters, versions, the last packet.

use super::decoder::DecoderCounters;
use super::protocol::{Feedback, Gains, UniqueId, Version};
use serde::Serialize;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Facts that the base reports about itself.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Versions {
    /// Version of the hardware.
    pub hardware: Option<Version>,
    /// Version of the firmware.
    pub firmware: Option<Version>,
    /// Unique id.
    pub unique_id: Option<UniqueId>,
}

/// Oldest firmware without known faults according to the vendor: 1.1.4. An older one of the same protocol drives, so it is warned of and not
/// refused, as in the vendor's driver. Source: the vendor's driver, recommended versions 1.1.4 and 1.2.0.
const MIN_FIRMWARE: Version = Version::new(1, 1, 4);
/// Page of the vendor on updates of the firmware.
pub(super) const FIRMWARE_PAGE: &str = "kobuki.readthedocs.io/en/devel/firmware.html";

impl Versions {
    /// The reason why the firmware is not recommended by the vendor, with the remedy; `None` for a recommended one.
    pub fn firmware_fault(&self) -> Option<String> {
        match self.firmware {
            Some(firmware) if firmware >= MIN_FIRMWARE => None,
            Some(firmware) => Some(format!(
                "the base's firmware is {firmware}, expected {MIN_FIRMWARE} or later: it drives, with faults that its maker has mended; \
                 update it, see {FIRMWARE_PAGE}"
            )),
            None => Some(format!(
                "the base does not report its firmware's version, expected {MIN_FIRMWARE} or later: update it, see {FIRMWARE_PAGE}"
            )),
        }
    }

    /// Updates the status from a packet.
    pub(super) fn update(&mut self, feedback: &Feedback) {
        self.hardware = feedback.hardware.or(self.hardware);
        self.firmware = feedback.firmware.or(self.firmware);
        self.unique_id = feedback.unique_id.or(self.unique_id);
    }

    pub(super) fn is_complete(&self) -> bool {
        self.hardware.is_some() && self.firmware.is_some() && self.unique_id.is_some()
    }
}

/// Events on the link to a base since the start.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct BaseCounters {
    /// Counts of bytes read and dropped.
    pub decoder: DecoderCounters,
    /// Speeds sent.
    pub speeds_sent: u64,
    /// Number of commands dropped because the link was lost.
    pub commands_dropped: u64,
    /// Events dropped because the sink was too slow.
    pub events_dropped: u64,
    /// Lost links.
    pub link_losses: u64,
    /// Attempts to open the port again.
    pub reconnects: u64,
    /// Jumps of the base's clock, its restarts among them.
    pub clock_jumps: u64,
    /// Number of times that the stream began to look like that of a port with two users.
    pub stream_faults: u64,
}

/// State that the threads of a base share.
#[derive(Debug, Clone, Default)]
pub(super) struct Status {
    pub(super) counters: BaseCounters,
    pub(super) versions: Versions,
    pub(super) gains: Option<Gains>,
    pub(super) latest: Option<Feedback>,
    pub(super) is_up: bool,
    pub(super) is_stopping: bool,
}

/// The lock of `mutex`; a panic of another thread while it held the lock is not a reason for a second one.
pub(super) fn locked(mutex: &Mutex<Status>) -> MutexGuard<'_, Status> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
