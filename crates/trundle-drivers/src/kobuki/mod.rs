//! The Kobuki base: its serial protocol, driver and emulator.
//!
//! | module | content |
//! |---|---|
//! | [`protocol`] | commands and feedback packets, to bytes and from bytes |
//! | [`decoder`] | packets out of a damaged stream of bytes |

pub mod decoder;
pub mod protocol;
