use crate::global_bundle::GlobalBundle;
use crate::ids::KeyframeId;
use crate::local_bundle::{BundleSize, apply, bundle_around};
use crate::map::LandmarkMap;
use crate::map_bundle::MapBundle;
use crate::mapping::MappingConfig;
use crate::sensor::Sensor;
use trundle_optim::{BundleConfig, BundleSolver};

/// Steps of a bundle adjustment of the whole map \[MurArtal17\].
const GLOBAL_STEPS: usize = 10;
/// Places of the spare solvers.
const LOCAL: usize = 0;
const GLOBAL: usize = 1;

/// The bundle adjustments of a map that are under way: the one around the newest keyframe first, that of the whole map in
/// what time is left.
///
/// The work is measured in operations, not in time, and done in slices by whoever calls [`LandmarkMap::refine`]: the same
/// images give the same bits on any computer, however busy.
#[derive(Debug, Clone, Default)]
pub(crate) struct Refinement {
    local: Option<MapBundle>,
    global: Option<GlobalBundle>,
    /// The map has changed since the whole of it was last taken up.
    is_due: bool,
    /// Solvers that are not at work, for the room they have taken: of local bundles and of those of the whole map.
    spare: [BundleSolver; 2],
}

impl LandmarkMap {
    /// Begins to refine what is around a new keyframe. What was under way around the one before is taken over as far as it
    /// has come.
    pub fn begin_refining(&mut self, centre: KeyframeId, sensor: &Sensor, config: &MappingConfig) {
        if let Some(bundle) = self.refinement.local.take() {
            apply(self, &bundle, sensor);
            self.refinement.spare[LOCAL] = bundle.into_solver();
        }
        let size = BundleSize { local: config.local_keyframes, fixed: config.fixed_keyframes };
        let mut bundle = bundle_around(self, centre, sensor, size);
        let solver = std::mem::take(&mut self.refinement.spare[LOCAL]);
        bundle.begin(self, sensor, &config.bundle, solver);
        self.refinement.local = Some(bundle);
        self.refinement.is_due = true;
    }

    /// Drops what is under way and begins with the whole map: after a loop, all that was known before has moved.
    pub fn begin_refining_all(&mut self) {
        let Refinement { local, global, spare: [for_local, for_global], .. } =
            std::mem::take(&mut self.refinement);
        let spare = [
            local.map_or(for_local, MapBundle::into_solver),
            global.and_then(GlobalBundle::into_solver).unwrap_or(for_global),
        ];
        self.refinement =
            Refinement { local: None, global: Some(GlobalBundle::of(self)), is_due: false, spare };
    }

    /// Goes on refining for about `work` units of the solver; whether anything moved.
    pub fn refine(&mut self, sensor: &Sensor, config: &MappingConfig, work: usize) -> bool {
        if let Some(mut bundle) = self.refinement.local.take() {
            if bundle.advance(work) {
                apply(self, &bundle, sensor);
                self.refinement.spare[LOCAL] = bundle.into_solver();
                return true;
            }
            self.refinement.local = Some(bundle);
            return false;
        }
        if self.refinement.global.is_none() && self.refinement.is_due && self.keyframe_count() > 1 {
            self.refinement.global = Some(GlobalBundle::of(self));
            self.refinement.is_due = false;
        }
        let Some(mut global) = self.refinement.global.take() else { return false };
        let bundle = BundleConfig { steps: GLOBAL_STEPS, covariances: true, ..config.bundle.clone() };
        let mut solver = std::mem::take(&mut self.refinement.spare[GLOBAL]);
        let is_done = global.advance(self, sensor, (&bundle, &mut solver), work);
        self.refinement.spare[GLOBAL] = solver;
        if is_done {
            global.apply(self);
            self.refinement.spare[GLOBAL] = global.into_solver().unwrap_or_default();
            return true;
        }
        self.refinement.global = Some(global);
        false
    }

    /// Whether there is anything left to refine.
    pub fn is_being_refined(&self) -> bool {
        let Refinement { local, global, is_due, .. } = &self.refinement;
        local.is_some() || global.is_some() || (*is_due && self.keyframe_count() > 1)
    }
}
