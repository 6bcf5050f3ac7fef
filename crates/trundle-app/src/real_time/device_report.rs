//! Report of the drivers of a live body: what they read, dropped and lost.

use serde::Serialize;
use trundle_drivers::camera::camera_thread::CameraCounters;
use trundle_drivers::kobuki::BaseCounters;

/// Report of the drivers of a live body at the end of a run.
#[derive(Debug, Clone, Default, Serialize)]
#[non_exhaustive]
pub struct DeviceReport {
    /// Events on the line of a Kobuki; `None` for another base.
    #[serde(rename = "base_link", skip_serializing_if = "Option::is_none")]
    pub base: Option<BaseCounters>,
    /// Frames of the camera; `None` without a camera that trundle reads itself.
    #[serde(rename = "camera_frames", skip_serializing_if = "Option::is_none")]
    pub camera: Option<CameraCounters>,
    /// The last fault of the camera, in words; `None` for a camera without one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub camera_fault: Option<String>,
}

impl DeviceReport {
    /// The report of a camera.
    #[must_use]
    pub fn of_camera(camera: CameraCounters, camera_fault: Option<String>) -> Self {
        Self { base: None, camera: Some(camera), camera_fault }
    }

    /// The report with that of a base.
    #[must_use]
    pub fn with_base(self, base: BaseCounters) -> Self {
        Self { base: Some(base), ..self }
    }

    /// For the terminal and the page of the run.
    #[must_use]
    pub fn rows(&self) -> Vec<Vec<String>> {
        let base = self.base.iter().flat_map(base_rows);
        let mut rows: Vec<_> = base.chain(self.camera.iter().map(camera_row)).collect();
        rows.extend(self.camera_fault.clone().map(|fault| row("last fault of the camera", fault)));
        rows
    }
}

fn row(name: &str, value: String) -> Vec<String> {
    vec![name.to_owned(), value]
}

/// What was dropped on the line of a base.
pub(crate) fn base_rows(base: &BaseCounters) -> Vec<Vec<String>> {
    let decoder = base.decoder;
    vec![
        row(
            "base: bytes skipped, packets with a wrong checksum",
            format!("{}, {}", decoder.skipped_bytes, decoder.wrong_checksum),
        ),
        row(
            "base: links lost, attempts to open the port",
            format!("{}, {}", base.link_losses, base.reconnects),
        ),
        row(
            "base: commands dropped, events dropped",
            format!("{}, {}", base.commands_dropped, base.events_dropped),
        ),
        row(
            "base: jumps of its clock, faults of its stream",
            format!("{}, {}", base.clock_jumps, base.stream_faults),
        ),
    ]
}

/// What was dropped of a camera.
pub(crate) fn camera_row(camera: &CameraCounters) -> Vec<String> {
    let CameraCounters { dropped, broken, stuck, .. } = camera;
    row("camera: images dropped, broken, stuck", format!("{dropped}, {broken}, {stuck}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_counter_is_in_its_row_and_in_the_summary() {
        let mut base = BaseCounters::default();
        (base.decoder.skipped_bytes, base.decoder.wrong_checksum) = (11, 12);
        (base.link_losses, base.reconnects) = (13, 14);
        (base.commands_dropped, base.events_dropped) = (15, 16);
        (base.clock_jumps, base.stream_faults) = (17, 18);
        let camera = CameraCounters { frames: 21, dropped: 22, broken: 23, stuck: 24, lost: 25 };
        let report = DeviceReport::of_camera(camera, Some("it hangs".to_owned())).with_base(base);
        let values: Vec<String> = report.rows().into_iter().map(|mut row| row.remove(1)).collect();
        assert_eq!(values, ["11, 12", "13, 14", "15, 16", "17, 18", "22, 23, 24", "it hangs"]);
        let summary = serde_json::to_value(&report).unwrap();
        assert_eq!(summary["base_link"]["decoder"]["skipped_bytes"], 11);
        assert_eq!(summary["base_link"]["commands_dropped"], 15);
        assert_eq!(summary["camera_frames"]["lost"], 25);
        assert_eq!(summary["camera_fault"], "it hangs");
    }

    #[test]
    fn a_body_without_drivers_reports_nothing() {
        assert!(DeviceReport::default().rows().is_empty());
        assert_eq!(serde_json::to_value(DeviceReport::default()).unwrap(), serde_json::json!({}));
    }
}
