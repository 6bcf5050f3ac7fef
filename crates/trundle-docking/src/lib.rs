//! Fine positioning in narrow spaces: rotations and straight moves, footprint-exact.
