//! Pixel formats: every format against values known beforehand, wrong sizes, and arbitrary bytes.

use proptest::prelude::*;
use trundle_core::{ColorImage, DepthImage, Stamp};
use trundle_drivers::camera::pixels::{color_from_raw, depth_from_raw, metres_from_disparity, rgb_from_yuv};
use trundle_drivers::camera::{PixelFormat, RawImage};

const COLORS: [[u8; 3]; 4] = [[255, 0, 10], [0, 200, 20], [7, 8, 9], [100, 110, 120]];

fn raw(format: PixelFormat, size: (usize, usize), bytes: Vec<u8>) -> RawImage {
    RawImage::packed(format, size, bytes, Stamp::from_nanos(0))
}

fn color(raw: &RawImage) -> Result<Vec<[u8; 3]>, String> {
    let mut image = ColorImage::default();
    color_from_raw(raw, &mut image).map_err(|error| error.to_string())?;
    assert_eq!((image.width(), image.height()), (raw.width, raw.height));
    Ok(image.data().to_vec())
}

fn depth(raw: &RawImage, unit_m: f64) -> Result<Vec<f32>, String> {
    let mut image = DepthImage::default();
    depth_from_raw(raw, unit_m, &mut image).map_err(|error| error.to_string())?;
    Ok(image.data().to_vec())
}

#[test]
fn byte_orders_give_the_same_colours() {
    let bytes = |pixel: fn([u8; 3]) -> Vec<u8>| COLORS.into_iter().flat_map(pixel).collect::<Vec<u8>>();
    let cases = [
        (PixelFormat::Rgb8, bytes(|p| p.to_vec())),
        (PixelFormat::Bgr8, bytes(|[r, g, b]| vec![b, g, r])),
        (PixelFormat::Rgba8, bytes(|[r, g, b]| vec![r, g, b, 77])),
        (PixelFormat::Bgra8, bytes(|[r, g, b]| vec![b, g, r, 77])),
    ];
    for (format, bytes) in cases {
        assert_eq!(color(&raw(format, (2, 2), bytes)).unwrap(), COLORS, "{format}");
    }
    assert_eq!(color(&raw(PixelFormat::Gray8, (2, 1), vec![3, 200])).unwrap(), [[3; 3], [200; 3]]);
}

#[test]
fn both_orders_of_yuv_share_chroma_between_two_pixels() {
    let expected = [rgb_from_yuv(50, 90, 180), rgb_from_yuv(220, 90, 180)];
    assert_eq!(color(&raw(PixelFormat::Yuyv, (2, 1), vec![50, 90, 220, 180])).unwrap(), expected);
    assert_eq!(color(&raw(PixelFormat::Uyvy, (2, 1), vec![90, 50, 180, 220])).unwrap(), expected);
    let error = color(&raw(PixelFormat::Yuyv, (3, 1), vec![0; 6])).unwrap_err();
    assert_eq!(
        error,
        "width of a yuyv image is 3 px, expected an even number: two pixels share their chroma"
    );
}

#[test]
fn padding_at_the_end_of_rows_is_skipped() {
    let mut image = raw(PixelFormat::Gray8, (2, 2), vec![1, 2, 99, 3, 4, 99]);
    image.stride = 3;
    assert_eq!(color(&image).unwrap(), [[1; 3], [2; 3], [3; 3], [4; 3]]);
    image.bytes.pop();
    assert_eq!(color(&image).unwrap().len(), 4, "the last row needs no padding");
    image.stride = 1;
    assert!(color(&image).unwrap_err().starts_with("row stride of an image is 1 bytes, expected 2 bytes"));
}

#[test]
fn wrong_numbers_of_bytes_are_named_with_both_sizes() {
    let error = color(&raw(PixelFormat::Rgb8, (4, 2), vec![0; 23])).unwrap_err();
    assert_eq!(error, "length of a rgb8 image is 23 bytes, expected 24 to 24 bytes for 4 x 2 px");
    let error = depth(&raw(PixelFormat::Depth16, (4, 2), vec![0; 18]), 0.001).unwrap_err();
    assert_eq!(error, "length of a depth16 image is 18 bytes, expected 16 to 16 bytes for 4 x 2 px");
    assert!(
        depth(&raw(PixelFormat::Rgb8, (1, 1), vec![0; 3]), 0.001).unwrap_err().contains("a depth format")
    );
    assert!(color(&raw(PixelFormat::Depth16, (1, 1), vec![0; 2])).unwrap_err().contains("a colour format"));
}

#[test]
fn whole_numbers_of_depth_have_the_unit_of_the_camera() {
    let bytes: Vec<u8> = [0u16, 1, 2500, 65535].into_iter().flat_map(u16::to_le_bytes).collect();
    for (unit_m, expected) in [(0.001, 2.5f32), (0.0001, 0.25), (0.00025, 0.625)] {
        let found = depth(&raw(PixelFormat::Depth16, (4, 1), bytes.clone()), unit_m).unwrap();
        assert_eq!(found[0], 0.0);
        assert!((found[2] - expected).abs() < 1e-6, "{found:?}");
    }
    assert!(
        depth(&raw(PixelFormat::Depth16, (4, 1), bytes), 0.0).unwrap_err().contains("unit of depth is 0 m")
    );
}

#[test]
fn a_depth_that_is_not_a_number_is_none() {
    let values = [1.5f32, f32::NAN, f32::INFINITY, -2.0, 0.0];
    let bytes = values.into_iter().flat_map(f32::to_le_bytes).collect();
    let found = depth(&raw(PixelFormat::DepthF32, (5, 1), bytes), 0.001).unwrap();
    assert_eq!(found, [1.5, 0.0, 0.0, 0.0, 0.0]);
}

#[test]
fn the_disparity_of_the_kinect_v1_follows_the_published_formula() {
    for raw in [400u16, 600, 800, 1000] {
        let expected = 1.0 / (raw as f64 * -0.0030711016 + 3.3309495161);
        assert!((metres_from_disparity(raw) as f64 - expected).abs() < 1e-6);
    }
    assert_eq!([1070u16, 1085, 1200, 2047, 65535].map(metres_from_disparity), [0.0; 5]);
}

#[test]
fn a_png_gives_its_16_bits_and_a_jpeg_its_colours() {
    let values = image::ImageBuffer::<image::Luma<u16>, Vec<u16>>::from_raw(2, 1, vec![1234, 40000]).unwrap();
    let mut png = std::io::Cursor::new(Vec::new());
    values.write_to(&mut png, image::ImageFormat::Png).unwrap();
    let png = png.into_inner();
    let found = depth(&raw(PixelFormat::DepthPng16, (2, 1), png.clone()), 0.001).unwrap();
    assert!((found[0] - 1.234).abs() < 1e-6 && (found[1] - 40.0).abs() < 1e-5);
    let error = depth(&raw(PixelFormat::DepthPng16, (1, 2), png), 0.001).unwrap_err();
    assert_eq!(error, "size of a depth_png16 image is 2 x 1 px, expected 1 x 2 as the stream");

    let mut jpeg = std::io::Cursor::new(Vec::new());
    image::RgbImage::from_pixel(16, 8, image::Rgb([200, 100, 50]))
        .write_to(&mut jpeg, image::ImageFormat::Jpeg)
        .unwrap();
    let found = color(&raw(PixelFormat::Mjpg, (16, 8), jpeg.into_inner())).unwrap();
    assert!(
        found.iter().all(|p| p.iter().zip([200u8, 100, 50]).all(|(a, b)| a.abs_diff(b) < 4)),
        "{found:?}"
    );
}

fn any_format() -> impl Strategy<Value = PixelFormat> {
    use PixelFormat::*;
    let all = [Rgb8, Bgr8, Rgba8, Bgra8, Yuyv, Uyvy, Mjpg, Gray8, Depth16, DepthF32, Disparity11, DepthPng16];
    prop::sample::select(all.to_vec())
}

proptest! {
    #[test]
    fn no_bytes_make_a_conversion_panic(
        format in any_format(),
        width in 0usize..9, height in prop::sample::select(vec![0, 1, 2, 5, usize::MAX]),
        stride in prop::sample::select(vec![0, 1, 8, 40, usize::MAX]),
        bytes in prop::collection::vec(any::<u8>(), 0..200),
    ) {
        let image = RawImage { format, width, height, stride, bytes, device_stamp: Stamp::from_nanos(0) };
        if let Ok(colors) = color(&image) {
            prop_assert_eq!(colors.len(), width * height);
        }
        if let Ok(depths) = depth(&image, 0.001) {
            prop_assert!(depths.len() == width * height && depths.iter().all(|d| *d >= 0.0 && d.is_finite()));
        }
    }
}
