//! Action servers beside other participants.

use super::{Domain, wait_until};
use std::sync::{Arc, Mutex};
use trundle_ros2::clock::RosClock;
use trundle_ros2::generated::nav2_msgs::{Spin, SpinGoal};
use trundle_ros2::node::{ActionHandle, GoalHandler, GoalId};

/// Accepts goals to the left, and keeps their ids.
struct LeftOnly(Arc<Mutex<Vec<GoalId>>>);

impl GoalHandler<Spin> for LeftOnly {
    fn on_goal(&mut self, id: GoalId, goal: SpinGoal) -> Result<(), String> {
        if goal.target_yaw < 0.0 {
            return Err("to the right".to_owned());
        }
        self.0.lock().unwrap().push(id);
        Ok(())
    }

    fn on_cancel(&mut self, _id: GoalId) {}
}

#[test]
fn an_action_server_starts_beside_others_and_stops() {
    let domain = Domain::new();
    let mut node = domain.node("server");
    let goals = Arc::<Mutex<Vec<GoalId>>>::default();
    let own = Arc::clone(&goals);
    let offered =
        ActionHandle::<Spin>::offer(&mut node, "spin", RosClock::system(), |_| Box::new(LeftOnly(own)));
    let handle = offered.unwrap();
    let thread = node.start().unwrap();
    wait_until("the node", || !thread.is_dead());
    assert!(!handle.is_canceling(&[1; 16]) && goals.lock().unwrap().is_empty());
}
