use serde_json::json;
use std::sync::{Arc, Mutex, PoisonError};
use trundle::core::{OccupancyGrid, Pose2, RgbdImage, Twist2, Vector2};
use trundle::io::{JPEG_QUALITY, encode_color};
use trundle::sim::Simulator;
use trundle::viz::{Color, LineStyle, MapPicture, PoseStyle, depth_picture};

/// Points of the way are kept this far apart, m.
const TRAIL: f64 = 0.05;

/// What the robot sees at one moment.
#[derive(Debug, Clone)]
pub struct RangeSource {
    image: RgbdImage,
    /// `world_from_base`.
    pose: Pose2,
    state: serde_json::Value,
}

impl RangeSource {
    /// What `robot`, asked to drive `twist`, sees in `image`.
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
pub struct Content {
    /// Its MIME type.
    pub mime: &'static str,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

/// The page behind the address that `--keys` prints: pictures are made when they are asked for.
#[derive(Debug)]
pub struct Page {
    grid: OccupancyGrid,
    now: Mutex<Option<Arc<RangeSource>>>,
    trail: Mutex<Vec<Vector2>>,
}

impl Page {
    /// A page with this map and nothing seen yet.
    pub fn new(grid: OccupancyGrid) -> Self {
        Self { grid, now: Mutex::default(), trail: Mutex::default() }
    }

    /// Shows something new.
    pub fn show(&self, sight: RangeSource) {
        let place = sight.pose.position();
        let mut trail = self.trail.lock().unwrap_or_else(PoisonError::into_inner);
        if trail.last().is_none_or(|last| (last - place).norm() > TRAIL) {
            trail.push(place);
        }
        drop(trail);
        *self.now.lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::new(sight));
    }

    /// What stands at a path such as `/color.jpg`, if anything does.
    pub fn get(&self, path: &str) -> Option<Content> {
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
            .polyline("way", &trail, LineStyle::solid(Color::BLUE))
            .pose("robot", pose, PoseStyle::named(Color::VERMILLION))
            .to_png()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle::core::{ColorImage, DepthImage, Stamp};

    #[test]
    fn everything_on_the_page_is_there_once_something_was_seen() {
        let page = Page::new(OccupancyGrid::from_ascii(0.5, "###\n#.#\n###").unwrap());
        assert!(page.get("/").is_some_and(|content| content.mime.starts_with("text/html")));
        assert_eq!(page.get("/color.jpg"), None);
        let (color, depth) = (ColorImage::filled(64, 48, [9, 99, 199]), DepthImage::filled(64, 48, 2.0));
        let image = RgbdImage::new(Stamp::default(), color, depth).unwrap();
        page.show(RangeSource { image, pose: Pose2::new(0.7, 0.7, 1.0), state: json!({"contacts": 0}) });
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
