use crate::world::{Hit, Stage};
use trundle_core::{Pose3, Vector3};

/// What a beam meets first, of what stands and what moves, nearer than `limit` m along the unit vector `direction`.
pub(super) fn first_hit(
    stage: &Stage<'_>,
    origin: Vector3,
    direction: Vector3,
    limit: f64,
) -> Option<(f64, Vector3)> {
    let seen = |hit: Hit| (hit.distance, hit.normal);
    let mut nearest = stage.world.cast(origin, direction, limit).map(seen);
    for mover in stage.movers {
        let body_from_world = Pose3::from_pose2(mover.pose).inverse();
        let limit = nearest.map_or(limit, |(distance, _)| distance);
        let (o, d) = (body_from_world.transform(origin), body_from_world.rotate(direction));
        if let Some(hit) = mover.body.cast(o, d, limit) {
            nearest = Some((hit.distance, Pose3::from_pose2(mover.pose).rotate(hit.normal)));
        }
    }
    nearest
}
