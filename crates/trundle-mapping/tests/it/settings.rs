//! Settings outside their ranges are refused by name.

use trundle_mapping::{
    DepthScanConfig, MotionConfig, ParticleConfig, ParticleMapper, PosePriorConfig, ScanFusionConfig,
    ScanMatchConfig,
};

#[test]
fn a_filter_refuses_each_setting_out_of_its_range() {
    let base = ParticleConfig::default;
    let motion = |motion: MotionConfig| ParticleConfig { motion, ..base() };
    let still = MotionConfig::default;
    let prior = |shift, turn| ParticleConfig { pose_prior: Some(PosePriorConfig { shift, turn }), ..base() };
    let cases = [
        ("particles", ParticleConfig { particles: 0, ..base() }),
        ("particles", ParticleConfig { particles: 1001, ..base() }),
        ("move_gate", ParticleConfig { move_gate: -0.1, ..base() }),
        ("turn_gate_deg", ParticleConfig { turn_gate_deg: 181.0, ..base() }),
        ("wait_gate", ParticleConfig { wait_gate: 4000.0, ..base() }),
        ("jump", ParticleConfig { jump: 0.1, ..base() }),
        ("range_noise", ParticleConfig { range_noise: 0.0, ..base() }),
        ("range_noise_growth", ParticleConfig { range_noise_growth: 0.2, ..base() }),
        ("outliers", ParticleConfig { outliers: 0.0, ..base() }),
        ("correlation", ParticleConfig { correlation: 0.5, ..base() }),
        ("weight_correlation", ParticleConfig { weight_correlation: f64::NAN, ..base() }),
        ("max_scans", ParticleConfig { max_scans: 50, ..base() }),
        ("samples", ParticleConfig { samples: 7, ..base() }),
        ("resample_below", ParticleConfig { resample_below: 1.5, ..base() }),
        ("slip_rate", ParticleConfig { slip_rate: 0.0, ..base() }),
        ("slip_shift", ParticleConfig { slip_shift: 3.0, ..base() }),
        ("slip_turn", ParticleConfig { slip_turn: 0.0, ..base() }),
        ("degenerate_below", ParticleConfig { degenerate_below: -0.1, ..base() }),
        ("shift_per_metre", motion(MotionConfig { shift_per_metre: 3.0, ..still() })),
        ("shift_per_radian", motion(MotionConfig { shift_per_radian: -1.0, ..still() })),
        ("turn_per_metre", motion(MotionConfig { turn_per_metre: 3.0, ..still() })),
        ("turn_per_radian", motion(MotionConfig { turn_per_radian: 3.0, ..still() })),
        ("min_shift", motion(MotionConfig { min_shift: 0.0, ..still() })),
        ("min_turn", motion(MotionConfig { min_turn: 0.0, ..still() })),
        ("pose_prior.shift", prior(0.0, 0.01)),
        ("pose_prior.turn", prior(0.1, 2.0)),
    ];
    for (field, config) in cases {
        assert_eq!(ParticleMapper::new(config, 1).unwrap_err().field, field);
    }
    assert!(ParticleMapper::new(base(), 1).is_ok());
}

#[test]
fn a_depth_scan_refuses_each_setting_out_of_its_range() {
    let base = DepthScanConfig::default;
    let cases = [
        ("band_low", DepthScanConfig { band_low: -0.1, ..base() }),
        ("band_high", DepthScanConfig { band_high: 0.05, ..base() }),
        ("min_depth", DepthScanConfig { min_depth: 0.0, ..base() }),
        ("max_depth", DepthScanConfig { max_depth: 0.3, ..base() }),
        ("max_range", DepthScanConfig { max_range: 0.1, ..base() }),
        ("noise_base", DepthScanConfig { noise_base: 0.2, ..base() }),
        ("noise_growth", DepthScanConfig { noise_growth: f64::INFINITY, ..base() }),
        ("floor_sigmas", DepthScanConfig { floor_sigmas: 11.0, ..base() }),
        ("tilt_error_deg", DepthScanConfig { tilt_error_deg: -1.0, ..base() }),
        ("floor_fit_deg", DepthScanConfig { floor_fit_deg: 11.0, ..base() }),
        ("drop_depth", DepthScanConfig { drop_depth: 0.0, ..base() }),
        ("hit_support_px", DepthScanConfig { hit_support_px: 9, ..base() }),
        ("free_support_px", DepthScanConfig { free_support_px: 9, ..base() }),
    ];
    for (field, config) in cases {
        assert_eq!(config.validated().unwrap_err().field, field);
    }
    assert!(base().validated().is_ok());
}

#[test]
fn a_scan_match_and_a_fusion_refuse_each_setting_out_of_its_range() {
    let base = ScanMatchConfig::default;
    let cases = [
        ("window", ScanMatchConfig { window: 2.0, ..base() }),
        ("window_deg", ScanMatchConfig { window_deg: 90.0, ..base() }),
        ("step", ScanMatchConfig { step: 0.0, ..base() }),
        ("step_deg", ScanMatchConfig { step_deg: 20.0, ..base() }),
        ("search_sigma", ScanMatchConfig { search_sigma: 0.0, ..base() }),
        ("kernel_sigma", ScanMatchConfig { kernel_sigma: 2.0, ..base() }),
        ("spacing", ScanMatchConfig { spacing: 0.0, ..base() }),
        ("min_points", ScanMatchConfig { min_points: 2, ..base() }),
        ("min_score", ScanMatchConfig { min_score: 1.5, ..base() }),
        ("degenerate_below", ScanMatchConfig { degenerate_below: 2.0, ..base() }),
        ("inflation", ScanMatchConfig { inflation: 0.5, ..base() }),
        ("unknown_sigma", ScanMatchConfig { unknown_sigma: 0.0, ..base() }),
    ];
    for (field, config) in cases {
        assert_eq!(config.validated().unwrap_err().field, field);
    }
    let base = ScanFusionConfig::default;
    let cases = [
        ("beams", ScanFusionConfig { beams: 8, ..base() }),
        ("max_range", ScanFusionConfig { max_range: 0.1, ..base() }),
        ("surface", ScanFusionConfig { surface: -0.1, ..base() }),
    ];
    for (field, config) in cases {
        assert_eq!(config.validated().unwrap_err().field, field);
    }
}
