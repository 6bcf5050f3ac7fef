//! The report page of a run.

use super::run_map::RunMap;
use crate::camera::{FeatureMark, depth_picture, feature_picture};
use crate::report::{Card, Figure, Report, Table, Verdict};
use trundle_core::{ColorImage, DepthImage};

/// An image with its features.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CameraView {
    /// The colour image.
    pub color: ColorImage,
    /// Features of the image.
    pub features: Vec<FeatureMark>,
}

/// The content of a run's report; empty parts and `None` are left out of the page.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RunReport {
    /// One or two sentences: the command and its input.
    pub title: String,
    /// One or two sentences: what was run, on what.
    pub subtitle: String,
    /// Links to other files of the folder: text and name of the file.
    pub links: Vec<(String, String)>,
    /// The verdict.
    pub verdict: Option<Verdict>,
    /// Key numbers.
    pub cards: Vec<Card>,
    /// The map with its overlays.
    pub map: RunMap,
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
    /// The states of the robot, in order.
    pub states: Option<Table>,
}

impl RunReport {
    /// The page: verdict and key numbers, the map, the camera's view, charts, the goal from near, tables and states.
    pub fn to_html(&self) -> String {
        let mut report = Report::new(&self.title).subtitle(&self.subtitle);
        report = self.links.iter().fold(report, |report, (text, file)| report.link(text, file));
        if let Some(verdict) = &self.verdict {
            report = report.verdict(verdict.clone());
        }
        report = self.cards.iter().cloned().fold(report, Report::card);
        let pictures = self.map.figure().into_iter().chain(self.figures.iter().cloned());
        let goal: Vec<Figure> = self.map.goal_figure().into_iter().collect();
        report = add_figures(report, "Map and motion", pictures.collect());
        report = add_figures(report, "Camera", self.camera_figures());
        report = add_figures(report, "Over time", self.charts.clone());
        if !(goal.is_empty() && self.tables.is_empty()) {
            report = report.section("Numbers", "");
        }
        report = goal.into_iter().fold(report, Report::figure);
        report = self.tables.iter().cloned().fold(report, Report::table);
        match &self.states {
            Some(states) => report.section("States", "").table(states.clone()).to_html(),
            None => report.to_html(),
        }
    }

    fn camera_figures(&self) -> Vec<Figure> {
        let camera = self.camera.as_ref().map(|view| {
            Figure::png("Colour image and its features", &feature_picture(&view.color, &view.features))
                .caption(
                    "Circles: features, a stroke shows their orientation. Green: matched with landmarks.",
                )
        });
        let depth = self.depth.as_ref().map(|depth| {
            Figure::png("Depth image", &depth_picture(depth))
                .caption("Light: near. Dark: far. Black: no measurement.")
        });
        camera.into_iter().chain(depth).collect()
    }
}

/// Adds a section of figures to a report. Without figures the report is unchanged.
fn add_figures(report: Report, title: &str, figures: Vec<Figure>) -> Report {
    if figures.is_empty() {
        return report;
    }
    figures.into_iter().fold(report.section(title, ""), Report::figure)
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{OccupancyGrid, Pose2};

    #[test]
    fn an_empty_run_is_still_a_page() {
        let html = RunReport { title: "nothing".into(), ..RunReport::default() }.to_html();
        assert!(html.contains("nothing") && !html.contains("<img"));
    }

    #[test]
    fn given_parts_are_shown() {
        let pose = Pose2::new(0.2, 0.2, 0.0);
        let run = RunReport {
            map: RunMap {
                grid: OccupancyGrid::from_ascii(0.1, "####\n#..#\n####").ok(),
                estimated_path: vec![pose],
                goal: Some(pose),
                ..RunMap::default()
            },
            camera: Some(CameraView::default()),
            depth: Some(DepthImage::default()),
            tables: vec![Table::new("numbers", ["a"])],
            links: vec![("Durations".into(), "timing.html".into())],
            states: Some(Table::new("changes", ["a"]).folded()),
            ..RunReport::default()
        };
        let html = run.to_html();
        assert_eq!(html.matches("<img").count(), 4);
        assert!(html.contains("./timing.html") && html.contains("<h2>States</h2>"));
        assert_eq!(html, run.to_html());
    }
}
