//! ORB features of images and their times, for bench/vision: `orb_features REPEATS IMAGE.png...`. For each image it prints a line `image
//! PATH` with the milliseconds of each repeat, then a line `x y descriptor` per feature, the descriptor in hex.
#![expect(clippy::print_stdout, reason = "it is what the example is for")]

use std::error::Error;
use std::time::Instant;
use trundle_core::GrayImage;
use trundle_vision::{Features, OrbConfig, OrbExtractor};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let repeats: usize = arguments.next().ok_or("usage: orb_features REPEATS IMAGE.png...")?.parse()?;
    let mut orb = OrbExtractor::new(OrbConfig::default())?;
    let mut features = Features::default();
    for path in arguments {
        let pixels = image::open(&path)?.into_luma8();
        let (width, height) = (pixels.width() as usize, pixels.height() as usize);
        let image = GrayImage::new(width, height, pixels.into_raw())?;
        // The first one makes room.
        orb.extract_into(&image, &mut features);
        let mut milliseconds = Vec::new();
        for _ in 0..repeats {
            let start = Instant::now();
            orb.extract_into(&image, &mut features);
            milliseconds.push(format!("{:.4}", start.elapsed().as_secs_f64() * 1e3));
        }
        println!("image {path} {}", milliseconds.join(" "));
        for (keypoint, descriptor) in features.keypoints.iter().zip(&features.descriptors) {
            let hex: String =
                descriptor.0.iter().flat_map(|word| word.to_le_bytes()).map(|b| format!("{b:02x}")).collect();
            println!("{} {} {hex}", keypoint.x, keypoint.y);
        }
    }
    Ok(())
}
