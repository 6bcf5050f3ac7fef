use trundle_core::DepthImage;

/// Whether at least `needed` of the 8 neighbours of pixel `index` are as deep as it, within `window` m.
///
/// A lone pixel, or one that flies between an edge and what lies behind it, has few. Pixels of the border have none.
pub(super) fn supported(depth: &DepthImage, index: usize, window: f32, needed: u8) -> bool {
    let (width, height) = (depth.width(), depth.height());
    let (x, y) = (index % width, index / width);
    if x == 0 || y == 0 || x + 1 >= width || y + 1 >= height {
        return needed == 0;
    }
    let data = depth.data();
    let here = data[index];
    let agrees = |i: usize| u8::from((data[i] - here).abs() <= window);
    let across = |i: usize| agrees(i - 1) + agrees(i) + agrees(i + 1);
    across(index - width) + agrees(index - 1) + agrees(index + 1) + across(index + width) >= needed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_neighbours_of_like_depth() {
        let mut depth = DepthImage::filled(5, 5, 3.0);
        depth[(2, 1)] = 2.0;
        depth[(2, 2)] = 2.01;
        depth[(2, 3)] = 2.0;
        assert!(supported(&depth, 2 * 5 + 2, 0.05, 2));
        assert!(!supported(&depth, 2 * 5 + 2, 0.05, 3), "a line of flying pixels");
        assert!(!supported(&depth, 0, 0.05, 1), "the border");
        assert!(!supported(&DepthImage::filled(5, 5, f32::NAN), 12, 0.05, 3));
    }
}
