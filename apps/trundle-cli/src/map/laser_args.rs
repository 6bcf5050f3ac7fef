//! The options of `trundle map` for laser logs.

use crate::common_args::{BagTopicsArgs, NumberArg, NumberText};
use clap::Args;
use trundle::io::LaserLogOptions;

/// The laser of a log.
#[derive(Debug, Args)]
pub struct LaserArgs {
    /// Position of the laser ahead of the base's origin, m [default: the log's]
    #[arg(long, value_name = "M", value_parser = NumberArg(NumberText::any("m")), allow_negative_numbers = true)]
    pub laser_x: Option<f64>,
    /// Turn of the laser to the left, deg [default: the log's]
    #[arg(long, value_name = "DEG", value_parser = NumberArg(NumberText::any("deg")), allow_negative_numbers = true)]
    pub laser_turn: Option<f64>,
    /// The laser is mounted upside down.
    #[arg(long)]
    pub upside_down: bool,
    /// Smallest range that is no return, m [default: the most frequent largest reading]
    #[arg(long, value_name = "M", value_parser = NumberArg(NumberText::above_zero("m")), allow_negative_numbers = true)]
    pub max_range: Option<f64>,
    /// Treat all beams of a scan as measured at its stamp, even if the log has the time of each.
    #[arg(long, hide_short_help = true)]
    pub no_deskew: bool,
}

impl LaserArgs {
    /// The options for reading the log, with the topics of a bag.
    pub fn options(&self, topics: &BagTopicsArgs) -> LaserLogOptions {
        let mut options = LaserLogOptions::default();
        options.laser_x = self.laser_x;
        options.laser_turn = self.laser_turn.map(f64::to_radians);
        options.upside_down = self.upside_down;
        options.max_range = self.max_range;
        options.scan_topic.clone_from(&topics.scan_topic);
        options.odometry_topic.clone_from(&topics.odom_topic);
        options
    }

    /// The first given option.
    pub fn first_given(&self) -> Option<&'static str> {
        let options = [
            ("--laser-x", self.laser_x.is_some()),
            ("--laser-turn", self.laser_turn.is_some()),
            ("--upside-down", self.upside_down),
            ("--max-range", self.max_range.is_some()),
        ];
        options.into_iter().find(|(_, is_given)| *is_given).map(|(name, _)| name)
    }
}
