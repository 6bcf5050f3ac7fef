//! The running bundle adjustments of a map, in slices.

use crate::frame::observation_model::ObservationModel;
use crate::ids::KeyframeId;
use crate::local_mapping::config::LocalMappingConfig;
use crate::map::landmark_map::LandmarkMap;
use crate::optimisation::global_bundle::GlobalBundle;
use crate::optimisation::local_bundle::{BundleSize, apply, bundle_around};
use crate::optimisation::map_bundle::MapBundle;
use trundle_optim::BundleSolver;

/// Largest number of steps of a bundle adjustment of the whole map: 10. It then ends with the present result. Source: \[MurArtal17\].
const MAX_GLOBAL_STEPS: usize = 10;

/// The running bundle adjustments of a map: the one around the newest keyframe first, that of the whole map in the remaining time.
///
/// The work is measured in operations, not in time: the same images give the same bits on any computer.
#[derive(Debug, Clone, Default)]
pub(crate) struct MapOptimisation {
    local: Option<MapBundle>,
    global: Option<GlobalBundle>,
    /// Whether the map has changed since the last bundle adjustment of the whole map began.
    is_global_due: bool,
    /// Idle solvers, kept for their buffers.
    spare: SpareSolvers,
}

#[derive(Debug, Clone, Default)]
struct SpareSolvers {
    local: BundleSolver,
    global: BundleSolver,
}

impl MapOptimisation {
    /// Begins the local bundle adjustment around a new keyframe. The present result of a running local adjustment is applied.
    pub fn begin_around(
        &mut self,
        map: &mut LandmarkMap,
        centre: KeyframeId,
        model: &ObservationModel,
        config: &LocalMappingConfig,
    ) {
        if let Some(bundle) = self.local.take() {
            apply(map, &bundle, model);
            self.spare.local = bundle.into_solver();
        }
        let size = BundleSize { local: config.local_keyframes, fixed: config.fixed_keyframes };
        let mut bundle = bundle_around(map, centre, size);
        bundle.begin(map, model, &config.bundle, std::mem::take(&mut self.spare.local));
        self.local = Some(bundle);
        self.is_global_due = true;
    }

    /// Drops the running adjustments and begins with the whole map: after a loop closure, all earlier results are out of date.
    pub fn begin_all(&mut self, map: &LandmarkMap) {
        let Self { local, global, spare, .. } = std::mem::take(self);
        self.spare = SpareSolvers {
            local: local.map_or(spare.local, MapBundle::into_solver),
            global: global.and_then(GlobalBundle::into_solver).unwrap_or(spare.global),
        };
        self.global = Some(GlobalBundle::of(map));
    }

    /// Continues for about `work` units of the solver. Returns whether the map moved.
    pub fn advance(
        &mut self,
        map: &mut LandmarkMap,
        model: &ObservationModel,
        config: &LocalMappingConfig,
        work: usize,
    ) -> bool {
        match self.local.take() {
            Some(bundle) => self.advance_local(bundle, map, model, work),
            None => self.advance_global(map, model, config, work),
        }
    }

    fn advance_local(
        &mut self,
        mut bundle: MapBundle,
        map: &mut LandmarkMap,
        model: &ObservationModel,
        work: usize,
    ) -> bool {
        let is_done = bundle.advance(work);
        if is_done {
            apply(map, &bundle, model);
            self.spare.local = bundle.into_solver();
        } else {
            self.local = Some(bundle);
        }
        is_done
    }

    fn advance_global(
        &mut self,
        map: &mut LandmarkMap,
        model: &ObservationModel,
        config: &LocalMappingConfig,
        work: usize,
    ) -> bool {
        if self.global.is_none() && self.is_global_due && map.keyframe_count() > 1 {
            self.global = Some(GlobalBundle::of(map));
            self.is_global_due = false;
        }
        let Some(mut global) = self.global.take() else { return false };
        let mut bundle = config.bundle.clone();
        bundle.steps = MAX_GLOBAL_STEPS;
        bundle.covariances = true;
        let is_done = global.advance(map, model, (&bundle, &mut self.spare.global), work);
        if is_done {
            global.apply(map);
            self.spare.global = global.into_solver().unwrap_or_default();
        } else {
            self.global = Some(global);
        }
        is_done
    }

    /// Whether an adjustment runs or is due.
    pub fn is_pending(&self, map: &LandmarkMap) -> bool {
        self.local.is_some() || self.global.is_some() || (self.is_global_due && map.keyframe_count() > 1)
    }
}
