//! The wedge that marks a pose.

/// A wedge about `center`, its tip `radius` px away along `angle` (picture axes: y down).
pub(crate) fn wedge(center: (f64, f64), radius: f64, angle: f64) -> [(f64, f64); 4] {
    [(1.0, 0.0), (0.8, 2.45), (0.35, std::f64::consts::PI), (0.8, -2.45)].map(|(length, turn)| {
        let (sin, cos) = (angle + turn).sin_cos();
        (center.0 + radius * length * cos, center.1 + radius * length * sin)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tip_points_along_the_angle() {
        let [tip, ..] = wedge((10.0, 20.0), 5.0, 0.0);
        assert_eq!(tip, (15.0, 20.0));
        let [tip, left, tail, right] = wedge((0.0, 0.0), 5.0, std::f64::consts::FRAC_PI_2);
        assert!(tip.0.abs() < 1e-9 && (tip.1 - 5.0).abs() < 1e-9);
        assert!((left.0 + right.0).abs() < 1e-9 && (left.1 - right.1).abs() < 1e-9, "it is symmetric");
        assert!(tail.1 < 0.0, "its tail is behind the centre");
    }
}
