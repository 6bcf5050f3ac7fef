//! Detection of faults of wheels and gyro.

pub(crate) mod gyro_fault;
pub(crate) mod wheel_fault;
