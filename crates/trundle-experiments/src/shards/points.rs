//! Lists of points in files: `[[x, y], ...]`, m.

use serde::{Deserialize, Deserializer, Serializer};
use trundle_core::Vector2;

/// Writes points.
pub(crate) fn serialize<S: Serializer>(points: &[Vector2], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(points.iter().map(|point| [point.x, point.y]))
}

/// Reads points.
pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Vector2>, D::Error> {
    let points = Vec::<[f64; 2]>::deserialize(deserializer)?;
    Ok(points.into_iter().map(|[x, y]| Vector2::new(x, y)).collect())
}
