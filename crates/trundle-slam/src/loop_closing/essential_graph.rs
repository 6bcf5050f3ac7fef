//! The pose graph that a loop closure solves.

use crate::frame::observation_model::ObservationModel;
use crate::ids::KeyframeId;
use crate::loop_closing::place_verification::RecognizedPlace;
use crate::loop_closing::shared_landmark_information::shared_landmark_information;
use crate::map::landmark_map::LandmarkMap;
use crate::optimisation::constraints::odometry_and_floor_constraints;
use nalgebra::Matrix6;
use std::collections::BTreeSet;
use trundle_core::Pose3;
use trundle_optim::{CHI2_95_6, Huber, PoseConstraint, PoseGraph};

/// The pose graph of a loop closure. Keyframes are constrained by common landmarks, odometry and the floor, at their present relative
/// poses. Each constraint has the information of its source, so that the correction goes where the drift arose. The last constraint puts
/// `keyframe` at the recognized place. Poses are the keyframes by rising id, and then the identity, to which floors are constrained.
pub(crate) fn essential_graph(
    map: &LandmarkMap,
    model: &ObservationModel,
    (keyframe, found): (KeyframeId, &RecognizedPlace),
    tied_by: usize,
) -> PoseGraph {
    let ids: Vec<KeyframeId> = map.keyframe_ids().collect();
    let place = |id: KeyframeId| ids.binary_search(&id).expect("invariant: the keyframe is alive");
    let poses = ids.iter().map(|id| map.keyframe(*id).visual_from_camera);
    let poses: Vec<Pose3> = poses.chain([Pose3::identity()]).collect();
    let as_now = |(from, to): (usize, usize), information: Matrix6<f64>| PoseConstraint {
        from,
        to,
        from_to: poses[from].inverse() * poses[to],
        information,
    };
    let seen = shared_landmark_information(map, model, &ids, pairs(map, &ids, tied_by));
    let mut constraints: Vec<PoseConstraint> =
        seen.into_iter().map(|(pair, by)| as_now(pair, by + Matrix6::identity() * MIN_INFORMATION)).collect();
    for tie in odometry_and_floor_constraints(map, &ids, |i| i == 0) {
        let is_floor = tie.from == ids.len();
        constraints.push(if is_floor {
            tie
        } else {
            as_now((tie.from, tie.to), robust_information(&tie, &poses))
        });
    }
    let (from, to) = (place(found.candidate), place(keyframe));
    let from_to = poses[from].inverse() * found.visual_from_camera;
    let information = found.covariance.try_inverse().unwrap_or(Matrix6::identity() * MIN_INFORMATION);
    constraints.push(PoseConstraint { from, to, from_to, information });
    let fixed: Vec<bool> = (0..poses.len()).map(|i| i == 0 || i == ids.len()).collect();
    PoseGraph::new(poses, &fixed, constraints).expect("invariant: every index was counted here")
}

/// Information of a constraint besides that of its landmarks: 1 (1/m^2 and 1/rad^2). Without common landmarks, it moves a keyframe along
/// with its neighbours. Source: ours.
const MIN_INFORMATION: f64 = 1.0;

/// Pairs of keyframes that the graph constrains, by index: edges of the spanning tree, keyframes that share `tied_by` landmarks, earlier
/// loops \[MurArtal17\], and neighbours in time.
fn pairs(map: &LandmarkMap, ids: &[KeyframeId], tied_by: usize) -> BTreeSet<(usize, usize)> {
    let mut pairs: BTreeSet<(usize, usize)> = (1..ids.len()).map(|i| (i - 1, i)).collect();
    for (i, id) in ids.iter().enumerate() {
        let tree = &map.keyframe(*id).tree;
        let shared = map.covisible(*id, tied_by).into_iter().map(|(other, _)| other);
        let connected = shared.chain(tree.parent).chain(tree.loops.iter().copied());
        let places = connected.filter_map(|other| ids.binary_search(&other).ok());
        pairs.extend(places.filter(|other| *other != i).map(|other| (other.min(i), other.max(i))));
    }
    pairs
}

/// Information of an odometry constraint at these poses, reduced by the Huber loss where the wheels slipped.
fn robust_information(tie: &PoseConstraint, poses: &[Pose3]) -> Matrix6<f64> {
    let off = (tie.from_to.inverse() * poses[tie.from].inverse() * poses[tie.to]).log();
    tie.information * Huber::beyond(CHI2_95_6).weight(off.dot(&(tie.information * off)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{frame_with_depth, model};
    use nalgebra::Vector6;
    use trundle_optim::PoseGraphConfig;

    /// Keyframes in a row in front of a wall, one column of features apart. Each shares 56 landmarks with the next one; the third and the
    /// fourth share only 6.
    fn chain() -> (LandmarkMap, Vec<KeyframeId>) {
        let (mut map, model) = (LandmarkMap::default(), model());
        let step = 20.0 / model.camera.fx() * 2.0;
        let at = |i: usize| Pose3::exp(Vector6::new(step * i as f64, 0.0, 0.0, 0.0, 0.0, 0.0));
        let ids: Vec<KeyframeId> = (0..6).map(|i| map.add_keyframe(frame_with_depth(112), at(i))).collect();
        for i in 1..6 {
            for feature in (0..112).step_by(if i == 3 { 20 } else { 2 }) {
                let seen = map.keyframe(ids[i]).frame.point(feature, &model).expect("a depth");
                let landmark = map.add_landmark(at(i).transform(seen));
                let is_shared = map.observe(landmark, ids[i], feature);
                assert!(is_shared && map.observe(landmark, ids[i - 1], feature + 1));
            }
        }
        ids.iter().for_each(|id| map.add_to_spanning_tree(*id));
        (map, ids)
    }

    #[test]
    fn a_loop_bends_the_chain_where_it_is_weak() {
        let (map, ids) = chain();
        let off = Pose3::exp(Vector6::new(0.05, 0.0, 0.02, 0.0, 0.03, 0.0));
        let found = RecognizedPlace {
            candidate: ids[0],
            visual_from_camera: map.keyframe(ids[5]).visual_from_camera * off,
            covariance: Matrix6::identity() * 1e-9,
            points: 50,
            landmarks: vec![],
        };
        let graph = essential_graph(&map, &model(), (ids[5], &found), 30);
        let after = graph.solve(&PoseGraphConfig::default()).poses;
        assert!((after[5].inverse() * found.visual_from_camera).log().norm() < 0.005, "the loop is closed");
        let bent = |i: usize| {
            let before = map.keyframe(ids[i - 1]).visual_from_camera.inverse()
                * map.keyframe(ids[i]).visual_from_camera;
            (before.inverse() * after[i - 1].inverse() * after[i]).log().norm()
        };
        for i in [1, 2, 4, 5] {
            assert!(bent(i) < 0.25 * bent(3), "{i} by {}, the weak one by {}", bent(i), bent(3));
        }
    }
}
