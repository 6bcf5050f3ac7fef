use crate::global_bundle::GlobalBundle;
use crate::ids::KeyframeId;
use crate::local_bundle::{BundleSize, apply, bundle_around};
use crate::map::LandmarkMap;
use crate::map_bundle::MapBundle;
use crate::mapping::MappingConfig;
use crate::sensor::Sensor;
use trundle_optim::BundleConfig;

/// Steps of a bundle adjustment of the whole map \[MurArtal17\].
const GLOBAL_STEPS: usize = 10;

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
}

impl LandmarkMap {
    /// Begins to refine what is around a new keyframe. What was under way around the one before is taken over as far as it
    /// has come.
    pub fn begin_refining(&mut self, centre: KeyframeId, sensor: &Sensor, config: &MappingConfig) {
        if let Some(bundle) = self.refinement.local.take() {
            apply(self, &bundle, sensor);
        }
        let size = BundleSize { local: config.local_keyframes, fixed: config.fixed_keyframes };
        let mut bundle = bundle_around(self, centre, sensor, size);
        bundle.begin(sensor, &config.bundle);
        self.refinement.local = Some(bundle);
        self.refinement.is_due = true;
    }

    /// Drops what is under way and begins with the whole map: after a loop, all that was known before has moved.
    pub fn begin_refining_all(&mut self) {
        self.refinement = Refinement { local: None, global: Some(GlobalBundle::of(self)), is_due: false };
    }

    /// Goes on refining for about `work` units of the solver; whether anything moved.
    pub fn refine(&mut self, sensor: &Sensor, config: &MappingConfig, work: usize) -> bool {
        if let Some(mut bundle) = self.refinement.local.take() {
            if bundle.advance(work) {
                apply(self, &bundle, sensor);
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
        if global.advance(self, sensor, &bundle, work) {
            global.apply(self);
            return true;
        }
        self.refinement.global = Some(global);
        false
    }

    /// Whether there is anything left to refine.
    pub fn is_being_refined(&self) -> bool {
        let Refinement { local, global, is_due } = &self.refinement;
        local.is_some() || global.is_some() || (*is_due && self.keyframe_count() > 1)
    }
}
