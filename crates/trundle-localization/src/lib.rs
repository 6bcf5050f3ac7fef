//! From wheels, gyro and visual pose to one pose estimate.
