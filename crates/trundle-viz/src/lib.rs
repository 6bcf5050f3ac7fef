//! Pictures and the report of a run.
//!
//! A [`MapPicture`] is a map from above with paths, poses, landmarks and scans laid over it; [`plan_picture`] and
//! [`trajectory_picture`] are the ready-made ones of `trundle plan` and `trundle slam`. [`feature_picture`] and
//! [`depth_picture`] show what the camera saw. A [`Chart`] shows numbers over time. A [`Report`] puts all of it on one HTML
//! page that needs nothing but a browser, and [`RunReport`] fills that page from the data of a run.
//!
//! Pictures are 8-bit RGB PNGs. Colours are those of Okabe and Ito (2008), which readers with any colour vision can distinguish; each
//! colour has one meaning in all pictures. The typeface is part of the crate. No clock and no random number is used: equal content gives
//! equal bytes. No input is an error: numbers that are not finite are left out, an empty grid or image gives an empty picture, and a too
//! large picture is shrunk.
//!
//! ```
//! use trundle_viz::{Chart, Color};
//! let speeds = vec![(0.0, 0.0), (1.0, 0.3), (2.0, 0.3)];
//! let chart = Chart::new("Speed", "time, s", "speed, m/s").line("v", Color::BLUE, speeds);
//! assert!(chart.to_svg_file().starts_with("<svg"));
//! ```

mod camera;
mod canvas;
mod chart;
mod clip;
mod color;
mod colormap;
mod compose;
mod font;
mod html;
mod legend;
mod map;
mod report;
mod text;
mod ticks;
mod wedge;

pub use camera::{FeatureMark, depth_picture, feature_picture};
pub use chart::{BarChart, Chart, GroupChart};
pub use color::Color;
pub use compose::{
    CameraView, MaskShares, PlanParts, PlanScene, RunMap, RunReport, VisualMapScene, no_plan_picture,
    plan_part_pictures, plan_picture, speed_charts, trajectory_picture, visual_map_picture,
};
pub use legend::{LegendItem, Mark};
pub use map::{DotStyle, LineStyle, MapPicture, PoseStyle, tiles};
pub use report::{Card, Figure, Report, Table, Verdict};
