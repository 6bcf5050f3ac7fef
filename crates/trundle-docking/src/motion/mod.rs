//! Motions from rest to rest, and manoeuvres made of motions.

pub(crate) mod limits;
pub(crate) mod manoeuvre;
