//! Foxglove's WebSocket protocol, version 1: JSON for control, bytes for data. Source: docs/spec.md of github.com/foxglove/ws-protocol.

mod client_message;
mod server_message;
mod subprotocol;

pub use client_message::{ClientMessage, SubscriptionRequest};
pub use server_message::{StatusLevel, advertise, data_header, server_info, set_data_stamp, status};
pub use subprotocol::chosen_subprotocol;
