//! Messages of the server to a page as JSON, besides the state.

use super::SettingText;
use serde::Serialize;
use trundle_core::{DriveLimits, Footprint, MapAnnotations};

/// A message of the server.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum Reply {
    /// The answer to a hello.
    Welcome(Box<Welcome>),
    /// The answer to a request.
    Answer {
        /// Of the request.
        id: u64,
        /// Why the request is refused; `None` for one that is carried out.
        #[serde(skip_serializing_if = "Option::is_none")]
        refusal: Option<String>,
        /// Number of the goal that is refused, from 0.
        #[serde(skip_serializing_if = "Option::is_none")]
        goal: Option<usize>,
    },
    /// A request without an answer is refused.
    Refused {
        /// Why.
        refusal: String,
    },
    /// Zones and named places of the map.
    Annotations {
        /// All of them.
        #[serde(flatten)]
        annotations: MapAnnotations,
    },
    /// The settings that may change while the robot runs.
    Settings {
        /// With their present values.
        settings: Vec<SettingText>,
    },
    /// States of the robot since some time ago.
    States {
        /// In the order of time.
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
    /// Outline of the robot.
    pub footprint: FootprintText,
    /// Highest speed \[m/s\].
    pub max_v: f64,
    /// Highest turn rate \[rad/s\].
    pub max_omega: f64,
    /// Content of the recording, in a word.
    pub recording: &'static str,
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

/// A state of the robot and when it began.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StateEntry {
    /// Time of the robot \[s\].
    pub time: f64,
    /// The state in one or two words.
    pub name: String,
    /// Why the robot does not move on.
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
            footprint,
            max_v: limits.v,
            max_omega: limits.omega,
            recording,
        }
    }
}
