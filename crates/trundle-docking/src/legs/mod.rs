//! Legs: straight moves with the turns between them, and the query that they answer.

pub(crate) mod leg_sequence;
pub(crate) mod query;

#[cfg(test)]
mod tests;
