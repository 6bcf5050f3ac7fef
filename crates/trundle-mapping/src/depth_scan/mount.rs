//! Geometry of the camera's mount.

use super::{
    DepthScanConfig,
    fan::Fan,
    floor_samples::FloorSamples,
    pixel_model::PixelModel,
    pixel_rays::LensRays,
    range_bins::{BELOW, BIN_COUNT, SpanBits, bins},
};
use trundle_core::{Invalid, Pose3, Vector2, Vector3};

/// Tables computed from the mount of the camera.
#[derive(Debug, Clone)]
pub(super) struct Mount {
    pub(super) origin: Vector2,
    pub(super) fan: Fan,
    pub(super) model: PixelModel,
    pub(super) views: Vec<BeamView>,
    pub(super) samples: FloorSamples,
    pub(super) blind_range: f64,
    /// Whether a beam covers the height band at ranges at which it does not cover the floor.
    pub(super) passes_matter: bool,
}

/// View of a beam, by the mount.
#[derive(Debug, Clone, Copy)]
pub(super) struct BeamView {
    /// Bins in which the beam's pixels observe the floor.
    pub(super) floor: SpanBits,
    /// First bin in which the beam's pixels observe the floor.
    pub(super) begin: usize,
    /// Mean distance over the floor along the beam's rays, m per m of depth.
    pub(super) run: f32,
}

impl Mount {
    pub(super) fn new(
        lens: &LensRays,
        base_from_camera: &Pose3,
        config: &DepthScanConfig,
    ) -> Result<Self, Invalid> {
        if !base_from_camera.is_finite() {
            return Err(Invalid::new("base_from_camera", "not finite", "", "finite numbers"));
        }
        let position = base_from_camera.translation;
        trundle_core::require_positive("camera height above the floor", position.z, "m")?;
        let fan = Fan::new(lens, base_from_camera);
        let survey = Survey::new(lens, base_from_camera, config, &fan);
        Ok(Self {
            origin: position.xy(),
            model: PixelModel::new(config, base_from_camera),
            samples: FloorSamples::new(lens, base_from_camera, config),
            blind_range: survey.blind_range(config.max_range),
            passes_matter: survey.passes_matter(),
            views: survey.views(),
            fan,
        })
    }
}

/// The rays of each beam on an empty floor.
struct Survey {
    beams: Vec<SurveyedBeam>,
}

/// The rays of a beam.
#[derive(Debug, Clone, Copy)]
struct SurveyedBeam {
    /// Bins of the floor.
    floor: SpanBits,
    /// Range bins in which rays pass through the band.
    band: SpanBits,
    /// Smallest range at which the band's lower edge is visible, m.
    first: f64,
    /// Sum and number of the rays' distances over the floor for each m of depth.
    runs: f64,
    count: usize,
}

impl Survey {
    fn new(lens: &LensRays, base_from_camera: &Pose3, config: &DepthScanConfig, fan: &Fan) -> Self {
        let base_from_lens = base_from_camera.rotation_matrix();
        let height = base_from_camera.translation.z;
        let empty = SurveyedBeam { floor: 0, band: 0, first: f64::INFINITY, runs: 0.0, count: 0 };
        let mut beams = vec![empty; fan.beams];
        let bin = |range: f64| (range.max(0.0) * BIN_COUNT as f64 / config.max_range) as usize;
        for (i, &at) in fan.beam_of.iter().enumerate() {
            let ray: Vector3 = base_from_lens * lens.ray(i);
            let run = ray.xy().norm();
            let beam = &mut beams[usize::from(at)];
            (beam.runs, beam.count) = (beam.runs + run, beam.count + 1);
            // Ranges at which the ray is at a height.
            let at_height = |z: f64| (z - height) / ray.z * run;
            if ray.z < 0.0 {
                let depth = height / -ray.z;
                let (floor, edge) = (at_height(0.0), at_height(config.band_low.min(height)));
                if depth >= config.min_depth && depth <= config.max_depth {
                    beam.floor |= bins(bin(edge), bin(floor));
                }
                beam.band |= bins(bin(at_height(config.band_high.min(height))), bin(floor));
                let first = (height - config.band_low).max(0.0) / -ray.z;
                beam.first = beam.first.min(first.max(config.min_depth) * run);
            } else if height < config.band_high {
                let to = if ray.z > 0.0 { at_height(config.band_high) } else { config.max_range };
                beam.band |= BELOW[bin(to).min(BIN_COUNT)];
            }
        }
        Self { beams }
    }

    fn views(&self) -> Vec<BeamView> {
        let view = |beam: &SurveyedBeam| BeamView {
            floor: beam.floor,
            begin: beam.floor.trailing_zeros() as usize,
            run: (beam.runs / beam.count.max(1) as f64) as f32,
        };
        self.beams.iter().map(view).collect()
    }

    /// Whether more than one beam in fifty passes through bins without visible floor.
    fn passes_matter(&self) -> bool {
        let gaps = self.beams.iter().filter(|SurveyedBeam { floor, band, .. }| {
            let first = floor.trailing_zeros() as usize;
            band & !(floor | BELOW[first.min(BIN_COUNT)]) != 0 || (*floor == 0 && *band != 0)
        });
        gaps.count() * 50 > self.beams.len()
    }

    /// Smallest range beyond which the band's lower edge is visible in every bearing that shows it at some range.
    fn blind_range(&self, max_range: f64) -> f64 {
        let seen = self.beams.iter().map(|beam| beam.first).filter(|range| range.is_finite());
        seen.reduce(f64::max).unwrap_or(max_range).min(max_range)
    }
}
