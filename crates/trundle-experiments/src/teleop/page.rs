//! The page and its pictures, made on request.

use serde_json::json;
use std::sync::{Arc, Mutex, PoisonError};
use trundle_core::{OccupancyGrid, Pose2, RgbdImage, Twist2, Vector2};
use trundle_io::{JPEG_QUALITY, encode_color};
use trundle_sim::Simulator;
use trundle_viz::{Color, LineStyle, MapPicture, PoseStyle, depth_picture};

/// Distance of two points of the path on the map \[m\]. Source: ours.
const MIN_TRAIL_SPACING_M: f64 = 0.05;

/// The newest image, pose and state of the robot.
#[derive(Debug, Clone)]
pub struct RobotView {
    image: RgbdImage,
    /// `world_from_base`.
    pose: Pose2,
    state: serde_json::Value,
}

impl RobotView {
    /// The view of `robot` at `image`, under the command `twist`.
    #[must_use]
    pub fn of(image: &RgbdImage, robot: &Simulator, twist: Twist2) -> Self {
        let pose = robot.true_pose();
        let state = json!({
            "time_s": image.stamp().as_secs(),
            "x_m": pose.x,
            "y_m": pose.y,
            "heading_deg": pose.theta.to_degrees(),
            "v_m_s": twist.v,
            "omega_rad_s": twist.omega,
            "clearance_m": robot.clearance(),
            "contacts": robot.contacts(),
        });
        Self { image: image.clone(), pose, state }
    }
}

/// A file of the page.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Content {
    /// Its MIME type.
    pub mime: &'static str,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

/// The page and its pictures, made on request.
#[derive(Debug)]
pub struct TeleopPage {
    grid: OccupancyGrid,
    now: Mutex<Option<Arc<RobotView>>>,
    trail: Mutex<Vec<Vector2>>,
}

impl TeleopPage {
    /// A page with this map, without a view.
    #[must_use]
    pub fn new(grid: OccupancyGrid) -> Self {
        Self { grid, now: Mutex::default(), trail: Mutex::default() }
    }

    /// Shows a newer view.
    pub fn show(&self, view: RobotView) {
        let place = view.pose.position();
        let mut trail = self.trail.lock().unwrap_or_else(PoisonError::into_inner);
        if trail.last().is_none_or(|last| (last - place).norm() > MIN_TRAIL_SPACING_M) {
            trail.push(place);
        }
        drop(trail);
        *self.now.lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::new(view));
    }

    /// The file at a path such as `/color.jpg`.
    pub(super) fn get(&self, path: &str) -> Option<Content> {
        let path = path.split('?').next().unwrap_or_default();
        if path == "/" {
            let bytes = include_bytes!("page.html").to_vec();
            return Some(Content { mime: "text/html; charset=utf-8", bytes });
        }
        let now = self.now.lock().unwrap_or_else(PoisonError::into_inner).clone()?;
        let (mime, bytes) = match path {
            "/color.jpg" => ("image/jpeg", encode_color(now.image.color(), JPEG_QUALITY).ok()?),
            "/depth.png" => ("image/png", depth_picture(now.image.depth())),
            "/map.png" => ("image/png", self.map(now.pose)),
            "/state.json" => ("application/json", now.state.to_string().into_bytes()),
            _ => return None,
        };
        Some(Content { mime, bytes })
    }

    fn map(&self, pose: Pose2) -> Vec<u8> {
        let trail = self.trail.lock().unwrap_or_else(PoisonError::into_inner).clone();
        MapPicture::over(&self.grid)
            .polyline("path", &trail, LineStyle::solid(Color::BLUE))
            .pose("robot", pose, PoseStyle::named(Color::VERMILLION))
            .to_png()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{ColorImage, DepthImage, Stamp};

    #[test]
    fn everything_on_the_page_is_there_once_there_is_a_view() {
        let page = TeleopPage::new(OccupancyGrid::from_ascii(0.5, "###\n#.#\n###").unwrap());
        assert!(page.get("/").is_some_and(|content| content.mime.starts_with("text/html")));
        assert_eq!(page.get("/color.jpg"), None);
        let (color, depth) = (ColorImage::filled(64, 48, [9, 99, 199]), DepthImage::filled(64, 48, 2.0));
        let image = RgbdImage::new(Stamp::default(), color, depth).unwrap();
        page.show(RobotView { image, pose: Pose2::new(0.7, 0.7, 1.0), state: json!({"contacts": 0}) });
        let html = String::from_utf8(page.get("/").unwrap().bytes).unwrap();
        for path in ["/color.jpg", "/depth.png", "/map.png", "/state.json"] {
            assert!(html.contains(path), "{path} is not on the page");
            assert!(
                page.get(&format!("{path}?17")).is_some_and(|content| content.bytes.len() > 10),
                "{path}"
            );
        }
        assert_eq!(page.get("/etc/passwd"), None);
    }
}
