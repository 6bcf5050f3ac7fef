//! The output of `examples/orb_features.rs` of trundle-vision, from kornia-imgproc's ORB: `kornia-orb REPEATS IMAGE.png...`

use kornia_image::{Image, ImageSize};
use kornia_imgproc::features::OrbDetector;
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let repeats: usize = arguments.next().ok_or("repeats, images")?.parse()?;
    let detector = OrbDetector { n_keypoints: 1000, ..OrbDetector::default() };
    for path in arguments {
        let pixels = image::open(&path)?.into_luma8();
        let size = ImageSize { width: pixels.width() as usize, height: pixels.height() as usize };
        let image = Image::<u8, 1>::new(size, pixels.into_raw())?;
        let mut milliseconds = Vec::new();
        let mut features = detector.detect_and_extract_u8(&image)?;
        for _ in 0..repeats {
            let start = Instant::now();
            features = detector.detect_and_extract_u8(&image)?;
            milliseconds.push(format!("{:.4}", start.elapsed().as_secs_f64() * 1e3));
        }
        println!("image {path} {}", milliseconds.join(" "));
        for ([x, y], descriptor) in features.keypoints_xy.iter().zip(&features.descriptors) {
            let hex: String = descriptor.iter().map(|byte| format!("{byte:02x}")).collect();
            println!("{x} {y} {hex}");
        }
    }
    Ok(())
}
