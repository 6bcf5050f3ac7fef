//! Curves: Bezier pieces, free corridors, the quadratic program, and routes of curves and turns.

pub(crate) mod analytic_curve;
pub(crate) mod bezier;
pub(crate) mod corridor;
pub(crate) mod fit;
pub(crate) mod half_plane;
pub(crate) mod phase;
pub(crate) mod route;
