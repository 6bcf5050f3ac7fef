//! The Rao-Blackwellised particle filter: every particle a trajectory and its own map (METHODS A3).

mod ancestry;
mod carry;
mod chance;
mod closing;
mod coarse;
mod config;
mod directions;
mod find;
mod graph;
mod history;
mod likelihood;
mod mapper;
mod motion;
mod prior;
mod proposal;
mod publish;
mod resample;
mod shape;
mod store;

pub use carry::carry_trajectory;
pub use config::{MotionConfig, ParticleConfig};
pub use mapper::{ParticleMapper, Processed, Refusal, ScanUpdate};
pub(crate) use shape::ScanShape;
