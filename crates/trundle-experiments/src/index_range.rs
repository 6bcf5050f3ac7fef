//! A range of numbers, both ends included.

use std::fmt;
use std::str::FromStr;

/// A range of numbers, both ends included.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct IndexRange {
    /// The first.
    pub first: u64,
    /// The last, not below the first.
    pub last: u64,
}

impl fmt::Display for IndexRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}-{}", self.first, self.last)
    }
}

impl FromStr for IndexRange {
    type Err = String;

    /// `FIRST-LAST`, or a single number.
    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.trim().parse::<u64>().ok();
        let (first, last) = text.split_once('-').unwrap_or((text, text));
        match (number(first), number(last)) {
            (Some(first), Some(last)) if first <= last => Ok(Self { first, last }),
            _ => Err(format!("'{text}', expected FIRST-LAST, whole numbers, the last not below the first")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_two_rising_numbers_or_one() {
        assert_eq!("3-7".parse(), Ok(IndexRange { first: 3, last: 7 }));
        assert_eq!("5".parse(), Ok(IndexRange { first: 5, last: 5 }));
        for wrong in ["7-3", "a-3", "", "-1", "1-2-3"] {
            assert!(wrong.parse::<IndexRange>().unwrap_err().contains("expected FIRST-LAST"), "{wrong}");
        }
    }
}
