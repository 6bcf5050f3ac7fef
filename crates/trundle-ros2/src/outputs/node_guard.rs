//! Stops the robot if the node has crashed.

use crate::node::{Diagnostics, Level, NodeThread};
use std::sync::Arc;
use trundle_app::operator::{Operator, OperatorError};
use trundle_runtime::OperatorCommand;

/// Watches the node's threads: without them no goal can be sent or cancelled, so the robot is held.
pub(super) struct NodeGuard {
    node: Arc<NodeThread>,
    operator: Operator,
    diagnostics: Diagnostics,
    stop: Stop,
}

/// How far the stop after a crash is.
#[derive(PartialEq)]
enum Stop {
    NotNeeded,
    Waiting,
    Sent,
}

impl NodeGuard {
    /// Watches `node`; `operator` leads to the run.
    pub fn new(node: Arc<NodeThread>, operator: Operator, diagnostics: Diagnostics) -> Self {
        Self { node, operator, diagnostics, stop: Stop::NotNeeded }
    }

    /// Holds the robot if a thread has died. A run whose queue is full gets the command at the next check.
    pub fn check(&mut self) {
        if self.stop == Stop::Sent {
            return;
        }
        let Some(death) = self.node.death() else { return };
        if self.stop == Stop::NotNeeded {
            tracing::error!("{death}; the robot stops");
            self.diagnostics.report("node", Level::Error, death);
        }
        self.stop = match self.operator.send(OperatorCommand::GoalLinkLost) {
            Ok(_) | Err(OperatorError::Over) => Stop::Sent,
            Err(_) => Stop::Waiting,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generated::std_msgs::Bool;
    use crate::node::{Names, Networks, NodeSettings, RosNode, qos};
    use std::time::{Duration, Instant};
    use trundle_app::operator::{OperatorLink, operator_link};

    /// A domain that no other test has. Source: ours, below those of `tests/it`.
    const DOMAIN: u16 = 96;

    fn node(name: &str) -> RosNode {
        RosNode::new(&NodeSettings::new(Names::of_node(name), DOMAIN, Networks::Loopback)).unwrap()
    }

    fn taken(link: &OperatorLink) -> Vec<OperatorCommand> {
        std::iter::from_fn(|| link.next_request()).map(|request| request.command).collect()
    }

    #[test]
    fn a_handler_that_panics_holds_the_robot_once_also_after_a_full_queue() {
        let (mut person, mut own) = (node("person"), node("robot"));
        let flags = person.publisher::<Bool>("flag", &qos::reliable(1)).unwrap();
        own.subscribe("flag", &qos::reliable(1), None, |_: Bool| panic!("as a test wants it")).unwrap();
        let diagnostics = own.diagnostics();
        let (_sending, thread) = (person.start().unwrap(), Arc::new(own.start().unwrap()));
        let (operator, link) = operator_link();
        let mut guard = NodeGuard::new(Arc::clone(&thread), operator.clone(), diagnostics.clone());
        guard.check();
        assert!(link.next_request().is_none(), "a node that lives stops nothing");
        while operator.send(OperatorCommand::Continue).is_ok() {}
        let end = Instant::now() + Duration::from_secs(20);
        while thread.death().is_none() {
            assert!(Instant::now() < end, "the handler was not called");
            flags.publish(Bool { data: true }).unwrap();
            std::thread::sleep(Duration::from_millis(20));
        }
        let death = thread.death().unwrap();
        assert!(death.contains("'ros2'") && death.contains("start the program anew"), "{death}");
        guard.check();
        assert!(diagnostics.summary().contains("node: the thread 'ros2' of ROS 2 has died"));
        assert!(taken(&link).iter().all(|own| *own == OperatorCommand::Continue), "the queue was full");
        (0..3).for_each(|_| guard.check());
        assert_eq!(taken(&link), [OperatorCommand::GoalLinkLost]);
    }
}
