//! The search for a start with clearance all around.

use trundle_app::AppError;
use trundle_core::{Footprint, Pose2, Vector2};
use trundle_sim::{HeightBand, SimConfig, World};

/// Smallest clearance of a robot's start \[m\]. Source: ours.
const START_CLEARANCE: f64 = 0.3;

/// Step of the search \[m\]. Source: ours.
const SEARCH_STEP: f64 = 0.25;

/// Maximum number of tried positions. Source: ours.
const MAX_POSITIONS: usize = 100_000;

/// The free pose nearest to the world's centre; `None` if none is near enough.
pub fn free_start(world: &World) -> Result<Option<Pose2>, AppError> {
    let body = SimConfig::default().kobuki;
    let footprint = Footprint::disc(body.footprint_radius)?;
    let band = HeightBand::new(body.step_over, body.height)?;
    let (low, high) = world.bounds();
    let middle = (low + high).xy() / 2.0;
    for offset in outward((high - low).xy() / 2.0) {
        let place = middle + offset;
        let pose = Pose2::new(place.x, place.y, 0.0);
        if world.clearance(&footprint, pose, band)? > START_CLEARANCE {
            return Ok(Some(pose));
        }
    }
    Ok(None)
}

/// Points of a lattice within `half` of the origin, the nearest first.
fn outward(half: Vector2) -> Vec<Vector2> {
    let reach = (MAX_POSITIONS as f64).sqrt() / 2.0 - 1.0;
    let count = |half: f64| (half / SEARCH_STEP).min(reach).floor() as i64;
    let (columns, rows) = (count(half.x), count(half.y));
    let mut lattice: Vec<(i64, i64)> =
        (-rows..=rows).flat_map(|row| (-columns..=columns).map(move |column| (column, row))).collect();
    lattice.sort_by_key(|(column, row)| column * column + row * row);
    lattice.iter().map(|&(column, row)| Vector2::new(column as f64, row as f64) * SEARCH_STEP).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_sim::Scene;

    #[test]
    fn the_search_goes_outward_and_ends() {
        let places = outward(Vector2::new(1.0, 0.5));
        assert_eq!((places[0], places.len()), (Vector2::zeros(), 9 * 5));
        assert!(places.windows(2).all(|pair| pair[0].norm() <= pair[1].norm() + 1e-12));
        assert!(outward(Vector2::new(1e9, 1e9)).len() <= MAX_POSITIONS);
    }

    #[test]
    fn a_start_among_obstacles_is_free() {
        let scene = Scene::by_name("obstacles", 1).unwrap();
        let start = free_start(&scene.world).unwrap().unwrap();
        let (disc, band) = (Footprint::disc(0.1755).unwrap(), HeightBand::new(0.02, 0.6).unwrap());
        assert!(scene.world.clearance(&disc, start, band).unwrap() > START_CLEARANCE, "{start:?}");
    }
}
