//! Coordinates of a map that are longitude and latitude by mistake.

/// Largest extent of a site in longitude and latitude \[deg\]: 0.5 km. Shapes of a map are larger in m. Source: ours.
const MAX_SITE_DEG: f64 = 0.005;
/// Largest longitude and latitude \[deg\]. Source: RFC 7946.
const MAX_DEG: [f64; 2] = [180.0, 90.0];

/// The cause of points \[m\] so close together that they are longitude and latitude; `None` for points farther apart, and for one point.
#[must_use]
pub fn degrees_hint(points: &[[f64; 2]]) -> Option<String> {
    let span = |axis: usize| {
        let values = points.iter().map(|point| point[axis]);
        values.clone().fold(f64::NEG_INFINITY, f64::max) - values.fold(f64::INFINITY, f64::min)
    };
    let are_close = points.len() > 1 && span(0).max(span(1)) < MAX_SITE_DEG;
    let are_angles = points.iter().all(|point| (0..2).all(|axis| point[axis].abs() <= MAX_DEG[axis]));
    let is_off_origin = points.iter().any(|point| point.iter().any(|value| value.abs() > MAX_SITE_DEG));
    (are_close && are_angles && is_off_origin).then(|| {
        format!(
            "all points lie within {:.1} mm: are they longitude and latitude in degrees? expected x and y of the map in m",
            span(0).max(span(1)) * 1e3
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_a_building_in_degrees_are_named_and_metres_are_not() {
        let hint = degrees_hint(&[[8.5401, 47.3701], [8.5404, 47.3702]]).unwrap();
        assert!(hint.starts_with("all points lie within 0.3 mm: are they longitude and latitude"), "{hint}");
        assert_eq!(degrees_hint(&[[8.5, 47.3], [8.6, 47.3]]), None);
        assert_eq!(degrees_hint(&[[8.5, 47.3]]), None, "one point alone has no extent");
        assert_eq!(degrees_hint(&[[200.0, 47.3], [200.0, 47.3001]]), None);
    }
}
