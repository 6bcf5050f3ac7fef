//! Order of the entries of a log by their stamps.

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
pub(crate) fn require_order(last: Option<Stamp>, stamp: Stamp) -> Result<(), String> {
    match last {
        Some(last) if last - stamp > MAX_DISORDER_S => {
            Err(format!("time goes back from {last} s to {stamp} s"))
        }
        _ => Ok(()),
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
}
