//! Settings outside their ranges are refused by name.

use trundle_mapping::{
    DepthScanConfig, ParticleConfig, ParticleMapper, PosePriorConfig, ScanFusionConfig, ScanMatchConfig,
};

/// Field of a setting, and a change of it beyond its range.
type Case<T> = (&'static str, fn(&mut T));

fn prior(shift: f64, turn: f64) -> Option<PosePriorConfig> {
    let mut prior = PosePriorConfig::default();
    prior.shift = shift;
    prior.turn = turn;
    Some(prior)
}

#[test]
fn a_filter_refuses_each_setting_out_of_its_range() {
    let cases: [Case<ParticleConfig>; 26] = [
        ("particles", |c| c.particles = 0),
        ("particles", |c| c.particles = 1001),
        ("move_gate", |c| c.move_gate = -0.1),
        ("turn_gate_deg", |c| c.turn_gate_deg = 181.0),
        ("wait_gate", |c| c.wait_gate = 4000.0),
        ("jump", |c| c.jump = 0.1),
        ("range_noise", |c| c.range_noise = 0.0),
        ("range_noise_growth", |c| c.range_noise_growth = 0.2),
        ("outliers", |c| c.outliers = 0.0),
        ("correlation", |c| c.correlation = 0.5),
        ("weight_correlation", |c| c.weight_correlation = f64::NAN),
        ("max_scans", |c| c.max_scans = 50),
        ("samples", |c| c.samples = 7),
        ("resample_below", |c| c.resample_below = 1.5),
        ("slip_rate", |c| c.slip_rate = 0.0),
        ("slip_shift", |c| c.slip_shift = 3.0),
        ("slip_turn", |c| c.slip_turn = 0.0),
        ("degenerate_below", |c| c.degenerate_below = -0.1),
        ("shift_per_metre", |c| c.motion.shift_per_metre = 3.0),
        ("shift_per_radian", |c| c.motion.shift_per_radian = -1.0),
        ("turn_per_metre", |c| c.motion.turn_per_metre = 3.0),
        ("turn_per_radian", |c| c.motion.turn_per_radian = 3.0),
        ("min_shift", |c| c.motion.min_shift = 0.0),
        ("min_turn", |c| c.motion.min_turn = 0.0),
        ("pose_prior.shift", |c| c.pose_prior = prior(0.0, 0.01)),
        ("pose_prior.turn", |c| c.pose_prior = prior(0.1, 2.0)),
    ];
    for (field, set) in cases {
        let mut config = ParticleConfig::default();
        set(&mut config);
        assert_eq!(ParticleMapper::new(config, 1).unwrap_err().field, field);
    }
    assert!(ParticleMapper::new(ParticleConfig::default(), 1).is_ok());
}

#[test]
fn a_depth_scan_refuses_each_setting_out_of_its_range() {
    let cases: [Case<DepthScanConfig>; 13] = [
        ("band_low", |c| c.band_low = -0.1),
        ("band_high", |c| c.band_high = 0.05),
        ("min_depth", |c| c.min_depth = 0.0),
        ("max_depth", |c| c.max_depth = 0.3),
        ("max_range", |c| c.max_range = 0.1),
        ("noise_base", |c| c.noise_base = 0.2),
        ("noise_growth", |c| c.noise_growth = f64::INFINITY),
        ("floor_sigmas", |c| c.floor_sigmas = 11.0),
        ("tilt_error_deg", |c| c.tilt_error_deg = -1.0),
        ("floor_fit_deg", |c| c.floor_fit_deg = 11.0),
        ("drop_depth", |c| c.drop_depth = 0.0),
        ("hit_support_px", |c| c.hit_support_px = 9),
        ("free_support_px", |c| c.free_support_px = 9),
    ];
    for (field, set) in cases {
        let mut config = DepthScanConfig::default();
        set(&mut config);
        assert_eq!(config.validated().unwrap_err().field, field);
    }
    assert!(DepthScanConfig::default().validated().is_ok());
}

#[test]
fn a_scan_match_and_a_fusion_refuse_each_setting_out_of_its_range() {
    let cases: [Case<ScanMatchConfig>; 12] = [
        ("window", |c| c.window = 2.0),
        ("window_deg", |c| c.window_deg = 90.0),
        ("step", |c| c.step = 0.0),
        ("step_deg", |c| c.step_deg = 20.0),
        ("search_sigma", |c| c.search_sigma = 0.0),
        ("kernel_sigma", |c| c.kernel_sigma = 2.0),
        ("spacing", |c| c.spacing = 0.0),
        ("min_points", |c| c.min_points = 2),
        ("min_score", |c| c.min_score = 1.5),
        ("degenerate_below", |c| c.degenerate_below = 2.0),
        ("inflation", |c| c.inflation = 0.5),
        ("unknown_sigma", |c| c.unknown_sigma = 0.0),
    ];
    for (field, set) in cases {
        let mut config = ScanMatchConfig::default();
        set(&mut config);
        assert_eq!(config.validated().unwrap_err().field, field);
    }
    let cases: [Case<ScanFusionConfig>; 3] =
        [("beams", |c| c.beams = 8), ("max_range", |c| c.max_range = 0.1), ("surface", |c| c.surface = -0.1)];
    for (field, set) in cases {
        let mut config = ScanFusionConfig::default();
        set(&mut config);
        assert_eq!(config.validated().unwrap_err().field, field);
    }
}
