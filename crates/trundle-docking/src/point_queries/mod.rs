//! Contact queries among many points.
//!
//! Problem: a plan makes ten thousand queries among a hundred thousand points. Idea: the points are in a tree of boxes. A box is skipped as
//! a whole if the hull's lookup table ([`HullProfile`]) excludes a contact, or one before a known contact. The remaining points, about ten
//! per query, are evaluated in closed form. The answers equal those of all points, up to [`SAME_CONTACT`].

pub(crate) mod headings;
pub(crate) mod limits;
pub(crate) mod straight;
pub(crate) mod turn;
