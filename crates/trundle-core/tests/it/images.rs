//! Laws of images.

use proptest::prelude::*;
use trundle_core::{ColorImage, DepthImage, GrayImage, Image, RgbdImage, Stamp, gray_from_color};

/// An image whose pixels contain their own column and row.
fn numbered(width: usize, height: usize) -> Image<(usize, usize)> {
    Image::from_fn(width, height, |x, y| (x, y))
}

proptest! {
    #[test]
    fn rows_pixels_and_data_show_the_same_image(width in 1_usize..20, height in 1_usize..20) {
        let image = numbered(width, height);
        for y in 0..height {
            prop_assert_eq!(image.row(y).len(), width);
            for x in 0..width {
                prop_assert_eq!(image[(x, y)], (x, y));
                prop_assert_eq!(image.get(x, y), Some(&(x, y)));
                prop_assert_eq!(image.row(y)[x], (x, y));
                prop_assert_eq!(image.data()[y * width + x], (x, y));
            }
        }
    }

    #[test]
    fn there_is_no_pixel_beyond_the_edges(width in 1_usize..20, height in 1_usize..20, more in 0_usize..100) {
        let image = numbered(width, height);
        prop_assert_eq!(image.get(width + more, 0), None);
        prop_assert_eq!(image.get(0, height + more), None);
    }

    #[test]
    fn luminance_lies_between_the_darkest_and_the_brightest_channel(r in 0_u8.., g in 0_u8.., b in 0_u8..) {
        let gray = gray_from_color(&ColorImage::filled(1, 1, [r, g, b]))[(0, 0)];
        prop_assert!(gray >= r.min(g).min(b) && gray <= r.max(g).max(b));
    }

    #[test]
    fn a_brighter_channel_never_darkens_the_luminance(r in 0_u8..255, g in 0_u8..255, b in 0_u8..255) {
        let gray = |color: [u8; 3]| gray_from_color(&ColorImage::filled(1, 1, color))[(0, 0)];
        let before = gray([r, g, b]);
        prop_assert!(gray([r + 1, g, b]) >= before && gray([r, g + 1, b]) >= before && gray([r, g, b + 1]) >= before);
    }
}

#[test]
fn grey_stays_grey_of_every_level() {
    for level in 0..=255 {
        assert_eq!(gray_from_color(&ColorImage::filled(2, 1, [level; 3])).data(), [level, level]);
    }
}

#[test]
fn green_is_brighter_than_red_and_red_brighter_than_blue() {
    let colors = ColorImage::new(3, 1, vec![[255, 0, 0], [0, 255, 0], [0, 0, 255]]).unwrap();
    assert_eq!(gray_from_color(&colors).data(), [77, 149, 29]);
}

#[test]
fn writing_through_a_row_a_pixel_or_the_data_changes_one_place() {
    let mut image = GrayImage::filled(3, 2, 0);
    image.row_mut(1)[2] = 5;
    image[(0, 1)] = 6;
    image.data_mut()[1] = 7;
    assert_eq!(image.data(), [0, 7, 0, 6, 0, 5]);
}

#[test]
fn sizes_are_compared_by_side_and_not_by_the_number_of_pixels() {
    assert!(!numbered(2, 6).same_size(&GrayImage::filled(6, 2, 0)));
    assert!(numbered(2, 6).same_size(&GrayImage::filled(2, 6, 0)));
}

#[test]
#[should_panic(expected = "column 3 of 3")]
fn a_column_beyond_the_edge_is_not_the_next_row() {
    let _ = numbered(3, 2)[(3, 0)];
}

#[test]
fn an_rgbd_image_returns_its_two_images_and_its_stamp() {
    let (color, depth) = (ColorImage::filled(4, 3, [1, 2, 3]), DepthImage::filled(4, 3, 1.5));
    let image = RgbdImage::new(Stamp::from_nanos(9), color.clone(), depth.clone()).unwrap();
    assert_eq!((image.stamp(), image.color(), image.depth()), (Stamp::from_nanos(9), &color, &depth));
}
