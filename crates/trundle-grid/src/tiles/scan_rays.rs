//! Rays of one scan in the base frame, in cells.

/// Rays of one scan, base frame, in cells: the input of [`crate::tiles::RayUpdate`].
#[derive(Debug, Clone, Default)]
pub struct ScanRays {
    /// Origin of the rays.
    pub origin: (f32, f32),
    /// Ends of the rays.
    pub rays: Vec<ScanRay>,
    /// Free stretches of the rays that are not [`ScanRay::whole`], by rising ray.
    pub spans: Vec<RaySpan>,
}

/// End of a ray.
#[derive(Debug, Clone, Copy)]
pub struct ScanRay {
    /// End, base frame, cells.
    pub x: f32,
    /// End, base frame, cells.
    pub y: f32,
    /// Whether the ray ends at an obstacle.
    pub hit: bool,
    /// Whether the end and the end of the previous ray are on one surface.
    pub joined: bool,
    /// Whether the whole ray was observed free. Otherwise the scan's spans list its free parts.
    pub whole: bool,
    /// Weight of the hit in its cell, 0 to 1; below 1 if the range noise spreads the hit over several cells.
    pub hit_weight: f32,
}

/// Free stretch of a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RaySpan {
    /// Index of the ray.
    pub ray: u32,
    /// Start, as a fraction of the ray from its origin to its end, 0 to 1.
    pub from: f32,
    /// End, as a fraction of the ray from its origin to its end, 0 to 1.
    pub to: f32,
}

impl ScanRays {
    /// Removes all rays and spans.
    pub fn clear(&mut self) {
        self.origin = (0.0, 0.0);
        self.rays.clear();
        self.spans.clear();
    }
}
