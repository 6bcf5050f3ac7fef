//! No input makes a picture panic, and equal content always gives equal bytes.

mod any;

use any::{any_footprint, any_grid, any_marks, any_number, any_points, any_pose, any_scan};
use proptest::prelude::*;
use trundle_core::{ColorImage, DepthImage, Vector3};
use trundle_viz::{
    BarChart, Chart, Color, DotStyle, LineStyle, MapPicture, PlanScene, PoseStyle, depth_picture,
    feature_picture, plan_picture, trajectory_picture,
};

/// Width and height of a PNG that a decoder takes.
fn size_of(png: &[u8]) -> (u32, u32) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().expect("a PNG head");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size that fits memory")];
    let info = reader.next_frame(&mut pixels).expect("whole PNG data");
    (info.width, info.height)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10, ..ProptestConfig::default() })]

    #[test]
    fn any_map_picture_is_drawn(
        grid in any_grid(), blank in any::<bool>(), lines in any_points(), dots in any_points(), pose in any_pose(),
        footprint in any_footprint(), scan in any_scan(), width in any_number(), half in any_number(), zoomed in any::<bool>(),
    ) {
        let canvas = if blank { MapPicture::blank() } else { MapPicture::over(&grid) };
        let line = LineStyle { width, ..LineStyle::dashed(Color::BLUE) };
        let picture = canvas
            .band("band", &lines, width, Color::SKY.alpha(60))
            .polyline("line", &lines, line)
            .polyline("", &dots, LineStyle::solid(Color::BLUE))
            .dots("dots", &dots, DotStyle::crowd(Color::GREEN).radius(width))
            .dots("circles", &lines, DotStyle::circles(Color::GREEN))
            .scan("scan", pose, &scan, Color::ORANGE)
            .outlines("outlines", &[pose], &footprint, Color::BLACK)
            .pose("pose \u{1f916}\n", pose, PoseStyle::named(Color::VERMILLION).with_footprint(footprint.clone()));
        let picture = if zoomed { picture.window(pose.position(), half) } else { picture };
        let png = picture.to_png();
        let (w, h) = size_of(&png);
        prop_assert!(w.max(h) <= 6000);
        prop_assert_eq!(png, picture.to_png());
    }

    #[test]
    fn any_plan_is_drawn(grid in any_grid(), points in any_points(), start in any_pose(), goal in any_pose(), footprint in any_footprint()) {
        let scene = PlanScene { grid: &grid, start, goals: &[goal, start], replaced: &[goal], lanes: &[[start.position(), goal.position()]], route: &points, way_points: &points, curve: &points, footprint: &footprint, keep_out: None, slow: None };
        size_of(&plan_picture(&scene));
    }

    #[test]
    fn any_trajectory_is_drawn(a in any_points(), b in any_points(), z in any_number()) {
        let lift = |points: &[trundle_core::Vector2]| -> Vec<Vector3> { points.iter().map(|p| Vector3::new(p.x, z, p.y)).collect() };
        size_of(&trajectory_picture(&lift(&a), Some(&lift(&b))));
    }

    #[test]
    fn any_camera_view_is_drawn(width in 0..90_usize, height in 0..70_usize, marks in any_marks(), depths in prop::collection::vec(any::<f32>(), 8)) {
        let color = ColorImage::filled(width, height, [90, 120, 30]);
        size_of(&feature_picture(&color, &marks));
        let depth = DepthImage::from_fn(width, height, |x, y| depths[(x + y) % 8]);
        size_of(&depth_picture(&depth));
    }

    #[test]
    fn any_chart_is_drawn(points in prop::collection::vec((any_number(), any_number()), 0..40), limit in any_number(), log in any::<bool>()) {
        let chart = Chart::new("c", "x", "y").line("a", Color::BLUE, points.clone()).limit("l", limit);
        let svg = if log { chart.log_y() } else { chart }.to_svg();
        prop_assert!(!svg.contains("NaN") && !svg.contains("inf"));
        let bars = points.iter().fold(BarChart::new("b", "ms", "m", "p"), |bars, p| bars.row("r", p.0, p.1)).to_svg();
        prop_assert!(!bars.contains("NaN") && !bars.contains("inf"));
    }
}

#[test]
fn huge_maps_are_shrunk_and_stay_quick() {
    use trundle_core::{Cell, GridGeometry, OccupancyGrid, Vector2};
    let geometry = GridGeometry::new(0.05, Vector2::zeros(), 7_000, 3_100).expect("a geometry");
    let grid = OccupancyGrid::filled(geometry, Cell::Free);
    let (width, height) = size_of(&MapPicture::over(&grid).to_png());
    assert!(width <= 3300 && height <= 3300, "{width} x {height}");
}
