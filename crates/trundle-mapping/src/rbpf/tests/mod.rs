//! Laws of the particle filter's parts.

mod ancestry;
mod map_publisher;
mod odometry;
mod particle_set;
mod propagate;
mod rng;
mod update_gate;
