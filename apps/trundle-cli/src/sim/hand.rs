//! Driving by hand: keys in the terminal, a page in the browser, the clock on the wall.

mod page;
mod server;
mod steering;
mod terminal;

use crate::console;
use page::{Page, RangeSource};
use server::Server;
use steering::Steering;
use terminal::RawTerminal;
use trundle::app::AppError;
use trundle::app::real_time::RealTimePacer;
use trundle::core::{OccupancyGrid, RgbdImage, Stamp, Twist2};
use trundle::sim::Simulator;

/// Somebody at the keys.
pub struct Hand {
    steering: Steering,
    live: Option<Live>,
}

/// What is there only while driving.
struct Live {
    terminal: RawTerminal,
    server: Server,
    pacer: RealTimePacer,
}

impl Hand {
    /// Somebody who is not driving yet.
    ///
    /// # Errors
    /// When there is no terminal to read keys from.
    pub fn ready() -> Result<Self, AppError> {
        terminal::require()?;
        Ok(Self { steering: Steering::default(), live: None })
    }

    /// Begins to drive; `grid` is what the page shows as the map.
    ///
    /// # Errors
    /// When the page cannot be served or the terminal gives no keys.
    pub fn begin(&mut self, grid: OccupancyGrid, quiet: bool) -> Result<(), AppError> {
        let server = Server::start(Page::new(grid))?;
        if !quiet {
            console::print(&format!("See {} for what the robot sees.", server.url()));
            console::print("Arrows or WASD: faster, slower, left, right. Space: stop. Q: quit.");
        }
        self.live = Some(Live { terminal: RawTerminal::new()?, server, pacer: RealTimePacer::start() });
        Ok(())
    }

    /// What the keys ask for by now; waits until the clock on the wall has come to `stamp`.
    ///
    /// # Errors
    /// When the terminal gives no keys any more.
    pub fn twist(&mut self, stamp: Stamp) -> Result<Twist2, AppError> {
        if let Some(live) = &mut self.live {
            live.pacer.wait_for(stamp.as_secs());
            for key in live.terminal.pressed()? {
                self.steering.press(key);
            }
        }
        Ok(self.steering.twist())
    }

    /// Shows on the page what the robot sees.
    pub fn show(&self, image: &RgbdImage, robot: &Simulator) {
        if let Some(live) = &self.live {
            live.server.page().show(RangeSource::of(image, robot, self.steering.twist()));
        }
    }

    /// Whether the driver has had enough.
    pub fn has_quit(&self) -> bool {
        self.steering.has_quit()
    }
}
