//! The program `trundle`.
fn main() {}
