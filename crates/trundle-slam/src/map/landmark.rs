//! A point of the world that keyframes have seen.

use crate::frame::observation_model::ObservationModel;
use crate::ids::KeyframeId;
use crate::map::arena::Arena;
use crate::map::keyframe::Keyframe;
use crate::map::reference_patch::ReferencePatch;
use trundle_core::{Pose3, Vector3};
use trundle_vision::Descriptor;

/// Newest observations from which a landmark's descriptor is chosen: 12. Source: ours.
const MAX_DESCRIPTORS: usize = 12;

/// A point of the world that keyframes have seen.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Landmark {
    /// Visual frame, m.
    pub position: Vector3,
    /// The observed descriptor that is nearest to the others.
    pub descriptor: Descriptor,
    /// Mean direction from the landmark to the cameras that saw it, unit length.
    pub toward_camera: Vector3,
    /// Distance at which the landmark appears in octave 0, m.
    pub distance_at_octave_0: f64,
    /// Keyframe and feature, in the order of observing.
    pub observations: Vec<(KeyframeId, usize)>,
    /// Image patches from several directions, the oldest first.
    pub reference_patches: Vec<ReferencePatch>,
    /// Number of frames in which the landmark was expected.
    pub visible: u32,
    /// Number of frames in which the landmark was found.
    pub found: u32,
}

impl Landmark {
    pub fn new(position: Vector3) -> Self {
        Self {
            position,
            descriptor: Descriptor::default(),
            toward_camera: Vector3::zeros(),
            distance_at_octave_0: 0.0,
            observations: Vec::new(),
            reference_patches: Vec::new(),
            visible: 0,
            found: 0,
        }
    }

    /// The feature of `keyframe` that shows the landmark.
    pub fn observation_in(&self, keyframe: KeyframeId) -> Option<usize> {
        self.observations.iter().find(|(k, _)| *k == keyframe).map(|(_, feature)| *feature)
    }

    /// Moves position, direction and reference patches.
    pub fn transform(&mut self, new_from_old: &Pose3) {
        self.position = new_from_old.transform(self.position);
        self.toward_camera = new_from_old.rotate(self.toward_camera);
        self.reference_patches.iter_mut().for_each(|look| look.turn(new_from_old.rotation));
    }

    /// Factor on a standard deviation for the landmark's own uncertainty: a mean of n equal observations has 1/n of their variance.
    pub fn sigma_factor(&self) -> f64 {
        (1.0 + 1.0 / self.observations.len().max(1) as f64).sqrt()
    }

    /// Updates descriptor, direction and scale from the observations.
    pub fn refresh(&mut self, keyframes: &Arena<Keyframe>, model: &ObservationModel) {
        let keyframe = |id: &KeyframeId| {
            keyframes.get(id.index()).expect("invariant: keyframes that see a landmark are alive")
        };
        let newest = &self.observations[self.observations.len().saturating_sub(MAX_DESCRIPTORS)..];
        let descriptors: Vec<&Descriptor> =
            newest.iter().map(|(k, f)| keyframe(k).frame.descriptor(*f)).collect();
        let apart = |d: &&&Descriptor| descriptors.iter().map(|o| d.distance(o)).sum::<u32>();
        if let Some(central) = descriptors.iter().min_by_key(apart) {
            self.descriptor = **central;
        }
        let ray = |k: &KeyframeId| keyframe(k).visual_from_camera.translation - self.position;
        let sum: Vector3 = self.observations.iter().filter_map(|(k, _)| ray(k).try_normalize(1e-9)).sum();
        self.toward_camera = sum.try_normalize(1e-9).unwrap_or_else(Vector3::zeros);
        if let Some((newest, feature)) = self.observations.last() {
            let octave = keyframe(newest).frame.octave(*feature);
            self.distance_at_octave_0 = ray(newest).norm() / model.scale(octave);
        }
    }
}
