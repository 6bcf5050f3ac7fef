//! Worlds, robot dynamics and sensors with noise and ground truth.
