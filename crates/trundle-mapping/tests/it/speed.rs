//! `cargo test --release -p trundle-mapping --test it -- --ignored --nocapture speed`

use crate::boxes::{Solid, add_noise, depth_of, mount, rgbd};
use std::time::Instant;
use trundle_core::{PinholeCamera, Pose2};
use trundle_mapping::{
    DepthScanConfig, DepthScanner, GridMapper, MapperConfig, ScanMatchConfig, ScanMatcher,
};

fn median_ms(mut work: impl FnMut()) -> f64 {
    let mut times: Vec<f64> = (0..101)
        .map(|_| {
            let start = Instant::now();
            work();
            start.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[50]
}

#[test]
#[ignore = "a measurement, not a test"]
fn speed() {
    let (camera, base_from_camera) = (PinholeCamera::kinect_v2(), mount(0.45, 8.0));
    let furniture = [
        Solid::wall(5.0, 2.5),
        Solid::new([2.0, 0.3, 0.0], [2.5, 0.9, 0.8]),
        Solid::new([3.0, -1.2, 0.4], [3.6, -0.4, 0.45]),
    ];
    let mut depth = depth_of(&camera, &base_from_camera, &furniture, true);
    add_noise(&mut depth, 1);
    let image = rgbd(depth);
    let mut scanner = DepthScanner::new(camera, base_from_camera, DepthScanConfig::default()).unwrap();
    let mut scan = scanner.scan(&image);
    println!("scan of 512 x 424: {:.3} ms", median_ms(|| scan = scanner.scan(&image)));

    let mut mapper = GridMapper::new(MapperConfig::default()).unwrap();
    println!("{} beams", scan.beams().len());
    println!(
        "insertion: {:.3} ms",
        median_ms(|| {
            mapper.insert(Pose2::IDENTITY, &scan);
        })
    );

    let matcher = ScanMatcher::new(ScanMatchConfig::default()).unwrap();
    let guess = Pose2::new(0.05, -0.04, 0.03);
    println!("{:?}", matcher.refine(&mapper, &scan, guess));
    println!(
        "match: {:.3} ms",
        median_ms(|| {
            matcher.refine(&mapper, &scan, guess);
        })
    );
}
