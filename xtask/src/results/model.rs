//! A result file: `results/NAME.json`, what one command measures.

use serde::{Deserialize, Serialize};

/// Measurements of one command.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measurement {
    /// The heading of the results page that contains the result.
    pub subject: String,
    /// The quantity, in words.
    pub title: String,
    /// The command, from the workspace's folder; `trundle` is the release program.
    pub command: String,
    /// The commit of the program that was measured.
    pub commit: String,
    /// The machine.
    pub machine: String,
    /// The day, as YYYY-MM-DD.
    pub date: String,
    /// The figures.
    pub figures: Vec<Figure>,
}

/// One figure.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Figure {
    /// The name.
    pub name: String,
    /// The value.
    pub value: f64,
    /// Unit of the figure; empty for counts.
    pub unit: String,
    /// The goal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub goal: Option<Goal>,
    /// Better direction, if no goal determines it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub better: Option<Better>,
    /// Another program's or paper's figure.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub peer: Option<Peer>,
    /// Place of the figure in the command's output; without it, the figure is copied by hand.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<Source>,
}

/// The goal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Goal {
    /// The value must be at most this.
    AtMost(f64),
    /// The value must be at least this.
    AtLeast(f64),
}

/// Better direction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Better {
    /// Small values are.
    Less,
    /// Large values are.
    More,
}

/// Another program's or paper's figure.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Peer {
    /// Name of the peer.
    pub name: String,
    /// The value, in the same unit.
    pub value: f64,
    /// Whether the command measures the peer in the same run.
    #[serde(default)]
    pub same_run: bool,
    /// Place of the figure in the command's output.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<Source>,
}

/// Place of a number in an output.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Source {
    /// JSON pointer into the output folder's `summary.json`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub summary: Option<String>,
    /// Text on standard output that precedes the number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub after: Option<String>,
    /// Factor from the output's unit to the figure's.
    #[serde(default = "one")]
    pub scale: f64,
}

fn one() -> f64 {
    1.0
}

impl Goal {
    /// Whether a value meets the goal.
    pub fn is_kept_by(self, value: f64) -> bool {
        match self {
            Self::AtMost(limit) => value <= limit,
            Self::AtLeast(limit) => value >= limit,
        }
    }
}

impl Figure {
    /// Ratio to the peer's figure; above 1 is better. `None` without a peer, or without a better direction.
    pub fn ratio(&self) -> Option<f64> {
        let peer = self.peer.as_ref()?.value;
        let better = self.better.or(self.goal.map(|goal| match goal {
            Goal::AtMost(_) => Better::Less,
            Goal::AtLeast(_) => Better::More,
        }))?;
        let ratio = match better {
            Better::Less => peer / self.value,
            Better::More => self.value / peer,
        };
        ratio.is_finite().then_some(ratio)
    }
}
