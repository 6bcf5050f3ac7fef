//! Addresses that front ends listen on, and names under which a browser may reach them.

mod address;
mod own_name;

pub use address::{is_shared, read_address};
pub use own_name::{is_own_name, name_of_host};
