//! Legs: straight moves with the turns between them, and the docking query.

pub(crate) mod leg_sequence;
pub(crate) mod query;

#[cfg(test)]
mod tests;
