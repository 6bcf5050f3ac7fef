//! Order of the entries of a log by their stamps.

use std::collections::VecDeque;
use trundle_core::Stamp;

/// Time by which an entry may come after one of a later stamp \[s\]. It is then sorted in; an older one is refused. Two queues of one
/// computer differ by less, a clock that was set by more. Source: ours.
const MAX_DISORDER_S: f64 = 0.05;

/// Inserts `entry` by its stamp, after those of the same stamp. `entries` are by rising stamps.
///
/// # Errors
/// When its stamp is more than [`MAX_DISORDER_S`] before the last one.
pub(crate) fn insert_in_order<T>(
    entries: &mut Vec<T>,
    entry: T,
    stamp_of: impl Fn(&T) -> Stamp,
) -> Result<(), String> {
    let stamp = stamp_of(&entry);
    require_order(entries.last().map(&stamp_of), stamp)?;
    let later = entries.iter().rev().take_while(|other| stamp_of(other) > stamp).count();
    entries.insert(entries.len() - later, entry);
    Ok(())
}

/// Refuses a stamp that is more than [`MAX_DISORDER_S`] before the `last` one.
///
/// # Errors
/// Names both stamps.
fn require_order(last: Option<Stamp>, stamp: Stamp) -> Result<(), String> {
    match last {
        Some(last) if last - stamp > MAX_DISORDER_S => {
            Err(format!("time goes back from {last} s to {stamp} s"))
        }
        _ => Ok(()),
    }
}

/// The entries of a log on their way into the order of their stamps. The buffer holds the entries of the last [`MAX_DISORDER_S`].
#[derive(Debug)]
pub(crate) struct OrderBuffer<T> {
    entries: VecDeque<(Stamp, T)>,
}

impl<T> Default for OrderBuffer<T> {
    fn default() -> Self {
        Self { entries: VecDeque::new() }
    }
}

impl<T> OrderBuffer<T> {
    /// Adds an entry, after those of the same stamp.
    ///
    /// # Errors
    /// As [`insert_in_order`].
    pub(crate) fn push(&mut self, stamp: Stamp, entry: T) -> Result<(), String> {
        self.require(stamp)?;
        let later = self.entries.iter().rev().take_while(|(other, _)| *other > stamp).count();
        self.entries.insert(self.entries.len() - later, (stamp, entry));
        Ok(())
    }

    /// Refuses a stamp that comes too late.
    ///
    /// # Errors
    /// As [`require_order`].
    pub(crate) fn require(&self, stamp: Stamp) -> Result<(), String> {
        require_order(self.entries.back().map(|(stamp, _)| *stamp), stamp)
    }

    /// The oldest entry, if no entry that may still come belongs before it.
    pub(crate) fn pop(&mut self) -> Option<(Stamp, T)> {
        let ((oldest, _), (newest, _)) = (self.entries.front()?, self.entries.back()?);
        if *newest - *oldest > MAX_DISORDER_S { self.entries.pop_front() } else { None }
    }

    /// The oldest entry of a log that has ended.
    pub(crate) fn pop_last(&mut self) -> Option<(Stamp, T)> {
        self.entries.pop_front()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_little_disorder_is_sorted_and_more_is_refused() {
        let stamp = |ms: i64| Stamp::from_nanos(ms * 1_000_000);
        let mut entries = Vec::new();
        let mut add = |ms: i64, name: char| insert_in_order(&mut entries, (stamp(ms), name), |entry| entry.0);
        for (ms, name) in [(1000, 'a'), (1200, 'b'), (1194, 'c'), (1200, 'd'), (1155, 'e'), (1300, 'f')] {
            add(ms, name).unwrap();
        }
        assert_eq!(add(1249, 'g').unwrap_err(), "time goes back from 1.300000000 s to 1.249000000 s");
        let names: String = entries.iter().map(|(_, name)| name).collect();
        assert_eq!(names, "aecbdf");
    }
    #[test]
    fn a_buffer_gives_the_entries_in_the_order_of_insertion_into_a_list() {
        let stamp = |ms: i64| Stamp::from_nanos(ms * 1_000_000);
        let (mut all, mut streamed, mut buffer) = (Vec::new(), Vec::new(), OrderBuffer::default());
        let mut bits = 7_u64;
        for k in 0..2000_i64 {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let at = stamp(10 * k - (bits >> 33) as i64 % 70);
            let inserted = insert_in_order(&mut all, (at, k), |(at, _)| *at);
            assert_eq!(buffer.push(at, k), inserted);
            streamed.extend(std::iter::from_fn(|| buffer.pop()));
            assert!(buffer.entries.len() < 20, "the buffer does not grow");
        }
        streamed.extend(std::iter::from_fn(|| buffer.pop_last()));
        assert_eq!(streamed, all);
    }
}
