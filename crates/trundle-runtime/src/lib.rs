//! The loop: schedule, configuration, record and replay.
