//! A result file: `results/NAME.json`, what one command measures.

use serde::{Deserialize, Deserializer, Serialize};
use std::collections::BTreeMap;

/// The measurements by name.
pub type Measurements = BTreeMap<String, Measurement>;

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
    /// The value; NaN, `null` in the file, if the program gave none.
    #[serde(deserialize_with = "number_or_none")]
    pub value: f64,
    /// Whether the figure stands on the gallery only, not on the results page.
    #[serde(default, skip_serializing_if = "is_false")]
    pub detail: bool,
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
    /// Further peers, on the gallery only.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub more_peers: Vec<Peer>,
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
    /// The value, in the same unit; NaN, `null` in the file, if the peer gave none.
    #[serde(deserialize_with = "number_or_none")]
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
    /// JSON pointer into `summary.json` of a number by which the number is divided.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub over: Option<String>,
    /// Factor from the output's unit to the figure's.
    #[serde(default = "one")]
    pub scale: f64,
}

fn one() -> f64 {
    1.0
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "the form that serde asks for")]
fn is_false(value: &bool) -> bool {
    !value
}

/// JSON has no NaN: `null` stands for it.
fn number_or_none<'de, D: Deserializer<'de>>(input: D) -> Result<f64, D::Error> {
    Ok(Option::<f64>::deserialize(input)?.unwrap_or(f64::NAN))
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
        self.ratio_to(self.peer.as_ref()?)
    }

    /// As [`Figure::ratio`], to any peer.
    pub fn ratio_to(&self, peer: &Peer) -> Option<f64> {
        let peer = peer.value;
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
