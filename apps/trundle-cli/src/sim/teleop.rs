//! Driving by hand: keys in the terminal, a page in the browser, in real time.

mod keys;
mod terminal;

use crate::console;
use keys::steering_key;
use terminal::RawTerminal;
use trundle::app::AppError;
use trundle::app::real_time::RealTimePacer;
use trundle::core::{OccupancyGrid, Pose2, RgbdImage, Stamp, Twist2};
use trundle::experiments::sim_drive::SimDriver;
use trundle::experiments::teleop::{RobotView, Steering, TeleopPage, TeleopServer};
use trundle::sim::Simulator;

/// A driver at the keys.
pub struct TeleopDriver {
    steering: Steering,
    terminal: RawTerminal,
    server: TeleopServer,
    pacer: RealTimePacer,
}

/// Refuses to drive by hand if there is no terminal to read keys from.
///
/// # Errors
/// When standard input is not a terminal.
pub fn require_terminal() -> Result<(), AppError> {
    terminal::require()
}

impl TeleopDriver {
    /// Starts to drive; `grid` is the map on the page.
    ///
    /// # Errors
    /// When the page cannot be served or the terminal gives no keys.
    pub fn start(grid: OccupancyGrid, quiet: bool) -> Result<Self, AppError> {
        let server = TeleopServer::start(TeleopPage::new(grid))?;
        if !quiet {
            console::print(&format!("See {} for what the robot sees.", server.url()));
            console::print("Arrows or WASD: faster, slower, left, right. Space: stop. Q: quit.");
        }
        let terminal = RawTerminal::new()?;
        Ok(Self { steering: Steering::default(), terminal, server, pacer: RealTimePacer::start() })
    }
}

impl SimDriver for TeleopDriver {
    /// The twist of the keys; waits until real time has come to `stamp`.
    fn twist(&mut self, stamp: Stamp, _pose: Pose2) -> Result<Twist2, AppError> {
        self.pacer.wait_for(stamp.as_secs());
        self.terminal
            .pressed()?
            .into_iter()
            .filter_map(steering_key)
            .for_each(|key| self.steering.press(key));
        Ok(self.steering.twist())
    }

    fn end_s(&self) -> Option<f64> {
        self.steering.has_quit().then_some(0.0)
    }

    fn show(&mut self, image: &RgbdImage, robot: &Simulator) {
        self.server.page().show(RobotView::of(image, robot, self.steering.twist()));
    }
}
