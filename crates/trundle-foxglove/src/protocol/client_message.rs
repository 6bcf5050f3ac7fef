//! Messages of a viewer. All but subscriptions would change something, and are refused.

use serde::Deserialize;

/// A message of a viewer.
#[derive(Debug, PartialEq, Eq, Deserialize)]
#[serde(tag = "op", rename_all = "camelCase", rename_all_fields = "camelCase")]
pub enum ClientMessage {
    /// Start of subscriptions.
    Subscribe {
        /// The subscriptions.
        subscriptions: Vec<SubscriptionRequest>,
    },
    /// End of subscriptions.
    Unsubscribe {
        /// Numbers of the subscriptions, as the viewer chose them.
        subscription_ids: Vec<u32>,
    },
    /// Any other message of the protocol.
    #[serde(other)]
    Other,
}

/// A subscription to a channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct SubscriptionRequest {
    /// Number of the subscription, chosen by the viewer.
    pub id: u32,
    /// Number of the channel.
    pub channel_id: u32,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subscriptions_are_read_and_all_else_is_other() {
        let read = |text: &str| serde_json::from_str::<ClientMessage>(text).ok();
        let subscriptions = vec![SubscriptionRequest { id: 7, channel_id: 2 }];
        assert_eq!(
            read(r#"{"op":"subscribe","subscriptions":[{"id":7,"channelId":2}]}"#),
            Some(ClientMessage::Subscribe { subscriptions })
        );
        assert_eq!(
            read(r#"{"op":"unsubscribe","subscriptionIds":[7]}"#),
            Some(ClientMessage::Unsubscribe { subscription_ids: vec![7] })
        );
        assert_eq!(read(r#"{"op":"advertise","channels":[]}"#), Some(ClientMessage::Other));
        assert_eq!(read(r#"{"op":"subscribe"}"#), None);
        assert_eq!(read("[]"), None);
    }
}
