//! A part of the runs of an experiment.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Part `index` of `count` parts of the runs of an experiment: every `count`-th run, starting with the `index`-th.
///
/// The text of a part is `K/N`, K from 1 to N.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct Shard {
    index: usize,
    count: usize,
}

/// Largest number of shards: more than any experiment has runs. Source: ours.
const MAX_SHARDS: usize = 1_000_000;

impl Shard {
    /// Whether the run at `place` of the plan, from 0, is one of this part.
    #[must_use]
    pub fn has(self, place: usize) -> bool {
        place % self.count == self.index - 1
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.trim().parse::<usize>().ok();
        let parts = text.split_once('/').and_then(|(index, count)| number(index).zip(number(count)));
        match parts {
            Some((index, count)) if (1..=count).contains(&index) && count <= MAX_SHARDS => {
                Ok(Self { index, count })
            }
            _ => Err(format!("'{text}', expected K/N, whole numbers, 1 <= K <= N <= {MAX_SHARDS}")),
        }
    }
}

impl From<Shard> for String {
    fn from(shard: Shard) -> Self {
        shard.to_string()
    }
}

impl TryFrom<String> for Shard {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_run_belongs_to_one_shard() {
        for count in 1..6 {
            let shards: Vec<Shard> = (1..=count).map(|k| format!("{k}/{count}").parse().unwrap()).collect();
            for place in 0..20 {
                assert_eq!(shards.iter().filter(|shard| shard.has(place)).count(), 1, "{place} of {count}");
            }
        }
    }

    #[test]
    fn a_part_beyond_the_whole_is_refused() {
        for wrong in ["0/3", "4/3", "1/0", "1", "a/b", "", "1/2/3", "-1/2", "1/9999999"] {
            assert!(wrong.parse::<Shard>().unwrap_err().contains("expected K/N"), "{wrong}");
        }
        assert_eq!(" 2 / 3".parse::<Shard>().unwrap().to_string(), "2/3");
    }
}
