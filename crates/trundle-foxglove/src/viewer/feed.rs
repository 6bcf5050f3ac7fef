//! Subscriptions of a viewer, and the messages that it lacks.

use crate::protocol::{ClientMessage, StatusLevel, SubscriptionRequest, data_header, set_data_stamp, status};
use crate::topic::RunTopic;
use std::collections::BTreeMap;
use std::sync::Arc;
use trundle_app::operator::{Operator, RunView};

/// Subscriptions of a viewer.
#[derive(Default)]
pub struct Feed {
    subscriptions: BTreeMap<RunTopic, Subscription>,
}

/// A subscription to a topic.
struct Subscription {
    /// Number that the viewer chose.
    id: u32,
    /// The view that was sent last.
    sent: Option<Arc<RunView>>,
}

impl Feed {
    /// Takes a message of the viewer.
    ///
    /// # Errors
    /// The answer to a message that has no effect.
    pub fn take(&mut self, text: &str) -> Result<(), String> {
        match serde_json::from_str(text) {
            Ok(ClientMessage::Subscribe { subscriptions }) => {
                subscriptions.into_iter().try_for_each(|request| self.subscribe(request))
            }
            Ok(ClientMessage::Unsubscribe { subscription_ids }) => {
                self.subscriptions.retain(|_, subscription| !subscription_ids.contains(&subscription.id));
                Ok(())
            }
            Ok(ClientMessage::Other) => Err(Self::refusal()),
            Err(_) => Err(status(StatusLevel::Error, "the message is none of the protocol")),
        }
    }

    /// The answer to a message that would change something.
    pub fn refusal() -> String {
        status(
            StatusLevel::Error,
            "the run is shown to view only: this server takes subscriptions and nothing else",
        )
    }

    fn subscribe(&mut self, request: SubscriptionRequest) -> Result<(), String> {
        let SubscriptionRequest { id, channel_id } = request;
        let topic = RunTopic::of_channel(channel_id)
            .ok_or_else(|| status(StatusLevel::Error, &format!("there is no channel {channel_id}")))?;
        let is_used = self.subscriptions.values().any(|known| known.id == id);
        if is_used || self.subscriptions.contains_key(&topic) {
            let text = format!("{} has a subscription, or the number {id} is in use", topic.name());
            return Err(status(StatusLevel::Warning, &text));
        }
        self.subscriptions.insert(topic, Subscription { id, sent: None });
        Ok(())
    }

    /// The newest view, if a subscription needs one. The run copies map, scan and image only for subscriptions to them.
    pub fn view(&self, operator: &Operator) -> Option<Arc<RunView>> {
        if self.subscriptions.is_empty() {
            return None;
        }
        let is_watched = self.subscriptions.keys().any(|topic| topic.is_copied_on_demand());
        if is_watched { operator.view() } else { operator.peek() }
    }

    /// The message of a topic, if the viewer has subscribed to it and lacks it.
    pub fn message(&mut self, topic: RunTopic, view: &Arc<RunView>) -> Option<Vec<u8>> {
        let subscription = self.subscriptions.get_mut(&topic)?;
        if subscription.sent.as_ref().is_some_and(|sent| !topic.differs(sent, view)) {
            return None;
        }
        let mut bytes = data_header(subscription.id);
        let stamp = topic.append(view, &mut bytes)?;
        set_data_stamp(&mut bytes, stamp);
        subscription.sent = Some(Arc::clone(view));
        Some(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_app::operator::{Activity, operator_link};
    use trundle_core::{Pose2, Stamp, Twist2};

    fn view(nanos: i64) -> Arc<RunView> {
        let activity = Activity { name: "tracking", reason: None };
        Arc::new(RunView::of_activity(Stamp::from_nanos(nanos), Pose2::IDENTITY, Twist2::ZERO, activity))
    }

    #[test]
    fn a_message_is_sent_once_and_again_when_it_changes() {
        let mut feed = Feed::default();
        feed.take(r#"{"op":"subscribe","subscriptions":[{"id":5,"channelId":1},{"id":6,"channelId":8}]}"#)
            .unwrap();
        let first = feed.message(RunTopic::Transforms, &view(1)).unwrap();
        assert_eq!(first[..6], [1, 5, 0, 0, 0, 1]);
        assert_eq!(feed.message(RunTopic::Transforms, &view(1)), None);
        assert!(feed.message(RunTopic::Transforms, &view(2)).is_some());
        assert!(feed.message(RunTopic::State, &view(1)).is_some());
        assert_eq!(feed.message(RunTopic::State, &view(2)), None, "the state is the same");
        assert_eq!(feed.message(RunTopic::Map, &view(2)), None, "no subscription");
        feed.take(r#"{"op":"unsubscribe","subscriptionIds":[5]}"#).unwrap();
        assert_eq!(feed.message(RunTopic::Transforms, &view(3)), None);
    }

    #[test]
    fn messages_that_are_no_subscription_are_refused() {
        let mut feed = Feed::default();
        for text in [
            r#"{"op":"advertise","channels":[{"id":1,"topic":"/goal"}]}"#,
            r#"{"op":"setParameters","parameters":[]}"#,
            r#"{"op":"subscribe","subscriptions":[{"id":1,"channelId":99}]}"#,
            "{}",
            "",
        ] {
            assert!(feed.take(text).unwrap_err().contains(r#""level":2"#), "{text}");
        }
        let twice = r#"{"op":"subscribe","subscriptions":[{"id":1,"channelId":1},{"id":2,"channelId":1}]}"#;
        assert!(feed.take(twice).unwrap_err().contains("/tf has a subscription"));
    }

    #[test]
    fn a_run_without_subscriptions_is_not_watched() {
        let (operator, mut link) = operator_link();
        link.publish_view((*view(1)).clone());
        let mut feed = Feed::default();
        assert!(feed.view(&operator).is_none());
        feed.take(r#"{"op":"subscribe","subscriptions":[{"id":1,"channelId":1}]}"#).unwrap();
        assert!(feed.view(&operator).is_some());
    }
}
