//! Named areas of a map: a GeoJSON file.

use serde_json::{Value, json};
use trundle_core::Vector2;

/// A named area of the map frame.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedArea {
    /// The name.
    pub name: String,
    /// Its area \[m^2\].
    pub area_m2: f64,
    /// Outer ring, then holes \[m\]; the first corner is not repeated.
    pub rings: Vec<Vec<Vector2>>,
}

/// Areas as a GeoJSON FeatureCollection (RFC 7946) of polygons with coordinates of the map frame in m. Each feature has its number as `id`
/// and the properties `kind` (`room`), `name` and `area_m2`.
#[must_use]
pub fn areas_text(areas: &[NamedArea]) -> String {
    let features: Vec<String> =
        areas.iter().enumerate().map(|(i, area)| feature(i + 1, area).to_string()).collect();
    format!("{{\"type\":\"FeatureCollection\",\"features\":[\n{}\n]}}\n", features.join(",\n"))
}

fn feature(id: usize, area: &NamedArea) -> Value {
    let rings: Vec<Vec<[f64; 2]>> = area.rings.iter().map(|ring| closed(ring)).collect();
    json!({
        "type": "Feature",
        "id": id,
        "properties": {"kind": "room", "name": area.name, "area_m2": tidy(area.area_m2)},
        "geometry": {"type": "Polygon", "coordinates": rings},
    })
}

/// A ring whose last corner is its first one.
fn closed(ring: &[Vector2]) -> Vec<[f64; 2]> {
    ring.iter().chain(ring.first()).map(|p| [tidy(p.x), tidy(p.y)]).collect()
}

/// A number without the rounding of its computation: to 1e-6.
fn tidy(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_area_is_a_closed_polygon_with_its_properties() {
        let ring = [(0.1, 0.2), (0.1 + 0.2, 0.2), (0.3, 1.0)].map(|(x, y)| Vector2::new(x, y)).to_vec();
        let area = NamedArea { name: "hall \"A\"".to_owned(), area_m2: 0.08, rings: vec![ring] };
        let text: Value = serde_json::from_str(&areas_text(&[area])).unwrap();
        let feature = &text["features"][0];
        assert_eq!(feature["properties"], json!({"kind": "room", "name": "hall \"A\"", "area_m2": 0.08}));
        let corners = json!([[[0.1, 0.2], [0.3, 0.2], [0.3, 1.0], [0.1, 0.2]]]);
        assert_eq!(feature["geometry"]["coordinates"], corners);
        assert_eq!(feature["id"], 1);
    }
}
