//! Contact queries among many points.
//!
//! Problem: a plan asks ten thousand queries among a hundred thousand points. Idea: the points are in a tree of boxes. A box that
//! the hull's lookup table ([`HullProfile`]) cannot touch, or not before a known contact, is skipped as a whole. The
//! remaining points, about ten per query, go through the closed forms. The answers are those of all points, up to
//! [`SAME_CONTACT`].

pub(crate) mod headings;
pub(crate) mod limits;
pub(crate) mod straight;
pub(crate) mod turn;
