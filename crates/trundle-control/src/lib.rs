//! From a trajectory and a pose to a twist: tracking, point stabilisation, limits, safe stop.
