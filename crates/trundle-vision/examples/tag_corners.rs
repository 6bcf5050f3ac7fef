//! Prints the AprilTags of images: `tag_corners IMAGE...`. Each image gives a line `image NAME`. Each tag gives its id and the corners
//! upper left, upper right, lower right and lower left, px.

use trundle_core::GrayImage;
use trundle_vision::board::tags::find_tags;

#[allow(clippy::print_stdout, reason = "a program that prints")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    for name in std::env::args().skip(1) {
        let image = image::open(&name)?.to_luma8();
        let (width, height) = (image.width() as usize, image.height() as usize);
        println!("image {name}");
        for tag in find_tags(&GrayImage::new(width, height, image.into_raw())?).tags {
            let corners = tag.corners.map(|corner| format!("{:.4} {:.4}", corner.x, corner.y));
            println!("{} {}", tag.id, corners.join(" "));
        }
    }
    Ok(())
}
