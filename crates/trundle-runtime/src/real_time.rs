//! The robot beside the clock on the wall: threads, queues, cores.
//!
//! The control thread feeds a deferring [`crate::Robot`] from an [`Inbox`]; a [`Crew`] does its long work, a thread a helper. Whatever
//! order the threads come to is the order in which the robot was fed, so who writes down events and answers in that order can
//! feed them again and gets the same reports.

mod crew;
mod inbox;
mod place;
mod pulse;

pub use crew::{Crew, CrewCost};
pub use inbox::{Inbox, InboxDoor, Input, Post};
pub use place::{Place, thread_time};
pub use pulse::{Pulse, PulseConfig, PulseReport};
