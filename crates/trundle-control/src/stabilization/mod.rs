//! Point stabilisation: drive to a pose and rest there (docs/methods.md A7; \[Aicardi95\]).
//!
//! Problem: no smooth law of the pose alone brings a two-wheeled robot to rest at a pose \[Brockett83\]. Idea: in polar coordinates around
//! the goal a linear law does. The robot drives forward or backward, depending on the direction of the goal. Within the position tolerance
//! a turn on the spot corrects the heading. Cost: O(1).
//!
//! | paper | name here | unit |
//! |---|---|---|
//! | rho | `Polar::distance` | m |
//! | alpha | `Polar::bearing`: the direction of the goal in the robot's frame | rad |
//! | beta | `Polar::approach`: goal heading minus direction of the goal | rad |
//! | k_rho, k_alpha, k_beta | [`StabilizerConfig`]'s | 1/s |

pub(crate) mod polar_law;
pub(crate) mod stabilizer;
pub(crate) mod stabilizer_config;
pub(crate) mod stabilizer_preview;
