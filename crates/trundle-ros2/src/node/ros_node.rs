//! A ROS 2 node: topics, services and its thread.

use super::endpoints::{Served, ServerHandle, Subscribed};
use super::event_loop::{Endpoint, NodeThread, Ticker};
use super::{Diagnostics, Level, Names, Networks, Readers, TopicMonitor, middleware_death, qos};
use crate::Ros2Error;
use crate::clock::RosClock;
use crate::interface::{ActionType, MessageType, ServiceType};
use ros2_client::action::{ActionServer, ActionServerQosPolicies};
use ros2_client::dds::rustdds::{DomainParticipantBuilder, RTPSEntity};
use ros2_client::qos::QosProfile;
use ros2_client::{
    ActionTypeName, Context, Gid, MessageTypeName, Node, NodeName, NodeOptions, Publisher, RmwRequestId,
    ServiceMapping, ServiceTypeName,
};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Settings of a node.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct NodeSettings {
    /// Namespace, node name, remapping rules.
    pub names: Names,
    /// Domain: nodes of different domains do not meet. 0 to 232.
    pub domain: u16,
    /// Networks.
    pub networks: Networks,
}

impl NodeSettings {
    /// A node of these names in a domain on these networks.
    pub const fn new(names: Names, domain: u16, networks: Networks) -> Self {
        Self { names, domain, networks }
    }

    /// Line for a person before a run with this node: its domain, its name, and the mission.
    #[must_use]
    pub fn announcement(&self, mission: &str) -> String {
        format!("ROS 2 domain {}, node {}: {mission}.", self.domain, self.names.node)
    }

    /// Lines for a person about a simulated robot in `scene` behind this node: how to drive it, and how others find it.
    #[must_use]
    pub fn robot_greeting(&self, scene: &str) -> String {
        let drive = "trundle ros2 --ros-args -p use_sim_time:=true";
        let hint = self.networks.discovery_hint().map_or_else(String::new, |hint| format!("\n{hint}"));
        format!("A robot in '{scene}' answers on ROS 2 domain {}. Drive it: {drive}{hint}", self.domain)
    }
}

/// Largest domain id whose ports exist. Source: DDSI-RTPS, 9.6.1.
const MAX_DOMAIN: u16 = 232;
/// Receive buffer of a socket \[bytes\]: a raw image pair of 640 x 480. The system may grant less. Source: ours.
const RECEIVE_BUFFER_BYTES: usize = 4 << 20;
/// Period of the checks for stalled topics and foreign types. Source: ours.
const CHECK_PERIOD: Duration = Duration::from_secs(1);

/// The server of an action in the library's type.
pub(super) type RawActionServer<A> =
    ActionServer<<A as ActionType>::Goal, <A as ActionType>::Result, <A as ActionType>::Feedback>;

/// A node that is being built: topics and services are added, then [`RosNode::start`] runs it.
pub struct RosNode {
    context: Context,
    node: Node,
    names: Names,
    endpoints: Vec<Box<dyn Endpoint>>,
    tickers: Vec<Ticker>,
    monitors: Vec<Arc<TopicMonitor>>,
    readers: Vec<Readers>,
    diagnostics: Diagnostics,
    clock: RosClock,
}

impl RosNode {
    /// Joins the network.
    ///
    /// # Errors
    /// When the domain or a name is not allowed, or no socket can be opened.
    pub fn new(settings: &NodeSettings) -> Result<Self, Ros2Error> {
        let NodeSettings { names, domain, networks } = settings;
        if *domain > MAX_DOMAIN {
            let value = domain.to_string();
            return Err(Ros2Error::Parameter { name: "domain id".into(), value, expected: "0 to 232" });
        }
        middleware_death::watch();
        let mut builder =
            DomainParticipantBuilder::new(*domain).socket_receive_buffer_size(RECEIVE_BUFFER_BYTES);
        if let Some(addresses) = networks.addresses() {
            builder = builder.with_only_networks(addresses);
        }
        let participant = builder.build().map_err(|error| Ros2Error::create("the DDS participant", error))?;
        let context = Context::from_domain_participant(participant)
            .map_err(|error| Ros2Error::create("the ROS 2 context", error))?;
        let full = |problem| Ros2Error::Name { name: format!("{}/{}", names.namespace, names.node), problem };
        let name = NodeName::new(&names.namespace, &names.node).map_err(|error| full(error.to_string()))?;
        let options = NodeOptions::new().start_parameter_services(false);
        let node = context.new_node(name, options).map_err(|error| Ros2Error::create("the node", error))?;
        Ok(Self {
            context,
            node,
            names: names.clone(),
            endpoints: Vec::new(),
            tickers: Vec::new(),
            monitors: Vec::new(),
            readers: Vec::new(),
            diagnostics: Diagnostics::default(),
            clock: RosClock::system(),
        })
    }

    /// Conditions of the node's topics.
    #[must_use]
    pub fn diagnostics(&self) -> Diagnostics {
        self.diagnostics.clone()
    }

    /// Measures the silence of topics by this clock, for later subscriptions. The default is the computer's clock.
    pub fn measure_silence_by(&mut self, clock: RosClock) {
        self.clock = clock;
    }

    /// Namespace, node name and rules.
    #[must_use]
    pub fn names(&self) -> &Names {
        &self.names
    }

    /// Publishes messages of type `M` on a topic.
    ///
    /// # Errors
    /// When the name is not allowed or the topic cannot be created.
    pub fn publisher<M: MessageType>(
        &mut self,
        topic: &str,
        qos: &QosProfile,
    ) -> Result<Publisher<M>, Ros2Error> {
        let name = self.names.resolve(topic);
        let topic = self.topic::<M>(topic, qos)?;
        self.node.create_publisher(&topic, Some(qos.clone())).map_err(|error| Ros2Error::create(name, error))
    }

    /// Whether others read a topic, looked up once per second.
    pub fn readers(&mut self, topic: &str) -> Readers {
        let readers = Readers::new(self.names.resolve(topic));
        self.readers.push(readers.clone());
        readers
    }

    /// Calls `handler` on the node's thread with each message of a topic. After its first message, a topic with a `limit` counts as stalled
    /// if no message arrives for that time.
    ///
    /// # Errors
    /// When the name is not allowed or the topic cannot be created.
    pub fn subscribe<M: MessageType>(
        &mut self,
        topic: &str,
        qos: &QosProfile,
        limit: Option<Duration>,
        handler: impl FnMut(M) + Send + 'static,
    ) -> Result<Arc<TopicMonitor>, Ros2Error> {
        self.subscribe_except(topic, qos, (limit, None), handler)
    }

    /// As [`RosNode::subscribe`] without a limit, except for messages of this node itself.
    ///
    /// # Errors
    /// When the name is not allowed or the topic cannot be created.
    pub fn subscribe_to_others<M: MessageType>(
        &mut self,
        topic: &str,
        qos: &QosProfile,
        handler: impl FnMut(M) + Send + 'static,
    ) -> Result<(), Ros2Error> {
        let own = Gid::from(self.context.domain_participant().guid());
        self.subscribe_except(topic, qos, (None, Some(own)), handler).map(drop)
    }

    fn subscribe_except<M: MessageType>(
        &mut self,
        topic: &str,
        qos: &QosProfile,
        (limit, left_out): (Option<Duration>, Option<Gid>),
        handler: impl FnMut(M) + Send + 'static,
    ) -> Result<Arc<TopicMonitor>, Ros2Error> {
        let name = self.names.resolve(topic);
        let topic = self.topic::<M>(topic, qos)?;
        let subscription = self.node.create_subscription(&topic, Some(qos.clone()));
        let subscription = subscription.map_err(|error| Ros2Error::create(&name, error))?;
        let monitor = Arc::new(TopicMonitor::new(
            name.clone(),
            MessageTypeName::new(M::PACKAGE, M::NAME).dds_msg_type(),
            limit,
            self.clock.clone(),
        ));
        self.monitors.push(Arc::clone(&monitor));
        let diagnostics = self.diagnostics.clone();
        let subscribed =
            Subscribed { subscription, handler, name, monitor: Arc::clone(&monitor), diagnostics, left_out };
        self.endpoints.push(Box::new(subscribed));
        Ok(monitor)
    }

    /// Calls `handler` in the node's thread with each request of a service; its value is the response. A response above
    /// [`super::MAX_REPLY_BYTES`] is replaced by an empty one and reported.
    ///
    /// # Errors
    /// When the name is not allowed or the service cannot be created.
    pub fn serve<S: ServiceType + 'static>(
        &mut self,
        service: &str,
        mut handler: impl FnMut(S::Request) -> S::Response + Send + 'static,
    ) -> Result<(), Ros2Error> {
        let (name, full) = (self.names.parsed(service)?, self.names.resolve(service));
        let type_name = ServiceTypeName::new(S::PACKAGE, S::NAME);
        let qos = qos::reliable(10);
        let server = self.node.create_server(ServiceMapping::Enhanced, &name, &type_name, qos.clone(), qos);
        let server = server.map_err(|error| Ros2Error::create(&full, error))?;
        let diagnostics = self.diagnostics.clone();
        let server = ServerHandle::new(server, full.clone(), diagnostics.clone());
        let answering = Arc::clone(&server);
        let answer = move |id: RmwRequestId, request| answering.answer(id, handler(request));
        self.endpoints.push(Box::new(Served { server, handler: answer, name: full, diagnostics }));
        Ok(())
    }

    /// The raw server of an action.
    pub(super) fn raw_action_server<A: ActionType>(
        &mut self,
        action: &str,
    ) -> Result<RawActionServer<A>, Ros2Error> {
        let name = self.names.parsed(action)?;
        let type_name = ActionTypeName::new(A::PACKAGE, A::NAME);
        let qos = ActionServerQosPolicies {
            goal_service: qos::reliable(10),
            result_service: qos::reliable(10),
            cancel_service: qos::reliable(10),
            feedback_publisher: qos::reliable(10),
            status_publisher: qos::latched(),
        };
        self.node
            .create_action_server(ServiceMapping::Enhanced, &name, &type_name, qos)
            .map_err(|error| Ros2Error::create(name.to_string(), error))
    }

    /// Adds an endpoint of the node's own modules.
    pub(super) fn add_endpoint(&mut self, endpoint: Box<dyn Endpoint>) {
        self.endpoints.push(endpoint);
    }

    /// Does `work` in the node's thread at least every 20 ms.
    pub fn every_tick(&mut self, work: impl FnMut(Instant) + Send + 'static) {
        self.tickers.push(Box::new(work));
    }

    /// Runs the node on its own thread.
    ///
    /// # Errors
    /// When the system refuses a thread.
    pub fn start(self) -> Result<NodeThread, Ros2Error> {
        let Self { context, node, endpoints, mut tickers, monitors, readers, diagnostics, .. } = self;
        let (checked, mut due) = (context.clone(), Instant::now());
        tickers.push(Box::new(move |now| {
            if now >= due {
                due = now + CHECK_PERIOD;
                check_topics(&checked, &monitors, &diagnostics);
                find_readers(&checked, &readers);
            }
        }));
        NodeThread::start(endpoints, tickers, (node, context))
    }

    fn topic<M: MessageType>(
        &self,
        topic: &str,
        qos: &QosProfile,
    ) -> Result<ros2_client::dds::rustdds::Topic, Ros2Error> {
        let (name, full) = (self.names.parsed(topic)?, self.names.resolve(topic));
        self.node
            .create_topic(&name, MessageTypeName::new(M::PACKAGE, M::NAME), qos)
            .map_err(|error| Ros2Error::create(full, error))
    }
}

/// Looks up who reads what.
fn find_readers(context: &Context, watched: &[Readers]) {
    if watched.is_empty() {
        return;
    }
    let found = context.domain_participant().discovered_readers();
    for own in watched {
        let reads = |topic: &String| topic.strip_prefix("rt") == Some(own.topic.as_str());
        own.set(found.iter().any(|reader| reads(reader.subscription_topic_data.topic_name())));
    }
}

/// Reports topics that stalled, and topics under which others publish another type.
fn check_topics(context: &Context, monitors: &[Arc<TopicMonitor>], diagnostics: &Diagnostics) {
    for monitor in monitors {
        if let Some(stall) = monitor.stall() {
            diagnostics.report(&monitor.name, Level::Error, stall);
        }
    }
    let writers = context.domain_participant().discovered_writers();
    for writer in writers.iter().map(|writer| &writer.publication_topic_data) {
        let name = writer.topic_name().strip_prefix("rt").unwrap_or_default();
        let found = monitors.iter().find(|monitor| monitor.name == name);
        if let Some(monitor) = found.filter(|monitor| monitor.type_name != writer.type_name) {
            let (own, other) = (&monitor.type_name, &writer.type_name);
            let message = format!(
                "somebody publishes {other} here, expected {own}: give the topic of the right type by -r {name}:=TOPIC"
            );
            diagnostics.report(name, Level::Error, message);
        }
    }
}
