//! Motions from rest to rest, and manoeuvres of them.

pub(crate) mod limits;
pub(crate) mod manoeuvre;
