//! Loop closing: candidates along the trajectory, their verification by scan matching, and the stored scans.

mod candidates;
pub(crate) mod crowded_places;
pub(crate) mod dropped_scans;
pub(crate) mod loop_closer;
pub(crate) mod scan_history;
pub(crate) mod stored_scan;
mod submap;

#[cfg(test)]
mod tests;
