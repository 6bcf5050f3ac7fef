//! Messages of the server to a page as JSON, besides the state.

use super::SettingText;
use crate::run_facts::RunKind;
use serde::Serialize;
use trundle_app::RecordingState;
use trundle_app::operator::{EndedRun, SeriesView};
use trundle_core::{DriveLimits, Footprint, MapAnnotations};

/// A message of the server.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum Reply {
    /// The answer to a hello.
    Welcome(Box<Welcome>),
    /// The answer to a request.
    Answer {
        /// Number of the request.
        id: u64,
        /// Reason for the refusal; `None` for an accepted request.
        #[serde(skip_serializing_if = "Option::is_none")]
        refusal: Option<String>,
        /// Number of the goal that is refused, from 0.
        #[serde(skip_serializing_if = "Option::is_none")]
        goal: Option<usize>,
    },
    /// A request without an answer is refused.
    Refused {
        /// Reason for the refusal.
        refusal: String,
    },
    /// Zones and named places of the map.
    Annotations {
        /// All zones and places.
        #[serde(flatten)]
        annotations: MapAnnotations,
    },
    /// The settings that may change while the robot runs.
    Settings {
        /// All settings with their present values.
        settings: Vec<SettingText>,
    },
    /// Progress of the series that contains the run.
    Series(SeriesText),
    /// State of the recording.
    Recording(RecordingText),
    /// The run has a depth camera whose images can be drawn in space.
    DepthCamera,
    /// States of the robot since some time ago.
    States {
        /// States in the order of time.
        states: Vec<StateEntry>,
    },
}

/// The answer to a hello.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Welcome {
    /// Version of the messages.
    pub version: u32,
    /// Version of the program.
    pub program: &'static str,
    /// The run.
    pub title: String,
    /// Whether this viewer may drive.
    pub drives: bool,
    /// Whether the run takes commands.
    pub is_steered: bool,
    /// Kind of the run.
    pub kind: RunKind,
    /// Outline of the robot.
    pub footprint: FootprintText,
    /// Highest speed \[m/s\].
    pub max_v: f64,
    /// Highest turn rate \[rad/s\].
    pub max_omega: f64,
    /// Content of the recording, in a word.
    pub recording: &'static str,
}

/// A series of steps or runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SeriesText {
    /// Name of the counted things.
    pub unit: &'static str,
    /// Number of finished ones.
    pub done: usize,
    /// Total number; `None` if unknown.
    pub total: Option<usize>,
    /// Number of runs that were shown before this one.
    pub number: u64,
    /// Name of the displayed run; empty for a single run.
    pub shown: String,
    /// Number of runs that have ended.
    pub ended: usize,
    /// The last finished runs, in the order of their ends.
    pub last: Vec<EndedRunText>,
}

/// State of a run's recording.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct RecordingText {
    /// Whether a file is being written.
    pub on: bool,
    /// Name of the present or last file.
    pub file: Option<String>,
    /// Reason why the recording is off, unless a person switched it off.
    pub reason: Option<String>,
    /// Free space of the disk \[MB\].
    pub free_mb: Option<u64>,
}

/// Number of bytes in a megabyte. Source: SI.
const BYTES_PER_MB: u64 = 1_000_000;

impl RecordingText {
    /// The text of a state.
    pub fn of(state: &RecordingState) -> Self {
        let RecordingState { is_on: on, file, reason, free_bytes, .. } = state.clone();
        Self { on, file, reason, free_mb: free_bytes.map(|bytes| bytes / BYTES_PER_MB) }
    }
}

/// A run that has ended.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct EndedRunText {
    /// Name of the run.
    pub name: String,
    /// Whether the run succeeded.
    pub is_success: bool,
    /// Result of the run, in one sentence.
    pub text: String,
}

/// Maximum number of ended runs that are sent: some 10 kB. Source: ours.
const MAX_ENDED_RUNS: usize = 100;

impl SeriesText {
    /// The text of a series.
    pub fn of(series: &SeriesView) -> Self {
        let text = |run: &EndedRun| {
            let EndedRun { name, is_success, text } = run.clone();
            EndedRunText { name, is_success, text }
        };
        let skipped = series.ended.len().saturating_sub(MAX_ENDED_RUNS);
        Self {
            unit: series.unit,
            done: series.done,
            total: series.total,
            number: series.number,
            shown: series.shown.clone(),
            ended: series.ended.len(),
            last: series.ended.iter().skip(skipped).map(text).collect(),
        }
    }
}

/// The outline of the robot, base frame \[m\].
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FootprintText {
    /// Radius of a disc.
    Disc(f64),
    /// Corners of a polygon.
    Polygon(Vec<[f64; 2]>),
}

/// A state of the robot and its start.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StateEntry {
    /// Time of the robot \[s\].
    pub time: f64,
    /// The state in one or two words.
    pub name: String,
    /// Reason why the robot does not move, or for the change to a state with motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

impl Welcome {
    /// A welcome with the robot's outline and limits.
    pub fn new(title: String, footprint: &Footprint, limits: DriveLimits, recording: &'static str) -> Self {
        let footprint = match footprint {
            Footprint::Disc { radius } => FootprintText::Disc(*radius),
            Footprint::Polygon { corners } => {
                FootprintText::Polygon(corners.iter().map(|corner| [corner.x, corner.y]).collect())
            }
        };
        Self {
            version: super::WIRE_VERSION,
            program: env!("CARGO_PKG_VERSION"),
            title,
            drives: false,
            is_steered: false,
            kind: RunKind::Robot,
            footprint,
            max_v: limits.v,
            max_omega: limits.omega,
            recording,
        }
    }
}
