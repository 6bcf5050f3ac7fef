//! The options of `trundle map` for laser logs.

use crate::common_args::NumberArg;
use clap::Args;
use trundle::io::LaserLogOptions;

/// The laser of a log, and the topics of a bag.
#[derive(Debug, Args)]
pub struct LaserArgs {
    /// Position of the laser ahead of the base's origin, m [default: the log's]
    #[arg(long, value_name = "M", value_parser = NumberArg::any("m"), allow_negative_numbers = true)]
    pub laser_x: Option<f64>,
    /// Turn of the laser to the left, deg [default: the log's]
    #[arg(long, value_name = "DEG", value_parser = NumberArg::any("deg"), allow_negative_numbers = true)]
    pub laser_turn: Option<f64>,
    /// The laser is mounted upside down.
    #[arg(long)]
    pub upside_down: bool,
    /// Smallest range that is no return, m [default: the most frequent largest reading]
    #[arg(long, value_name = "M", value_parser = NumberArg::above_zero("m"), allow_negative_numbers = true)]
    pub max_range: Option<f64>,
    /// The topic of the scans; in a CARMEN log the name of the lines, as RAWLASER2 [default: the one with the largest number of scans]
    #[arg(long, value_name = "TOPIC")]
    pub scan_topic: Option<String>,
}

impl LaserArgs {
    /// The options for reading the log, with the topic of a bag's odometry.
    pub fn options(&self, odometry_topic: Option<String>) -> LaserLogOptions {
        let mut options = LaserLogOptions::default();
        options.laser_x = self.laser_x;
        options.laser_turn = self.laser_turn.map(f64::to_radians);
        options.upside_down = self.upside_down;
        options.max_range = self.max_range;
        options.scan_topic = self.scan_topic.clone();
        options.odometry_topic = odometry_topic;
        options
    }

    /// The first given option.
    pub fn first_given(&self) -> Option<&'static str> {
        let options = [
            ("--laser-x", self.laser_x.is_some()),
            ("--laser-turn", self.laser_turn.is_some()),
            ("--upside-down", self.upside_down),
            ("--max-range", self.max_range.is_some()),
            ("--scan-topic", self.scan_topic.is_some()),
        ];
        options.into_iter().find(|(_, is_given)| *is_given).map(|(name, _)| name)
    }
}
