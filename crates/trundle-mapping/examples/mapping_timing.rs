//! Cost of the steps of mapping: `cargo run --release -p trundle-mapping --example mapping_timing`
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a measurement for the terminal")]

#[path = "../tests/it/boxes.rs"]
#[allow(dead_code, reason = "the tests use more of it")]
mod boxes;

use boxes::{Solid, add_noise, depth_of, mount, rgbd};
use trundle_core::{PinholeCamera, Pose2};
use trundle_mapping::{
    DepthScanConfig, DepthScanner, GridMapper, MapperConfig, ScanMatchConfig, ScanMatcher,
};

/// Time on the processor, ms, in steps of some ms: others may be at work too.
fn processor_ms() -> f64 {
    let nanos = std::fs::read_to_string("/proc/thread-self/schedstat")
        .ok()
        .and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    nanos.expect("Linux") * 1e-6
}

fn mean_ms(mut work: impl FnMut()) -> f64 {
    let runs = 300;
    let start = processor_ms();
    for _ in 0..runs {
        work();
    }
    (processor_ms() - start) / f64::from(runs)
}

fn main() {
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
    println!("scan of 512 x 424: {:.3} ms", mean_ms(|| scan = scanner.scan(&image)));

    println!("remount: {:.3} ms", mean_ms(|| scanner.remount(base_from_camera).unwrap()));

    let mut mapper = GridMapper::new(MapperConfig::default()).unwrap();
    println!("{} beams", scan.beams().len());
    println!(
        "insertion: {:.3} ms",
        mean_ms(|| {
            mapper.insert(Pose2::IDENTITY, &scan);
        })
    );

    let matcher = ScanMatcher::new(ScanMatchConfig::default()).unwrap();
    let guess = Pose2::new(0.05, -0.04, 0.03);
    println!("{:?}", matcher.refine(&mapper, &scan, guess));
    println!(
        "match: {:.3} ms",
        mean_ms(|| {
            matcher.refine(&mapper, &scan, guess);
        })
    );
}
