//! From depth images to scans, and from scans to an occupancy grid.
