//! People who walk given way-points.

mod person;

pub use person::Person;
