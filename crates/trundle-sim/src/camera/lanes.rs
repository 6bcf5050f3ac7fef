//! Rays of one image row against one solid, several at a time: plain loops that the compiler turns into SIMD.

/// Rays in a row of a tile.
pub(super) const LANES: usize = 16;

/// "Nothing" among the [`Lanes`]' parts.
pub(super) const NOTHING: u32 = u32::MAX;

/// Parts of a cylinder in [`Lanes`].
pub(super) const SIDE: u32 = 0;
pub(super) const LID: u32 = 1;

/// The nearest solid of each ray so far.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lanes {
    /// Depth along the optical axis, m.
    pub(super) depth: [f32; LANES],
    /// 4 times the index of the solid, plus its part: the axis of a box's face, or [`SIDE`] or [`LID`]; or [`NOTHING`].
    pub(super) part: [u32; LANES],
}

impl Lanes {
    pub(super) fn empty() -> Self {
        Self { depth: [f32::INFINITY; LANES], part: [NOTHING; LANES] }
    }

    /// Depth of the farthest ray.
    pub(super) fn reach(&self) -> f32 {
        self.depth.iter().fold(0.0, |reach, &depth| larger(reach, depth))
    }

    fn keep(&mut self, lane: usize, depth: f32, is_met: bool, part: u32) {
        let is_nearer = is_met & (depth > 0.0) & (depth < self.depth[lane]);
        self.depth[lane] = if is_nearer { depth } else { self.depth[lane] };
        self.part[lane] = if is_nearer { part } else { self.part[lane] };
    }
}

/// Slabs (Kay and Kajiya 1986): the box is entered where the last of three pairs of planes is.
pub(super) fn meet_cuboid(
    origin: [f32; 3],
    half: [f32; 3],
    start: [f32; 3],
    step: [f32; 3],
    solid: u32,
    lanes: &mut Lanes,
) {
    let low = [0, 1, 2].map(|k| -half[k] - origin[k]);
    let high = [0, 1, 2].map(|k| half[k] - origin[k]);
    for lane in 0..LANES {
        let (mut near, mut far, mut axis) = (f32::NEG_INFINITY, f32::INFINITY, 0);
        for k in 0..3 {
            let inverse = 1.0 / (start[k] + lane as f32 * step[k]);
            let (a, b) = (low[k] * inverse, high[k] * inverse);
            let entry = smaller(a, b);
            axis = if entry > near { k as u32 } else { axis };
            near = larger(near, entry);
            far = smaller(far, larger(a, b));
        }
        lanes.keep(lane, near, near <= far, 4 * solid + axis);
    }
}

/// The side, where the plan's distance to the axis (as a cross product: no cancellation) is below the radius; the lids.
pub(super) fn meet_cylinder(
    o: [f32; 3],
    (radius, height): (f32, f32),
    start: [f32; 3],
    step: [f32; 3],
    solid: u32,
    lanes: &mut Lanes,
) {
    for lane in 0..LANES {
        let d = [0, 1, 2].map(|k| start[k] + lane as f32 * step[k]);
        let a = d[0] * d[0] + d[1] * d[1];
        let across = o[0] * d[1] - o[1] * d[0];
        let root2 = a * radius * radius - across * across;
        let side = (-(o[0] * d[0] + o[1] * d[1]) - larger(root2, 0.0).sqrt()) / a;
        let z = o[2] + side * d[2];
        lanes.keep(lane, side, (root2 >= 0.0) & (z >= 0.0) & (z <= height), 4 * solid + SIDE);
        let lid = ((if d[2] < 0.0 { height } else { 0.0 }) - o[2]) / d[2];
        let (x, y) = (o[0] + lid * d[0], o[1] + lid * d[1]);
        lanes.keep(lane, lid, x * x + y * y <= radius * radius, 4 * solid + LID);
    }
}

/// `f32::min` without its care for NaN, which costs instructions.
fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// `f32::max` without its care for NaN, which costs instructions.
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
