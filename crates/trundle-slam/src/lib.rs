//! From RGB-D frames to a camera trajectory and a landmark map.
