//! Point stabilisation: to a pose, and to rest there (docs/methods.md A7; \[Aicardi95\]).
//!
//! Problem: no smooth law of the pose alone brings a two-wheeled robot to rest at a pose \[Brockett83\]. Idea: in polar
//! coordinates about the goal a linear law does; it is driven forward or backward, whichever the goal asks for. What is
//! left of the heading within the position tolerance is turned on the spot, which is exact for such a base. Cost: O(1).
//!
//! | paper | name here | unit |
//! |---|---|---|
//! | rho | `Polar::distance` | m |
//! | alpha | `Polar::bearing`: the goal's direction, seen from the robot | rad |
//! | beta | `Polar::approach`: by how much the goal's heading is counter-clockwise of the goal's direction | rad |
//! | k_rho, k_alpha, k_beta | [`SettleConfig`]'s | 1/s |

mod config;
mod polar;
mod preview;
mod stabilizer;

pub use config::SettleConfig;
pub use preview::SettlePreview;
pub use stabilizer::{SettleReport, SettleState, Stabilizer};
