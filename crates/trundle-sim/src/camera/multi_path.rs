//! The multi-path error of a time-of-flight camera in concave corners.

use super::View;

/// Range of the light from a neighbouring wall, px. Source: ours.
const REACH_PX: usize = 24;

/// Neighbours whose depth differs by more than this share belong to another surface. Source: ours.
const OTHER_SURFACE: f32 = 0.2;

/// The depths of row `y` with multi-path: in concave corners the light that travels over the other wall makes
/// the measured distance longer.
///
/// Adds the corner's sagitta over [`REACH_PX`] px on either side, times `strength`; planes and convex edges do not change. The shape
/// (rounded corners, centimetres deep) is that of measured corners \[Sarbolandi15, Wasenmueller16\]; the model is ours.
pub(super) fn lengthen(view: &View, y: usize, strength: f32, out: &mut Vec<f32>) {
    let at = |x: usize, y: usize| view.depth[y * view.width + x];
    out.clear();
    out.extend((0..view.width).map(|x| {
        let z = at(x, y);
        let mut sagitta = 0.0_f32;
        if x >= REACH_PX && x + REACH_PX < view.width {
            sagitta = sagitta.max(concave(at(x - REACH_PX, y), z, at(x + REACH_PX, y)));
        }
        if y >= REACH_PX && y + REACH_PX < view.height {
            sagitta = sagitta.max(concave(at(x, y - REACH_PX), z, at(x, y + REACH_PX)));
        }
        z + strength * sagitta
    }));
}

/// Depth of the middle relative to the plane through both sides (in which inverse depth is affine), m.
fn concave(before: f32, z: f32, after: f32) -> f32 {
    let is_other = |side: f32| (side - z).abs() > OTHER_SURFACE * z;
    if z <= 0.0 || is_other(before) || is_other(after) {
        return 0.0;
    }
    let plane = 2.0 / (1.0 / before + 1.0 / after);
    (z - plane).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bias(inverse: impl Fn(f32) -> f32) -> Vec<f32> {
        let depth: Vec<f32> = (0..200).map(|x| 1.0 / inverse(x as f32)).collect();
        let view = View { width: 200, height: 1, depth, color: vec![[0; 3]; 200], cosine: vec![1.0; 200] };
        let mut out = Vec::new();
        lengthen(&view, 0, 0.5, &mut out);
        out.iter().zip(&view.depth).map(|(a, b)| a - b).collect()
    }

    #[test]
    fn corners_are_rounded_and_planes_stay() {
        let plane = bias(|x| 0.3 + 0.002 * x);
        assert!(plane.iter().all(|b| b.abs() < 1e-5), "{plane:?}");
        let concave = bias(|x| 0.4 + 0.0015 * (x - 100.0).abs());
        assert!((0.05..0.15).contains(&concave[100]) && concave[130] < 1e-5, "{}", concave[100]);
        assert!(concave[100] > concave[110] && concave[110] > concave[120]);
        let convex = bias(|x| 0.6 - 0.0015 * (x - 100.0).abs());
        assert!(convex.iter().all(|b| b.abs() < 1e-5));
    }
}
