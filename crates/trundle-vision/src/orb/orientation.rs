use super::patch::{Patch, RADIUS, STRIDE};

/// Which way a patch points: from its middle to its centre of mass \[Rosin99\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Direction {
    /// Rad, x right, y down.
    pub angle: f32,
    pub cos: f32,
    pub sin: f32,
}

/// The direction of the intensity centroid within the disc; along x where there is none.
pub(crate) fn direction(patch: &Patch) -> Direction {
    let (m10, m01) = moments(patch);
    let (x, y) = (m10 as f32, m01 as f32);
    let length = (x * x + y * y).sqrt();
    if length == 0.0 {
        return Direction { angle: 0.0, cos: 1.0, sin: 0.0 };
    }
    Direction { angle: y.atan2(x), cos: x / length, sin: y / length }
}

/// m_10 and m_01: sums of x I(x, y) and y I(x, y) over the disc, from its middle \[Rublee11, eq. 1\].
fn moments(patch: &Patch) -> (i32, i32) {
    let (mut m10, mut m01) = (0, 0);
    for ((value, x), y) in patch.iter().zip(&WEIGHTS.0).zip(&WEIGHTS.1) {
        m10 += i32::from(*value) * i32::from(*x);
        m01 += i32::from(*value) * i32::from(*y);
    }
    (m10, m01)
}

type Weights = [i16; STRIDE * STRIDE];

/// x and y of each pixel from the middle, zero outside the disc.
static WEIGHTS: (Weights, Weights) = weights();

const fn weights() -> (Weights, Weights) {
    let (mut across, mut down) = ([0; STRIDE * STRIDE], [0; STRIDE * STRIDE]);
    let radius = RADIUS as i16;
    let mut i = 0;
    while i < STRIDE * STRIDE {
        let (x, y) = ((i % STRIDE) as i16 - radius, (i / STRIDE) as i16 - radius);
        if x * x + y * y <= radius * radius {
            (across[i], down[i]) = (x, y);
        }
        i += 1;
    }
    (across, down)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn patch(value: impl Fn(f32, f32) -> f32) -> Patch {
        std::array::from_fn(|i| {
            let middle = RADIUS as f32;
            value((i % STRIDE) as f32 - middle, (i / STRIDE) as f32 - middle) as u8
        })
    }

    #[test]
    fn a_ramp_points_uphill() {
        for degrees in (-175..180).step_by(10) {
            let (sin, cos) = (degrees as f32).to_radians().sin_cos();
            let found = direction(&patch(|x, y| 128.0 + 5.0 * (x * cos + y * sin)));
            assert!((found.angle.to_degrees() - degrees as f32).abs() < 0.5, "{degrees}: {found:?}");
            assert!((found.cos - cos).abs() < 0.01 && (found.sin - sin).abs() < 0.01);
        }
    }

    #[test]
    fn a_flat_patch_and_what_lies_outside_the_disc_do_not_point() {
        let flat = Direction { angle: 0.0, cos: 1.0, sin: 0.0 };
        assert_eq!(direction(&patch(|_, _| 90.0)), flat);
        assert_eq!(direction(&patch(|x, y| if x * x + y * y > 225.0 { 9.0 + x } else { 50.0 })), flat);
    }
}
