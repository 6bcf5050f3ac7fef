//! Motion blur: the mean of several views in linear light.

use super::View;
use super::srgb::{linear_from_srgb, srgb};
use std::sync::LazyLock;
use trundle_core::Invalid;

/// Steps of linear light between black and white in the conversion to levels: less than half a level each. Source: ours.
const LINEAR_STEPS: usize = 1 << 13;

/// Image of a camera that moves during the exposure: the mean of `views` in linear light.
///
/// The views are at equally spaced times of the exposure. Depth and cosine are those of the middle view (the depth camera has a separate
/// shutter). Cost: one table look-up per channel and view. `out` is overwritten.
///
/// # Errors
/// When no view is given or the views differ in size.
pub fn blend(views: &[View], out: &mut View) -> Result<(), Invalid> {
    static LEVELS: LazyLock<Vec<u8>> = LazyLock::new(|| {
        (0..=LINEAR_STEPS).map(|i| (srgb(i as f64 / LINEAR_STEPS as f64) + 0.5) as u8).collect()
    });
    let Some(middle) = views.get(views.len() / 2) else {
        return Err(Invalid::new("number of views to blend", 0, "", "1 or more"));
    };
    let size = (middle.width, middle.height);
    if let Some(other) = views.iter().find(|view| (view.width, view.height) != size) {
        let value = format!("{} x {}", other.width, other.height);
        return Err(Invalid::new("size of a view to blend", value, "px", format!("{} x {}", size.0, size.1)));
    }
    out.clone_from(middle);
    if views.len() == 1 {
        return Ok(());
    }
    let scale = LINEAR_STEPS as f32 / views.len() as f32;
    for (i, color) in out.color.iter_mut().enumerate() {
        *color = [0, 1, 2].map(|k| {
            let light: f32 = views.iter().map(|view| linear_from_srgb(view.color[i][k])).sum();
            LEVELS[((light * scale + 0.5) as usize).min(LINEAR_STEPS)]
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view(color: [u8; 3], depth: f32) -> View {
        View { width: 2, height: 1, depth: vec![depth; 2], color: vec![color; 2], cosine: vec![1.0; 2] }
    }

    #[test]
    fn light_is_averaged_and_not_levels() {
        let mut out = view([0; 3], 0.0);
        blend(&[view([0, 255, 17], 1.0), view([255, 255, 17], 2.0)], &mut out).unwrap();
        assert_eq!(out.color[0], [188, 255, 17], "half the light of white is level 188");
        assert_eq!(out.depth, [2.0, 2.0]);
    }

    #[test]
    fn a_view_alone_stays_and_sizes_must_agree() {
        let mut out = view([0; 3], 0.0);
        for level in 0..=255 {
            let one = view([level; 3], 1.0);
            blend(&[one.clone(), one.clone(), one.clone()], &mut out).unwrap();
            assert_eq!(out, one);
        }
        assert!(blend(&[], &mut out).is_err());
        let narrow = View { width: 1, height: 2, ..view([0; 3], 1.0) };
        assert!(blend(&[view([0; 3], 1.0), narrow], &mut out).is_err());
    }
}
