//! The version of the protocol, chosen while a connection opens.

/// Supported subprotocols, the newest first. Their messages are the same without optional capabilities. `foxglove.sdk.v1` is that of
/// Foxglove, `foxglove.websocket.v1` that of Lichtblick and of older versions of Foxglove.
const SUBPROTOCOLS: [&str; 2] = ["foxglove.sdk.v1", "foxglove.websocket.v1"];

/// The newest supported subprotocol of the offered ones; each offer is a list with commas.
pub fn chosen_subprotocol(offers: &[&str]) -> Option<&'static str> {
    let is_offered = |known: &str| offers.iter().any(|offer| offer.split(',').any(|one| one.trim() == known));
    SUBPROTOCOLS.into_iter().find(|known| is_offered(known))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_known_subprotocol_is_chosen() {
        assert_eq!(chosen_subprotocol(&["foxglove.websocket.v1, foxglove.sdk.v1"]), Some("foxglove.sdk.v1"));
        assert_eq!(chosen_subprotocol(&["x", "foxglove.websocket.v1"]), Some("foxglove.websocket.v1"));
        assert_eq!(chosen_subprotocol(&["foxglove.sdk.v1.1"]), None);
        assert_eq!(chosen_subprotocol(&[]), None);
    }
}
