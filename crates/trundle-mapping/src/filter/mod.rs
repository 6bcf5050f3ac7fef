//! The Rao-Blackwellised particle filter: every particle a trajectory and its own map (docs/methods.md A3).

mod ancestry;
mod anchor;
mod bending;
mod bias;
mod carry;
mod chance;
mod closing;
mod coarse;
mod config;
mod directions;
mod find;
mod gate;
mod graph;
mod history;
mod likelihood;
mod locate;
mod mapper;
mod motion;
mod persist;
mod prior;
mod proposal;
mod publish;
mod report;
mod resample;
mod shape;
mod store;
mod trust;

pub use carry::carry_trajectory;
pub use config::{MotionConfig, ParticleConfig, PosePriorConfig};
pub use locate::{Localized, Lost, MapLocalizer};
pub use mapper::ParticleMapper;
pub use persist::FilterFileError;
pub use report::{Processed, Refusal, ScanUpdate};
pub(crate) use shape::{RaySpan, ScanShape};
