//! Twists of a person by topic: the robot drives by them under the safety monitor, and its mission pauses.

use super::active_goal::ActiveGoal;
use crate::Ros2Error;
use crate::node::RosNode;
use crate::twist_topic::subscribe_twists;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use trundle_core::Twist2;

/// The topic. Source: Nav2, AssistedTeleop.
const TOPIC: &str = "cmd_vel_teleop";
/// Shortest time between two twists for the run, which takes one request at each control step: those of a fast joystick would wait in its
/// queue. Source: ours, a sixth of the silence after which the robot stops.
const MIN_PERIOD: Duration = Duration::from_millis(50);

/// Subscribes to the topic. The run stops the robot after [`trundle_runtime::TELEOP_SILENCE_S`] without a usable twist.
///
/// # Errors
/// When the topic cannot be created.
pub fn offer(node: &mut RosNode, active: &ActiveGoal, is_stamped: bool) -> Result<(), Ros2Error> {
    let newest = Arc::<Mutex<Newest>>::default();
    let kept = Arc::clone(&newest);
    subscribe_twists(node, TOPIC, is_stamped, move |twist| {
        kept.lock().unwrap_or_else(PoisonError::into_inner).waiting = twist;
    })?;
    let (active, diagnostics, name) = (active.clone(), node.diagnostics(), node.names().resolve(TOPIC));
    node.every_tick(move |now| {
        let due = newest.lock().unwrap_or_else(PoisonError::into_inner).take_due(now);
        let sent = due.map_or(Ok(0), |twist| active.drive(twist));
        sent.map_or_else(|error| diagnostics.warn(&name, error.to_string()), drop);
    });
    Ok(())
}

/// The newest twist that was not sent.
#[derive(Default)]
struct Newest {
    waiting: Option<Twist2>,
    sent: Option<Instant>,
}

impl Newest {
    /// The twist that is sent at `now`.
    fn take_due(&mut self, now: Instant) -> Option<Twist2> {
        if self.sent.is_some_and(|sent| now - sent < MIN_PERIOD) {
            return None;
        }
        self.waiting.take().inspect(|_| self.sent = Some(now))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::RosClock;
    use crate::convert::twist;
    use crate::generated::geometry_msgs::{Twist, TwistStamped};
    use crate::node::{Names, Networks, NodeSettings, qos};
    use trundle_app::operator::operator_link;
    use trundle_core::Stamp;
    use trundle_runtime::OperatorCommand;

    /// A domain that no other test has. Source: ours, below those of `tests/it`.
    const DOMAIN: u16 = 97;

    fn node(name: &str) -> RosNode {
        RosNode::new(&NodeSettings::new(Names::of_node(name), DOMAIN, Networks::Loopback)).unwrap()
    }

    #[test]
    fn the_newest_twist_is_sent_at_most_once_per_period() {
        let (mut newest, now) = (Newest::default(), Instant::now());
        let twist = |v| Some(Twist2::new(v, 0.0));
        newest.waiting = twist(0.1);
        assert_eq!(newest.take_due(now), twist(0.1));
        assert_eq!(newest.take_due(now + MIN_PERIOD), None);
        newest.waiting = twist(0.2);
        assert_eq!(newest.take_due(now + MIN_PERIOD / 2), None);
        newest.waiting = twist(0.0);
        assert_eq!(newest.take_due(now + MIN_PERIOD), twist(0.0));
    }

    /// Sends a twist in either form.
    fn sender(person: &mut RosNode, is_stamped: bool) -> Box<dyn Fn(Twist2)> {
        let qos = qos::reliable(1);
        if is_stamped {
            let publisher = person.publisher::<TwistStamped>(TOPIC, &qos).unwrap();
            Box::new(move |own| {
                publisher.publish(twist::stamped(own, Stamp::default(), "base_link")).unwrap()
            })
        } else {
            let publisher = person.publisher::<Twist>(TOPIC, &qos).unwrap();
            Box::new(move |own| publisher.publish(twist::to_ros(own)).unwrap())
        }
    }

    #[test]
    fn twists_in_either_form_drive_and_nan_is_named() {
        for is_stamped in [true, false] {
            let (mut person, mut own) = (node("person"), node("robot"));
            let (operator, link) = operator_link();
            let active = ActiveGoal::new(operator, RosClock::system(), own.diagnostics());
            offer(&mut own, &active, is_stamped).unwrap();
            let diagnostics = own.diagnostics();
            let send = sender(&mut person, is_stamped);
            let (_sending, _receiving) = (person.start().unwrap(), own.start().unwrap());
            let (good, broken) = (Twist2::new(0.2, -0.1), Twist2::new(f64::NAN, 0.0));
            let mut drives = Vec::new();
            let end = Instant::now() + Duration::from_secs(20);
            while drives.is_empty() || !diagnostics.summary().contains("/cmd_vel_teleop: linear.x is NaN m/s")
            {
                assert!(Instant::now() < end, "{drives:?}, {}", diagnostics.summary());
                for twist in [good, broken] {
                    send(twist);
                    std::thread::sleep(Duration::from_millis(100));
                }
                drives.extend(std::iter::from_fn(|| link.next_request()).map(|request| request.command));
            }
            assert!(drives.iter().all(|drive| *drive == OperatorCommand::Drive(good)), "{drives:?}");
        }
    }
}
