//! Depth cameras behind one trait.
