//! Settings out of their range are refused with key, value, unit and range.

use trundle_grid::MapperConfig;

/// A setting: key, unit, lowest and highest value, and how it is set.
type Setting = (&'static str, &'static str, f64, f64, fn(&mut MapperConfig, f64));

#[test]
fn every_number_of_the_sensor_model_is_checked() {
    let settings: [Setting; 8] = [
        ("hit", "", 0.01, 10.0, |c, x| c.hit = x),
        ("free", "", 0.01, 10.0, |c, x| c.free = x),
        ("clamp_high", "", 0.1, 100.0, |c, x| c.clamp_high = x),
        ("clamp_low", "", 0.1, 100.0, |c, x| c.clamp_low = x),
        ("max_range", "m", 0.1, 200.0, |c, x| c.max_range = x),
        ("blind_range", "m", 0.0, 10.0, |c, x| c.blind_range = x),
        ("surface_gap", "m", 0.0, 2.0, |c, x| c.surface_gap = x),
        ("half_extent", "m", 1.0, 1150.0, |c, x| c.half_extent = x),
    ];
    for (key, unit, low, high, set) in settings {
        // Thresholds that the smallest clamp reaches.
        let mut near = MapperConfig::default();
        near.occupied_above = 0.51;
        near.free_below = 0.49;
        let with = |value: f64| {
            let mut config = near.clone();
            set(&mut config, value);
            config.validated().map(|_| ()).map_err(|error| error.to_string())
        };
        assert_eq!((with(low), with(high)), (Ok(()), Ok(())), "{key}");
        for bad in [low - 0.0005, high * 1.01, f64::NAN, f64::INFINITY] {
            let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
            assert_eq!(with(bad), Err(format!("{key} is {bad}{unit}, expected {low} to {high}")), "{key}");
        }
    }
}

#[test]
fn the_extent_follows_the_resolution_so_that_cells_can_be_counted() {
    let widest = |resolution: f64| {
        let mut config = MapperConfig::default();
        config.resolution = resolution;
        config.half_extent = 1e9;
        config.validated().unwrap_err().expected
    };
    assert_eq!(
        (widest(0.01), widest(0.05), widest(1.0)),
        ("1 to 230".into(), "1 to 1150".into(), "1 to 2000".into())
    );
    let mut mapper = MapperConfig::default();
    mapper.resolution = 0.004;
    let fine = mapper.validated().unwrap_err();
    assert_eq!(fine.to_string(), "resolution is 0.004 m, expected 0.005 to 1");
}

#[test]
fn thresholds_lie_on_their_side_of_one_half() {
    let field = |occupied_above, free_below| {
        let mut config = MapperConfig::default();
        config.occupied_above = occupied_above;
        config.free_below = free_below;
        config.validated().map(|_| ()).map_err(|error| error.field)
    };
    assert_eq!(field(0.5, 0.5), Ok(()));
    assert_eq!(
        (field(0.49, 0.2), field(0.6, 0.51)),
        (Err("occupied_above".into()), Err("free_below".into()))
    );
}
