//! The report page of a run.

use super::palette::*;
use crate::camera::{FeatureMark, depth_picture, feature_picture};
use crate::color::Color;
use crate::legend::Mark;
use crate::map::{DotStyle, MapPicture, PoseStyle};
use crate::report::{Card, Figure, Report, Table, Verdict};
use trundle_core::{ColorImage, DepthImage, Footprint, OccupancyGrid, Pose2, Scan, Vector2, Vector3};

/// What the camera saw at one moment, and which features were found in it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CameraView {
    /// The colour image.
    pub color: ColorImage,
    /// Its features.
    pub features: Vec<FeatureMark>,
}

/// All that the report of a run shows: fill in what there is; what is empty or `None` is left out of the page.
/// Geometry is in the map frame, m.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RunReport {
    /// Title of the page.
    pub title: String,
    /// One or two sentences: what was run, on what.
    pub subtitle: String,
    /// How it went.
    pub verdict: Option<Verdict>,
    /// Key numbers.
    pub cards: Vec<Card>,
    /// The occupancy grid at the end.
    pub grid: Option<OccupancyGrid>,
    /// Visual landmarks; seen from above.
    pub landmarks: Vec<Vector3>,
    /// The way-points of the plan.
    pub way_points: Vec<Vector2>,
    /// Points along the fitted curve, close together.
    pub curve: Vec<Vector2>,
    /// Where the robot believed to be.
    pub estimated_path: Vec<Pose2>,
    /// Where it was.
    pub true_path: Vec<Pose2>,
    /// Where it started.
    pub start: Option<Pose2>,
    /// Where it was to stand.
    pub goal: Option<Pose2>,
    /// The robot's outline.
    pub footprint: Option<Footprint>,
    /// A scan and the pose it was taken at (`map_from_base`).
    pub scan: Option<(Pose2, Scan)>,
    /// The camera view with features.
    pub camera: Option<CameraView>,
    /// The depth image of the same moment.
    pub depth: Option<DepthImage>,
    /// More pictures, shown after the map.
    pub figures: Vec<Figure>,
    /// Charts, half a page wide each unless made wide.
    pub charts: Vec<Figure>,
    /// Tables.
    pub tables: Vec<Table>,
}

impl RunReport {
    /// The page: verdict and key numbers, the map, the camera's view, charts, the goal from near and tables.
    pub fn to_html(&self) -> String {
        let mut report = Report::new(&self.title).subtitle(&self.subtitle);
        if let Some(verdict) = &self.verdict {
            report = report.verdict(verdict.clone());
        }
        report = self.cards.iter().cloned().fold(report, Report::card);
        let pictures = self.map_figure().into_iter().chain(self.figures.iter().cloned());
        let goal: Vec<Figure> = self.goal_figure().into_iter().collect();
        report = add_figures(report, "Map and motion", pictures.collect());
        report = add_figures(report, "What the camera saw", self.camera_figures());
        report = add_figures(report, "Over time", self.charts.clone());
        if !(goal.is_empty() && self.tables.is_empty()) {
            report = report.section("Numbers", "");
        }
        report = goal.into_iter().fold(report, Report::figure);
        self.tables.iter().cloned().fold(report, Report::table).to_html()
    }

    /// The map with everything on it, as PNG with its legend inside.
    pub fn map_png(&self) -> Vec<u8> {
        self.map_picture().to_png()
    }

    fn map_figure(&self) -> Option<Figure> {
        if self.grid.is_none() && self.estimated_path.is_empty() && self.true_path.is_empty() {
            return None;
        }
        let picture = self.map_picture();
        let figure = Figure::png("The map from above", &picture.clone().without_legend().to_png());
        let caption = "White floor was seen to be free, black is what stands in the way, grey was never seen. The \
                       coordinates are those of the map the robot made: x to the right, y up.";
        Some(figure.legend(picture.legend()).caption(caption).wide())
    }

    fn camera_figures(&self) -> Vec<Figure> {
        let camera = self.camera.as_ref().map(|view| {
            Figure::png("Colour image and its features", &feature_picture(&view.color, &view.features)).caption(
                "Circles are corners the robot recognises, a stroke shows their orientation. Green ones were matched with \
                 landmarks and tell where the robot is.",
            )
        });
        let depth = self.depth.as_ref().map(|depth| {
            Figure::png("Depth image", &depth_picture(depth)).caption(
                "How far everything was: light is near, dark is far, black is where nothing was measured.",
            )
        });
        camera.into_iter().chain(depth).collect()
    }

    fn map_picture(&self) -> MapPicture<'_> {
        let landmarks: Vec<Vector2> = self.landmarks.iter().map(|p| p.xy()).collect();
        let mut picture = self.ground().dots("landmarks", &landmarks, DotStyle::crowd(LANDMARKS));
        if let Some((pose, scan)) = &self.scan {
            picture = picture.scan("last scan", *pose, scan, SCAN);
        }
        picture = picture
            .polyline("planned curve", &self.curve, plan_line())
            .polyline("true path", &positions(&self.true_path), truth_line())
            .polyline("estimated path", &positions(&self.estimated_path), estimate_line())
            .dots("way-points", &self.way_points, way_point_dots());
        for (label, pose, color) in [("start", self.start, START), ("goal", self.goal, GOAL)] {
            if let Some(pose) = pose {
                picture = picture.pose(label, pose, self.pose_style(color));
            }
        }
        picture
    }

    /// The last half metre, where centimetres can be seen.
    fn goal_figure(&self) -> Option<Figure> {
        let goal = self.goal.filter(Pose2::is_finite)?;
        let footprint = self.footprint.clone().unwrap_or(Footprint::KOBUKI);
        let end = |path: &[Pose2]| path.iter().rev().find(|pose| pose.is_finite()).copied();
        let ends = |path: &[Pose2]| end(path).into_iter().collect::<Vec<_>>();
        let picture = self
            .ground()
            .polyline("true path", &positions(&self.true_path), truth_line())
            .polyline("estimated path", &positions(&self.estimated_path), estimate_line())
            .pose("goal", goal, self.pose_style(GOAL).nameless())
            .outlines("where it stood", &ends(&self.true_path), &footprint, TRUTH)
            .outlines("where it believed to stand", &ends(&self.estimated_path), &footprint, ESTIMATE)
            .window(goal.position(), 1.7 * footprint.circumscribed_radius())
            .lettering(1.75);
        let png = picture.clone().without_legend().to_png();
        let legend = picture.legend().into_iter().filter(|item| item.mark != Mark::Cell).collect();
        let caption = "The robot's outline where it was to stand and where it came to stand; a stroke shows its heading.";
        Some(Figure::png("The goal from near", &png).legend(legend).caption(caption))
    }

    fn ground(&self) -> MapPicture<'_> {
        self.grid.as_ref().map_or_else(MapPicture::blank, MapPicture::over)
    }

    fn pose_style(&self, color: Color) -> PoseStyle {
        PoseStyle { footprint: self.footprint.clone(), ..PoseStyle::named(color) }
    }
}

/// A section of figures; none when there is no figure.
fn add_figures(report: Report, title: &str, figures: Vec<Figure>) -> Report {
    if figures.is_empty() {
        return report;
    }
    figures.into_iter().fold(report.section(title, ""), Report::figure)
}

fn positions(poses: &[Pose2]) -> Vec<Vector2> {
    poses.iter().map(Pose2::position).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_run_is_still_a_page() {
        let html = RunReport { title: "nothing".into(), ..RunReport::default() }.to_html();
        assert!(html.contains("nothing") && !html.contains("<img"));
    }

    #[test]
    fn what_is_given_is_shown() {
        let pose = Pose2::new(0.2, 0.2, 0.0);
        let run = RunReport {
            grid: OccupancyGrid::from_ascii(0.1, "####\n#..#\n####").ok(),
            estimated_path: vec![pose],
            goal: Some(pose),
            camera: Some(CameraView::default()),
            depth: Some(DepthImage::default()),
            tables: vec![Table::new("numbers", ["a"])],
            ..RunReport::default()
        };
        let html = run.to_html();
        assert_eq!(html.matches("<img").count(), 4);
        assert_eq!(html, run.to_html());
    }
}
