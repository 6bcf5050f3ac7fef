//! Device clocks mapped to one clock, and events put in order.
