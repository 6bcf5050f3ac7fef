use super::palette::*;
use crate::camera::{FeatureMark, depth_picture, feature_picture};
use crate::color::Color;
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
    /// Charts, half a page wide each unless made wide.
    pub charts: Vec<Figure>,
    /// Tables.
    pub tables: Vec<Table>,
}

impl RunReport {
    /// The page: verdict and key numbers, the map, the goal from near, the camera's view, charts, tables.
    pub fn to_html(&self) -> String {
        let mut report = Report::new(&self.title).subtitle(&self.subtitle);
        if let Some(verdict) = &self.verdict {
            report = report.verdict(verdict.clone());
        }
        report = self.cards.iter().cloned().fold(report, Report::card);
        report = self.add_map(report);
        report = self.add_views(report);
        if !self.charts.is_empty() {
            report = report.section("Over time", "");
            report = self.charts.iter().cloned().fold(report, Report::figure);
        }
        if !self.tables.is_empty() {
            report = report.section("Numbers", "");
            report = self.tables.iter().cloned().fold(report, Report::table);
        }
        report.to_html()
    }

    /// The map with everything on it, as PNG with its legend inside.
    pub fn map_png(&self) -> Vec<u8> {
        self.map_picture().to_png()
    }

    fn add_map(&self, report: Report) -> Report {
        if self.grid.is_none() && self.estimated_path.is_empty() && self.true_path.is_empty() {
            return report;
        }
        let picture = self.map_picture();
        let figure = Figure::png("The map from above", &picture.clone().without_legend().to_png())
            .legend(picture.legend())
            .caption(
                "White floor was seen to be free, black is what stands in the way, grey was never seen. Coordinates are \
                 those of the map the robot made; x points right, y up.",
            )
            .wide();
        report.section("The map and the drive", "").figure(figure)
    }

    fn add_views(&self, report: Report) -> Report {
        let mut figures: Vec<Figure> = self.goal_figure().into_iter().collect();
        if let Some(view) = &self.camera {
            let picture = feature_picture(&view.color, &view.features);
            figures.push(Figure::png("What the camera saw", &picture).caption(
                "Circles are corners the robot recognises; the stroke is their orientation. Green ones were matched with \
                 landmarks and tell where the robot is.",
            ));
        }
        if let Some(depth) = &self.depth {
            figures.push(Figure::png("How far it was", &depth_picture(depth)).caption(
                "Depth of the same view: light is near, dark is far, black is where nothing was measured.",
            ));
        }
        if figures.is_empty() {
            return report;
        }
        figures.into_iter().fold(report.section("A closer look", ""), Report::figure)
    }

    fn map_picture(&self) -> MapPicture<'_> {
        let landmarks: Vec<Vector2> = self.landmarks.iter().map(|p| p.xy()).collect();
        let mut picture = match &self.grid {
            Some(grid) => MapPicture::over(grid),
            None => MapPicture::blank(),
        };
        picture = picture.dots("landmarks", &landmarks, DotStyle::crowd(LANDMARKS));
        if let Some((pose, scan)) = &self.scan {
            picture = picture.scan("last scan", *pose, scan, SCAN);
        }
        picture = picture
            .polyline("true path", &positions(&self.true_path), truth_line())
            .polyline("estimated path", &positions(&self.estimated_path), estimate_line())
            .polyline("planned curve", &self.curve, plan_line())
            .dots("way-points", &self.way_points, way_point_dots());
        for (label, pose, color) in [("start", self.start, START), ("goal", self.goal, GOAL)] {
            if let Some(pose) = pose {
                picture = picture.pose(label, pose, self.pose_style(color));
            }
        }
        picture
    }

    /// The last metre, where centimetres can be seen.
    fn goal_figure(&self) -> Option<Figure> {
        let goal = self.goal.filter(Pose2::is_finite)?;
        let radius = self.footprint.as_ref().map_or(0.2, Footprint::circumscribed_radius);
        let mut picture = match &self.grid {
            Some(grid) => MapPicture::over(grid),
            None => MapPicture::blank(),
        };
        picture = picture
            .polyline("true path", &positions(&self.true_path), truth_line())
            .polyline("estimated path", &positions(&self.estimated_path), estimate_line())
            .pose("goal", goal, self.pose_style(GOAL).nameless());
        let ends = [("believed end", &self.estimated_path, ESTIMATE), ("true end", &self.true_path, TRUTH)];
        for (label, path, color) in ends {
            if let Some(end) = path.iter().rev().find(|pose| pose.is_finite()) {
                picture = picture.pose(label, *end, self.pose_style(color).nameless());
            }
        }
        let picture = picture.window(goal.position(), 3.0 * radius);
        let png = picture.clone().without_legend().to_png();
        let figure = Figure::png("The goal from near", &png).legend(picture.legend());
        Some(figure.caption(
            "The robot's outline where it was to stand, where it believed to stand, and where it stood.",
        ))
    }

    fn pose_style(&self, color: Color) -> PoseStyle {
        PoseStyle { footprint: self.footprint.clone(), ..PoseStyle::named(color) }
    }
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
